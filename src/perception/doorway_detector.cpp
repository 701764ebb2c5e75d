// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/doorway_detector.hpp"

#include "perception/doorway_raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>

namespace prodomos::perception {

using doorways::Raster;
using map::CellState;

namespace {

/// A narrow: rows of cells that the same two jambs bound. `left` and `right` are the jambs' cells next to the gap.
struct Narrow {
  double left = 0.0;  // means over the rows
  double right = 0.0;
  int first = 0;  // rows
  int last = 0;
  int rows = 0;

  bool continues(int l, int r, int v) const {
    constexpr int kMissingRows = 1;
    return v - last <= kMissingRows + 1 && std::abs(l - left) <= 1.0 && std::abs(r - right) <= 1.0;
  }
  void add(int l, int r, int v) {
    left += (l - left) / (rows + 1);
    right += (r - right) / (rows + 1);
    last = v;
    ++rows;
  }
};

/// How the space widens where a jamb ends: before it and behind it.
enum class Beside { kUnknown, kOpen, kBlocked };

struct Jamb {
  int face = 0;    // its cell next to the gap
  int inward = 0;  // -1 or 1: from the face into the wall
  int first = 0;   // rows
  int last = 0;
  std::array<Beside, 2> beside{};  // before the first row, behind the last
  double wall = 0.0;               // metres of wall that it is the end of, or stands out from
};

class DoorwaySearch {
 public:
  DoorwaySearch(const Raster& raster, const DoorwayDetectorConfig& config) : raster_(raster), config_(config) {}

  std::vector<DoorSighting> find() const {
    std::vector<DoorSighting> found;
    for (const auto& narrow : narrows()) {
      if (auto sighting = judge(narrow)) found.push_back(std::move(*sighting));
    }
    return found;
  }

 private:
  int cells(double metres) const { return static_cast<int>(std::lround(metres / raster_.step())); }
  std::vector<Narrow> narrows() const;
  std::optional<DoorSighting> judge(const Narrow& narrow) const;
  Jamb jambAt(const Narrow& narrow, int face, int inward) const;
  Beside besideOf(const Jamb& jamb, int row, int onward) const;
  double wallAt(const Jamb& jamb) const;
  double shareSeenThrough(const Narrow& narrow) const;
  double spaceBeyond(const Narrow& narrow, int row, int onward) const;
  bool canBeGoneAround(const Narrow& narrow) const;

