// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/doorway_narrows.hpp"

#include "perception/numeric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace prodomos::perception::doorways {

using map::CellState;

namespace {

/// Rows that the same two jambs bound. `left` and `right` are the jambs' cells next to the gap: means over the rows.
struct Narrow {
  double left = 0.0;
  double right = 0.0;
  int first = 0;
  int last = 0;
  int rows = 0;

  bool continues(int nextLeft, int nextRight, int row) const {
    constexpr int kMissingRows = 1;
    return row - last <= kMissingRows + 1 && std::abs(nextLeft - left) <= 1.0 && std::abs(nextRight - right) <= 1.0;
  }
  void add(int nextLeft, int nextRight, int row) {
    left += (nextLeft - left) / (rows + 1);
    right += (nextRight - right) / (rows + 1);
    last = row;
    ++rows;
  }
  /// Columns of the gap, but for those that the jambs' noise may reach.
  int begin() const { return static_cast<int>(left) + 2; }
  int end() const { return static_cast<int>(right); }
};

/// What is beside a jamb, a little before or behind it: free floor where its wall is thin.
enum class Beside { kUnknown, kOpen, kBlocked };

struct Jamb {
  int face = 0;    // its column next to the gap
  int inward = 0;  // -1 or 1: from the face into the wall
  int first = 0;   // rows
  int last = 0;
  std::array<Beside, 2> beside{};  // before the first row, behind the last
  double wall = 0.0;               // metres of wall that it is the end of, or stands out from

  int rows() const { return last - first + 1; }
  int count(Beside wanted) const { return static_cast<int>(std::count(beside.begin(), beside.end(), wanted)); }
};

struct JambPair {
  Jamb left;
  Jamb right;

  int count(Beside wanted) const { return left.count(wanted) + right.count(wanted); }
  const Jamb& thinner() const { return left.rows() <= right.rows() ? left : right; }
  int rowsMore() const { return std::abs(left.rows() - right.rows()); }
  /// Rows that the right one lies further.
  double shift() const { return 0.5 * (right.first - left.first + right.last - left.last); }
};

class NarrowSearch {
 public:
  NarrowSearch(const Raster& raster, const DoorwayDetectorConfig& config, bool isAskew = false)
      : raster_(raster), config_(config), isAskew_(isAskew) {}

  std::vector<Narrow> narrows() const;
  std::optional<Opening> judge(const Narrow& narrow) const;

 private:
  int cells(double metres) const { return static_cast<int>(std::lround(metres / raster_.step())); }
  bool isThin(const Jamb& jamb) const { return jamb.rows() <= cells(config_.mostThickness); }
  Jamb jambAt(const Narrow& narrow, double face, int inward) const;
  Beside besideOf(const Jamb& jamb, int row, int onward) const;
  int neededWall(const Narrow& narrow) const;
  double wallAt(const Jamb& jamb, int most) const;
  double wallAlong(const Jamb& jamb, int most) const;
  int lineFrom(int u, int v, double du, double dv, int most) const;
  bool isOneWall(const JambPair& jambs, const Narrow& narrow) const;
  bool isWallAndLeaf(const JambPair& jambs, const Narrow& narrow) const;
  double shareSeenThrough(const Narrow& narrow) const;
  double spaceFrom(const Narrow& narrow, int row, int onward) const;
  bool canBeGoneAround(const Narrow& narrow) const;

  const Raster& raster_;
  const DoorwayDetectorConfig& config_;
  bool isAskew_;  // rows lie along a gap, and not along walls
};

std::vector<Narrow> NarrowSearch::narrows() const {
  const int least = cells(config_.leastWidth);
  const int most = cells(config_.mostWidth);
  std::vector<Narrow> done;
  std::vector<Narrow> growing;
  const auto add = [&](int left, int right, int row) {
    const auto before = std::find_if(growing.begin(), growing.end(),
                                     [&](const Narrow& narrow) { return narrow.continues(left, right, row); });
    if (before != growing.end()) return before->add(left, right, row);
    growing.push_back({static_cast<double>(left), static_cast<double>(right), row, row, 1});
  };
  for (int v = 0; v < raster_.height(); ++v) {
    int left = -most - 1;
    int free = 0;
    for (int u = 0; u < raster_.width(); ++u) {
      if (raster_.isFree(u, v)) ++free;
      if (!raster_.isOccupied(u, v)) continue;
      const int width = u - left;
      if (width >= least && width <= most && 2 * free > width) add(left, u, v);
      left = u;
      free = 0;
    }
    const auto isOver = [&](const Narrow& narrow) { return v - narrow.last > 1; };
    std::copy_if(growing.begin(), growing.end(), std::back_inserter(done), isOver);
    std::erase_if(growing, isOver);
  }
  done.insert(done.end(), growing.begin(), growing.end());
  return done;
}

Jamb NarrowSearch::jambAt(const Narrow& narrow, double face, int inward) const {
  Jamb jamb{static_cast<int>(std::lround(face)), inward, narrow.first, narrow.last, {}, 0.0};
  const auto isJamb = [&](int v) {
    return raster_.isOccupied(jamb.face, v) || raster_.isOccupied(jamb.face + 1, v) ||
           raster_.isOccupied(jamb.face - 1, v);
  };
  const int most = cells(config_.mostThickness) + 2;
  while (jamb.rows() <= most && isJamb(jamb.first - 1)) --jamb.first;
  while (jamb.rows() <= most && isJamb(jamb.last + 1)) ++jamb.last;
  jamb.beside = {besideOf(jamb, jamb.first, -1), besideOf(jamb, jamb.last, 1)};
  jamb.wall = isAskew_ ? wallAlong(jamb, neededWall(narrow)) : wallAt(jamb, neededWall(narrow));
  return jamb;
}

/// Two columns, so that a wall which is off the raster's direction by a cell does not end there.
Beside NarrowSearch::besideOf(const Jamb& jamb, int row, int onward) const {
  constexpr int kRows = 3;
  bool isOpen = true;
  for (const int u : {jamb.face, jamb.face + jamb.inward}) {
    int free = 0;
    int occupied = 0;
    for (int i = 1; i <= kRows; ++i) {
      free += raster_.isFree(u, row + onward * i) ? 1 : 0;
      occupied += raster_.isOccupied(u, row + onward * i) ? 1 : 0;
    }
    if (2 * occupied > kRows) return Beside::kBlocked;
    isOpen &= 2 * free > kRows;
  }
  return isOpen ? Beside::kOpen : Beside::kUnknown;
}

/// Cells of wall that must be beside a jamb: across a wide opening, in rooms full of things, ends of something short
/// face each other by chance.
int NarrowSearch::neededWall(const Narrow& narrow) const {
  constexpr double kShare = 0.4;
  return std::max(cells(config_.leastWall), static_cast<int>(kShare * (narrow.right - narrow.left)));
}

/// Along the opening's wall, or across it where the jamb stands out from another wall.
double NarrowSearch::wallAt(const Jamb& jamb, int most) const {
  const int reach = cells(0.25);
  int longest = 0;
  for (int v = jamb.first - 1; v <= jamb.last; ++v)
    longest = std::max(longest, lineFrom(jamb.face, v, jamb.inward, 0, most));
  for (int i = 0; i <= reach; ++i) {
    const int u = jamb.face + i * jamb.inward;
    longest = std::max({longest, lineFrom(u, jamb.first - 1, 0, -1, most), lineFrom(u, jamb.last + 1, 0, 1, most)});
  }
  return longest * raster_.step();
}

/// Along the opening, or up to 21 degrees askew: where two walls that are not in one line leave a gap.
double NarrowSearch::wallAlong(const Jamb& jamb, int most) const {
  int longest = 0;
  for (int v = jamb.first - 1; v <= jamb.last; ++v) {
    for (const double slope : {-0.375, -0.25, -0.125, 0.0, 0.125, 0.25, 0.375})
      longest = std::max(longest, lineFrom(jamb.face, v, jamb.inward, slope, most));
  }
  return longest * raster_.step();
}

/// Cells of wall in a line two cells wide, which walls of other directions soon leave; up to the length that is needed.
int NarrowSearch::lineFrom(int u, int v, double du, double dv, int most) const {
  constexpr int kMissing = 2;
  const int besideU = std::abs(du) < std::abs(dv) ? 1 : 0;
  const int besideV = 1 - besideU;
  int length = 0;
  for (int i = 0; i < most && i - length <= kMissing; ++i) {
    const int x = u + static_cast<int>(std::lround(i * du));
    const int y = v + static_cast<int>(std::lround(i * dv));
    if (raster_.isOccupied(x, y) || raster_.isOccupied(x + besideU, y + besideV)) length = i + 1;
  }
  return length;
}

/// Two ends of one wall: as thick as each other and in one line; across a room the line may be a little askew. One of
/// them may be a pillar where all else speaks for a wall.
bool NarrowSearch::isOneWall(const JambPair& jambs, const Narrow& narrow) const {
  constexpr double kAskew = 0.04;
  constexpr double kMostAskew = 0.2;  // where all corners are seen
  constexpr int kLeastRows = 3;
  constexpr double kPillar = 0.2;  // metres
  constexpr double kWide = 1.6;    // metres; all corners must be seen
  if (!isThin(jambs.left) || !isThin(jambs.right)) return false;
  if (jambs.count(Beside::kOpen) < 3 || jambs.count(Beside::kBlocked) > 0) return false;
  if (jambs.thinner().rows() < kLeastRows || jambs.rowsMore() > 2) return false;
  // The shortest way between walls that lie askew leads from a corner of one to the opposite corner of the other.
  const double askew = jambs.count(Beside::kOpen) == 4 ? kMostAskew : kAskew;
  const double allowedShift = 1.0 + (isAskew_ ? jambs.thinner().rows() : askew * (narrow.right - narrow.left));
  if (std::abs(jambs.shift()) > allowedShift) return false;
  const bool isWide = narrow.right - narrow.left > cells(kWide);
  if (isWide && jambs.count(Beside::kOpen) < 4) return false;
  const auto [lessWall, moreWall] = std::minmax(jambs.left.wall, jambs.right.wall);
  const double needed = neededWall(narrow) * raster_.step();
  if (lessWall >= needed || isAskew_) return lessWall >= needed;
  const bool isAlike = std::abs(jambs.left.first - jambs.right.first) <= 1 &&
                       std::abs(jambs.left.last - jambs.right.last) <= 1 && jambs.count(Beside::kOpen) == 4;
  return isAlike && moreWall >= needed && lessWall >= kPillar;
}

/// The end of a wall, and across the gap something longer: the leaf that stands open there, or a perpendicular wall.
bool NarrowSearch::isWallAndLeaf(const JambPair& jambs, const Narrow& narrow) const {
  constexpr double kMostLeaf = 2.2;  // metres
  constexpr int kLeastRows = 3;
  const Jamb& wall = jambs.thinner();
  const double needed = neededWall(narrow) * raster_.step();
  return narrow.right - narrow.left <= cells(kMostLeaf) && isThin(wall) && jambs.rowsMore() > 2 &&
         wall.rows() >= kLeastRows && wall.count(Beside::kOpen) == 2 && jambs.count(Beside::kOpen) >= 3 &&
         jambs.left.wall >= needed && jambs.right.wall >= needed;
}

/// Of the gap's columns those that are free across the wall and a hand further on both sides.
double NarrowSearch::shareSeenThrough(const Narrow& narrow) const {
  constexpr double kLeastFree = 0.75;
  const int margin = cells(0.1);
  const int rows = narrow.last - narrow.first + 1 + 2 * margin;
  int through = 0;
  for (int u = narrow.begin(); u < narrow.end(); ++u) {
    int free = 0;
    bool isBlocked = false;
    for (int v = narrow.first - margin; v <= narrow.last + margin; ++v) {
      isBlocked |= raster_.isOccupied(u, v);
      free += raster_.isFree(u, v) ? 1 : 0;
    }
    if (!isBlocked && free >= kLeastFree * rows) ++through;
  }
  return narrow.end() > narrow.begin() ? static_cast<double>(through) / (narrow.end() - narrow.begin()) : 0.0;
}

/// Metres of free floor straight on from a row, the median of the columns, up to what is needed.
double NarrowSearch::spaceFrom(const Narrow& narrow, int row, int onward) const {
  const int most = cells(config_.leastSpace);
  std::vector<int> lengths;
  for (int u = narrow.begin(); u < narrow.end(); ++u) {
    int length = 0;
    while (length < most && raster_.isFree(u, row + onward * (length + 1))) ++length;
    lengths.push_back(length);
  }
  if (lengths.empty()) return 0.0;
  return median(std::move(lengths)) * raster_.step();
}

/// Whether free cells lead from before the narrow to behind it, near by and not through it.
bool NarrowSearch::canBeGoneAround(const Narrow& narrow) const {
  constexpr int kStand = 3;  // cells before and behind
  const int reach = cells(config_.leastDetour);
  const geometry::CellIndex start{(narrow.begin() + narrow.end()) / 2, narrow.first - kStand};
  const geometry::CellIndex goal{start.x, narrow.last + kStand};
  const int side = 2 * reach + 1;  // of a square around the start, which no shorter way leaves
  std::vector<bool> isReached(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), false);
  const auto reached = [&](geometry::CellIndex cell) {
    return isReached[static_cast<std::size_t>(cell.y - start.y + reach) * static_cast<std::size_t>(side) +
                     static_cast<std::size_t>(cell.x - start.x + reach)];
  };
  const auto isPassable = [&](geometry::CellIndex cell) {
    const bool isInNarrow =
        cell.y >= narrow.first && cell.y <= narrow.last && cell.x >= narrow.left && cell.x <= narrow.right;
    return raster_.isFree(cell.x, cell.y) && !isInNarrow;
  };
  std::vector<geometry::CellIndex> front{start};
  std::vector<geometry::CellIndex> next;
  for (int length = 0; length < reach && !front.empty(); ++length) {
    next.clear();
    for (const auto cell : front) {
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const geometry::CellIndex neighbour{cell.x + dx, cell.y + dy};
        if (reached(neighbour) || !isPassable(neighbour)) continue;
        if (neighbour == goal) return true;
        reached(neighbour) = true;
        next.push_back(neighbour);
      }
    }
    front.swap(next);
  }
  return false;
}