  const Raster& raster_;
  const DoorwayDetectorConfig& config_;
};

std::vector<Narrow> DoorwaySearch::narrows() const {
  const int least = cells(config_.leastWidth);
  const int most = cells(config_.mostWidth);
  std::vector<Narrow> done;
  std::vector<Narrow> open;
  const auto add = [&](int left, int right, int v) {
    for (auto& narrow : open) {
      if (narrow.continues(left, right, v)) return narrow.add(left, right, v);
    }
    open.push_back({static_cast<double>(left), static_cast<double>(right), v, v, 1});
  };
  for (int v = 0; v < raster_.height(); ++v) {
    int left = -1;
    int free = 0;
    for (int u = 0; u < raster_.width(); ++u) {
      if (raster_.isFree(u, v)) ++free;
      if (!raster_.isOccupied(u, v)) continue;
      const int width = u - left;
      if (left >= 0 && width >= least && width <= most && 2 * free > width) add(left, u, v);
      left = u;
      free = 0;
    }
    const auto isOver = [&](const Narrow& narrow) { return v - narrow.last > 1; };
    std::copy_if(open.begin(), open.end(), std::back_inserter(done), isOver);
    std::erase_if(open, isOver);
  }
  done.insert(done.end(), open.begin(), open.end());
  return done;
}

Jamb DoorwaySearch::jambAt(const Narrow& narrow, int face, int inward) const {
  Jamb jamb{face, inward, narrow.first, narrow.last, {}, 0.0};
  const auto isJamb = [&](int v) {
    return raster_.isOccupied(face, v) || raster_.isOccupied(face + inward, v) || raster_.isOccupied(face - inward, v);
  };
  const int most = cells(config_.mostThickness) + 2;
  while (jamb.last - jamb.first < most && (isJamb(jamb.first - 1))) --jamb.first;
  while (jamb.last - jamb.first < most && (isJamb(jamb.last + 1))) ++jamb.last;
  jamb.beside = {besideOf(jamb, jamb.first, -1), besideOf(jamb, jamb.last, 1)};
  jamb.wall = wallAt(jamb);
  return jamb;
}

/// The few cells beyond the jamb's end that would be free if it is a thin wall's, and wall if it goes on.
Beside DoorwaySearch::besideOf(const Jamb& jamb, int row, int onward) const {
  int free = 0;
  int occupied = 0;
  for (int across = 1; across <= 3; ++across) {
    for (int along = 0; along <= 1; ++along) {
      const auto state = raster_.at(jamb.face + along * jamb.inward, row + onward * across);
      free += state == CellState::kFree ? 1 : 0;
      occupied += state == CellState::kOccupied ? 1 : 0;
    }
  }
  if (occupied >= 3) return Beside::kBlocked;
  return free >= 3 ? Beside::kOpen : Beside::kUnknown;
}

/// Along the opening's wall, or across it where the jamb stands out from another wall.
double DoorwaySearch::wallAt(const Jamb& jamb) const {
  const int most = cells(config_.leastWall);
  int along = 0;
  for (int i = 0, missing = 0; i <= most && missing < 3; ++i) {
    bool isWall = false;
    for (int v = jamb.first; v <= jamb.last && !isWall; ++v)
      isWall = raster_.isOccupied(jamb.face + i * jamb.inward, v);
    missing = isWall ? 0 : missing + 1;
    if (isWall) along = i + 1;
  }
  if (along >= most) return along * raster_.step();
  const int middle = (jamb.first + jamb.last) / 2;
  int longest = 0;
  const int reach = cells(0.3);
  for (const int onward : {-1, 1}) {
    for (int i = 0, missing = 0; i <= 2 * most && missing < 6; ++i) {
      bool isWall = false;
      for (int u = 0; u <= reach && !isWall; ++u) {
        isWall = raster_.isOccupied(jamb.face + u * jamb.inward, middle + i * onward);
      }
      missing = isWall ? 0 : missing + 1;
      if (isWall) longest = std::max(longest, i + 1);
    }
  }
  return std::max(along, longest) * raster_.step();
}

/// Of the gap's columns those that are free across the wall and a hand further on both sides.
double DoorwaySearch::shareSeenThrough(const Narrow& narrow) const {
  const int margin = cells(0.1);
  int through = 0;
  int columns = 0;
  for (int u = static_cast<int>(narrow.left) + 2; u <= static_cast<int>(narrow.right) - 1; ++u, ++columns) {
    int free = 0;
    bool isBlocked = false;
    for (int v = narrow.first - margin; v <= narrow.last + margin; ++v) {
      isBlocked |= raster_.isOccupied(u, v);
      free += raster_.isFree(u, v) ? 1 : 0;
    }
    if (!isBlocked && 4 * free >= 3 * (narrow.last - narrow.first + 1 + 2 * margin)) ++through;
  }
  return columns > 0 ? static_cast<double>(through) / columns : 0.0;
}

/// Metres of free floor straight on, the median of the columns.
double DoorwaySearch::spaceBeyond(const Narrow& narrow, int row, int onward) const {
  const int most = cells(config_.leastSpace) + 1;
  std::vector<int> lengths;
  for (int u = static_cast<int>(narrow.left) + 2; u <= static_cast<int>(narrow.right) - 1; ++u) {
    int length = 0;
    while (length < most && raster_.isFree(u, row + onward * (length + 1))) ++length;
    lengths.push_back(length);
  }
  if (lengths.empty()) return 0.0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle * raster_.step();
}

/// Whether free cells lead from before the opening to behind it, near by and not through it.
bool DoorwaySearch::canBeGoneAround(const Narrow& narrow) const {
  const int reach = cells(config_.leastDetour);
  const int middle = static_cast<int>(std::lround(0.5 * (narrow.left + narrow.right)));
  const int side = 2 * reach + 1;
  const int u0 = middle - reach;
  const int v0 = (narrow.first + narrow.last) / 2 - reach;
  const auto isPassable = [&](int u, int v) {
    const bool isInOpening = v >= narrow.first && v <= narrow.last && u >= narrow.left && u <= narrow.right;
    return raster_.isFree(u, v) && !isInOpening;
  };
  std::vector<int> distance(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), -1);
  const auto at = [&](int u, int v) -> int& {
    return distance[static_cast<std::size_t>(v - v0) * static_cast<std::size_t>(side) +
                    static_cast<std::size_t>(u - u0)];
  };
  struct Cell {
    int u, v;
  };
  std::queue<Cell> queue;
  const Cell start{middle, narrow.first - 3};
  const Cell goal{middle, narrow.last + 3};
  if (!isPassable(start.u, start.v)) return false;
  at(start.u, start.v) = 0;
  queue.push(start);
  while (!queue.empty()) {
    const Cell cell = queue.front();
    queue.pop();
    const int next = at(cell.u, cell.v) + 1;
    if (next > reach) return false;
    for (const auto& [du, dv] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const Cell neighbour{cell.u + du, cell.v + dv};
      if (neighbour.u < u0 || neighbour.v < v0 || neighbour.u >= u0 + side || neighbour.v >= v0 + side) continue;
      if (at(neighbour.u, neighbour.v) >= 0 || !isPassable(neighbour.u, neighbour.v)) continue;
      if (neighbour.u == goal.u && neighbour.v == goal.v) return true;
      at(neighbour.u, neighbour.v) = next;
      queue.push(neighbour);
    }
  }
  return false;
}

std::optional<DoorSighting> DoorwaySearch::judge(const Narrow& narrow) const {
  if (narrow.last - narrow.first >= cells(config_.mostThickness)) return std::nullopt;
  const double seenThrough = shareSeenThrough(narrow);
  if (seenThrough < 0.7) return std::nullopt;
  const std::array jambs{jambAt(narrow, static_cast<int>(std::lround(narrow.left)), -1),
                         jambAt(narrow, static_cast<int>(std::lround(narrow.right)), 1)};
  int openCorners = 0;
  int blockedCorners = 0;
  int longJambs = 0;
  int first = raster_.height();
  int last = -1;
  for (const auto& jamb : jambs) {
    if (jamb.wall < config_.leastWall) return std::nullopt;
    for (const auto beside : jamb.beside) {
      openCorners += beside == Beside::kOpen ? 1 : 0;
      blockedCorners += beside == Beside::kBlocked ? 1 : 0;
    }
    const bool isLong = jamb.last - jamb.first >= cells(config_.mostThickness);
    longJambs += isLong ? 1 : 0;
    if (isLong) continue;
    first = std::min(first, jamb.first);
    last = std::max(last, jamb.last);
  }
  if (longJambs > 1) return std::nullopt;
  const bool opensBefore = jambs[0].beside[0] == Beside::kOpen || jambs[1].beside[0] == Beside::kOpen;
  const bool opensBehind = jambs[0].beside[1] == Beside::kOpen || jambs[1].beside[1] == Beside::kOpen;
  if (!opensBefore || !opensBehind || openCorners < 3 || blockedCorners > 1) return std::nullopt;
  if (spaceBeyond(narrow, last, 1) < config_.leastSpace || spaceBeyond(narrow, first, -1) < config_.leastSpace) {
    return std::nullopt;
  }
  if (canBeGoneAround(narrow)) return std::nullopt;

  DoorSighting sighting;
  const Eigen::Vector2d middle =
      raster_.inSubmap(0.5 * (narrow.left + narrow.right), 0.5 * static_cast<double>(first + last));
  sighting.T_submap_door = geometry::toPose3({middle.x(), middle.y(), raster_.direction() + 0.5 * std::numbers::pi});
  sighting.door.hasLeaf = false;
  sighting.door.state = map::DoorState::kOpen;
  sighting.door.width = (narrow.right - narrow.left) * raster_.step();
  sighting.widthSigma = 0.6 * raster_.step();
  const double sigma = 0.6 * raster_.step();
  sighting.covariance.diagonal() << sigma * sigma, sigma * sigma, 0.01, std::pow(0.02, 2);
  sighting.evidence = 0.5 * openCorners + 2.0 * (seenThrough - 0.7) - 0.5 * longJambs - 0.5;
  return sighting;
}

}  // namespace