std::optional<Opening> NarrowSearch::judge(const Narrow& narrow) const {
  constexpr double kLeastSeen = 0.7;
  if (narrow.last - narrow.first >= cells(config_.mostThickness)) return std::nullopt;
  const double seen = shareSeenThrough(narrow);
  if (seen < kLeastSeen) return std::nullopt;
  const JambPair jambs{jambAt(narrow, narrow.left, -1), jambAt(narrow, narrow.right, 1)};
  const double width = narrow.right - narrow.left;
  const bool isPlain = isOneWall(jambs, narrow);
  const bool isBesideWall = !isAskew_ && isWallAndLeaf(jambs, narrow);
  if (!isPlain && !isBesideWall) return std::nullopt;
  const int first = isPlain ? std::min(jambs.left.first, jambs.right.first) : jambs.thinner().first;
  const int last = isPlain ? std::max(jambs.left.last, jambs.right.last) : jambs.thinner().last;
  if (spaceFrom(narrow, first, -1) < cells(config_.leastSpace) * raster_.step() ||
      spaceFrom(narrow, last, 1) < cells(config_.leastSpace) * raster_.step() || canBeGoneAround(narrow)) {
    return std::nullopt;
  }
  Opening opening;
  opening.middle = raster_.inSubmap(0.5 * (narrow.left + narrow.right), 0.5 * (first + last));
  opening.direction = raster_.direction() + 0.5 * std::numbers::pi;
  opening.width = width * raster_.step();
  opening.sigma = 0.5 * raster_.step();
  // A wide one beside a longer wall may be the mouth of a corridor that crosses.
  const double shape = isPlain ? 0.5 : std::clamp(2.1 - 2.0 * (opening.width - 1.0), -0.9, 2.1);
  opening.evidence = shape + 2.0 * (jambs.count(Beside::kOpen) - 3) + 3.0 * (seen - kLeastSeen);
  return opening;
}

}  // namespace

void appendOpenings(const Raster& raster, const DoorwayDetectorConfig& config, std::vector<Opening>& openings) {
  const NarrowSearch search(raster, config);
  for (const auto& narrow : search.narrows()) {
    if (const auto opening = search.judge(narrow)) openings.push_back(*opening);
  }
}

void appendOpeningsAt(const Eigen::Vector2d& middle, const Raster& raster, const DoorwayDetectorConfig& config,
                      std::vector<Opening>& openings) {
  constexpr double kNear = 0.3;  // metres
  const NarrowSearch search(raster, config, true);
  for (const auto& narrow : search.narrows()) {
    const auto opening = search.judge(narrow);
    if (opening && (opening->middle - middle).norm() < kNear) openings.push_back(*opening);
  }
}

}  // namespace prodomos::perception::doorways