void describe(base::ConfigVisitor& visitor, DoorwayDetectorConfig& config) {
  visitor.section("doorways", "openings in the walls of a grid");
  visitor.key("enabled", config.enabled, "look for them");
  visitor.key("least_width", config.leastWidth, "m", {0.3, 2.0}, "between the jambs");
  visitor.key("most_width", config.mostWidth, "m", {0.6, 10.0}, "wider gaps are parts of one room");
  visitor.key("most_thickness", config.mostThickness, "m", {0.05, 2.0}, "of the wall; deeper ones are corridors");
  visitor.key("least_wall", config.leastWall, "m", {0.0, 5.0}, "beside each jamb; less is furniture or a pillar");
  visitor.key("least_space", config.leastSpace, "m", {0.0, 5.0}, "free before and behind; less is a niche");
  visitor.key("least_detour", config.leastDetour, "m", {0.0, 20.0},
              "what one can go around on a shorter way is a gap between furniture");
  visitor.endSection();
}

std::vector<DoorSighting> findDoorways(const map::OccupancyGrid& grid, const Eigen::Vector2d& observer_in_submap,
                                       const DoorwayDetectorConfig& config) {
  std::vector<DoorSighting> found;
  if (!config.enabled) return found;
  constexpr std::size_t kMostDirections = 4;
  for (const double direction : doorways::wallDirections(grid, kMostDirections)) {
    for (const double turn : {0.0, 0.5 * std::numbers::pi}) {
      const Raster raster(grid, direction + turn);
      const auto inRows = DoorwaySearch(raster, config).find();
      found.insert(found.end(), inRows.begin(), inRows.end());
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.evidence > b.evidence; });
  std::vector<DoorSighting> apart;
  for (auto& sighting : found) {
    const Eigen::Vector2d middle = sighting.T_submap_door.translation().head<2>();
    const bool isKnown = std::any_of(apart.begin(), apart.end(), [&](const DoorSighting& other) {
      return (other.T_submap_door.translation().head<2>() - middle).norm() < 0.5;
    });
    if (isKnown) continue;
    const Eigen::Vector2d normal = sighting.T_submap_door.linear().col(0).head<2>();
    if (normal.dot(middle - observer_in_submap) < 0.0) {
      sighting.T_submap_door.rotate(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()));
    }
    apart.push_back(sighting);
  }
  return apart;
}

}  // namespace prodomos::perception
