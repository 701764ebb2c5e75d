// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_candidates.hpp"

#include "prodomos/sensors/camera.hpp"

#include "perception/numeric.hpp"
#include "perception/wall_samples.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace prodomos::perception {

namespace {

constexpr double kLeastWidth = 0.55;
constexpr double kMostWidth = 2.3;
constexpr double kWidestLeaf = 1.35;
constexpr double kLeastDouble = 1.15;
constexpr double kUsualHeight = 2.0;
constexpr double kFrame = 0.1;         // metres, more than boards of frames are wide
constexpr double kFrameDepth = 0.012;  // by which they usually stand out of the wall: too little to be measured

/// A pair of lines being looked at: cue by cue.
class Examination {
 public:
  Examination(const RectifiedWall& wall, const WallEdges& edges, const UprightLine& left, const UprightLine& right)
      : wall_(wall), edges_(edges) {
    found_.leftLine = left;
    found_.rightLine = right;
    first_ = static_cast<int>(std::lround(left.column));
    last_ = static_cast<int>(std::lround(right.column));
  }

  /// None where it is no use to look further.
  std::optional<DoorCandidate> run(const std::vector<UprightLine>& lines) {
    if (!hasDepthOfLeaf()) return std::nullopt;
    place();
    const double width = found_.width();
    if (width < kLeastWidth || width > kMostWidth) return std::nullopt;
    lookAtTop();
    if (!lookAtJambs()) return std::nullopt;
    if (width > kLeastDouble && hasMiddleLine(lines)) found_.leaves = 2;
    if (width > kWidestLeaf && found_.leaves == 1) return std::nullopt;
    lookBesideJambs(lines);
    lookAtFoot();
    lookAtLeaf();
    lookAtSurroundings();
    lookAtHandle();
    judgeView();
    return found_;
  }

 private:
  /// Where what is seen in a box lies, by blocks.
  struct Places {
    int known = 0;
    int behind = 0;
    int before = 0;

    double shareBehind() const { return known < 5 ? 0.0 : static_cast<double>(behind) / known; }
  };

  double leafZ(double z) const {
    const double height = wall_.wall().cameraHeight;
    return height + (z - height) * wall_.shrinkage(found_.leaf_y);
  }
  int leafRow(double z) const {
    return std::clamp(static_cast<int>(std::lround(wall_.rowOf(leafZ(z)))), 0, wall_.height());
  }
  int wallRow(double z) const { return std::clamp(static_cast<int>(std::lround(wall_.rowOf(z))), 0, wall_.height()); }
  Box insideBox(double margin, double low, double high) const {
    return {first_ + columns(margin), last_ - columns(margin), leafRow(high), leafRow(low)};
  }

  /// Of two boxes; what lies far from the wall's plane is no wall.
  std::vector<float> offsetsAround(const Box& left, const Box& right) const {
    auto offsets = offsetsIn(wall_, left);
    const auto more = offsetsIn(wall_, right);
    offsets.insert(offsets.end(), more.begin(), more.end());
    std::erase_if(offsets, [](float y) { return std::abs(y) > 0.3F; });
    return offsets;
  }

  bool hasDepthOfLeaf();
  void place();
  void lookAtTop();
  bool lookAtJambs();
  bool hasMiddleLine(const std::vector<UprightLine>& lines);
  void lookBesideJambs(const std::vector<UprightLine>& lines);
  void lookAtFoot();
  void lookAtLeaf();
  void lookAtSurroundings();
  Places placesIn(const Box& unclipped) const;
  void lookAtHandle();
  void judgeView();

  const RectifiedWall& wall_;
  const WallEdges& edges_;
  DoorCandidate found_;
  int first_ = 0;
  int last_ = 0;
  double surroundY_ = 0.0;
  double known_ = 0.0;            ///< share of the leaf whose depth is known
  double sigma_ = 0.0;            ///< of one block's offset
  double height_ = kUsualHeight;  ///< of the leaf, as far as known
};

/// Where depth shows something else than a leaf in or behind the wall's plane, there is none: false.
bool Examination::hasDepthOfLeaf() {
  const Box leaf{first_ + 3, last_ - 3, wallRow(1.8), wallRow(0.25)};
  int visible = 0;
  int other = 0;
  const Box box = clipped(leaf, wall_);
  for (int row = box.top; row < box.bottom; row += RectifiedWall::kBlock) {
    for (int column = box.first; column < box.last; column += RectifiedWall::kBlock) {
      const Seen seen = wall_.seen(column, row);
      if (isVisible(seen)) {
        ++visible;
      } else if (seen != Seen::kNothing) {
        ++other;
      }
    }
  }
  if (visible < 20 || visible < 2 * other) return false;
  const double middle = 0.5 * (wall_.xOf(first_) + wall_.xOf(last_));
  const double range = wall_.rangeAt(middle);
  sigma_ = 0.5 * sensors::depthSigma(range) * std::cos(wall_.obliquenessAt(middle)) + 0.004;
  auto offsets = offsetsIn(wall_, leaf);
  known_ = static_cast<double>(offsets.size()) / visible;
  constexpr std::size_t kEnough = 12;
  if (offsets.size() < kEnough) {
    found_.leafSigma = 0.05;
    return true;
  }
  found_.leaf_y = median(offsets);
  found_.leafSigma = std::hypot(0.006, sigma_ / std::sqrt(0.2 * static_cast<double>(offsets.size())));
  const auto inPlane = std::ranges::count_if(offsets, [&](float offset) {
    return std::abs(static_cast<double>(offset) - found_.leaf_y) < 0.02 + 3.0 * sigma_;
  });
  found_.cue(Cue::kFlat) = static_cast<double>(inPlane) / static_cast<double>(offsets.size()) - 0.5;
  found_.cue(Cue::kTurned) = tiltedShare(profileOf(wall_, leaf), 0.015 + 1.5 * sigma_);
  return true;
}

/// Where the jambs truly are: an edge beyond which the leaf is seen to its end lies on the leaf, one that hides part of
/// it lies on the wall's surface.
void Examination::place() {
  constexpr std::size_t kEnough = 9;  // blocks
  const int wide = columns(0.4);
  const Box left{first_ - wide, first_ - columns(kFrame), wallRow(1.8), wallRow(0.4)};
  const Box right{last_ + columns(kFrame), last_ + wide, wallRow(1.8), wallRow(0.4)};
  const auto around = offsetsAround(left, right);
  const int beside = blocksOf(clipped(left, wall_)) + blocksOf(clipped(right, wall_));
  if (beside > 0)
    found_.cue(Cue::kDepthless) = (1.0 - known_) * std::min(1.0, static_cast<double>(around.size()) / beside);
  // Beyond the far jamb one looks into the recess: the near side alone is sure to be wall.
  const double seenLeft = wall_.xOf(found_.leftLine.columnAt(wall_.rowOf(1.0)));
  const double seenRight = wall_.xOf(found_.rightLine.columnAt(wall_.rowOf(1.0)));
  auto surround = seenLeft > 0.0 ? offsetsAround(left, {}) : seenRight < 0.0 ? offsetsAround({}, right) : around;
  if (surround.size() < kEnough) surround = around;
  const bool isKnown = surround.size() >= kEnough;
  surroundY_ = isKnown ? median(surround) : found_.leaf_y;
  const double deeper = found_.leaf_y - surroundY_;
  // Far off, depth errs alike over a whole leaf: it does not average out.
  const double doubt = std::hypot(found_.leafSigma, 0.008, sigma_);
  if (isKnown && found_.cue(Cue::kFlat) != 0.0) {
    found_.cue(Cue::kStandsOut) = std::clamp(-deeper / (0.01 + doubt) - 0.5, 0.0, 3.0);
    found_.cue(Cue::kRecessed) = std::clamp(deeper / (0.01 + doubt) - 0.5, 0.0, 3.0);
  }
  const auto trueX = [&](double x, bool hides) {
    return x / wall_.shrinkage(hides ? std::min(found_.leaf_y, surroundY_) - kFrameDepth : found_.leaf_y);
  };
  found_.left_x = trueX(seenLeft, seenLeft > 0.0);
  found_.right_x = trueX(seenRight, seenRight < 0.0);
}

void Examination::lookAtTop() {
  const int inset = 2;
  const int highest = leafRow(2.35);
  const int lowest = leafRow(1.65);
  double best = 0.0;
  int visible = 0;
  int looked = 0;
  for (int row = highest; row < lowest; ++row) {
    best = std::max(best, edges_.levelEdge(row, first_ + inset, last_ - inset));
    visible += isVisible(wall_.seen(std::clamp((first_ + last_) / 2, 0, wall_.width() - 1), row)) ? 1 : 0;
    ++looked;
  }
  constexpr double kEdge = 0.5;
  if (best < kEdge) {
    const bool seesHeight = visible > 0.9 * looked;
    found_.cue(Cue::kNoTop) = seesHeight ? 1.0 : 0.0;
    return;
  }
  // Of several, the lowest: the leaf's own edge, below its frame's.
  int row = lowest - 1;
  while (edges_.levelEdge(row, first_ + inset, last_ - inset) < 0.85 * best) --row;
  // An edge is thickened by a row to either side.
  --row;
  const double height = wall_.wall().cameraHeight;
  found_.top_z = height + (wall_.zOf(row) - height) / wall_.shrinkage(found_.leaf_y);
  found_.cue(Cue::kTop) = best;
  height_ = found_.top_z;
  const int near = columns(kFrame + 0.03);
  const int far = columns(0.35);
  const double contrast = std::max(1.0, edges_.levelContrast(row + 1, first_ + inset, last_ - inset));
  const auto beyond = [&](int from, int to) {
    double most = 0.0;
    for (int i = -3; i <= 3; ++i) {
      const double share = std::min(1.0, edges_.levelContrast(row + i, from, to) / contrast);
      most = std::max(most, share * edges_.levelEdge(row + i, from, to));
    }
    return most;
  };
  const double left = beyond(first_ - far, first_ - near);
  const double right = beyond(last_ + near, last_ + far);
  found_.cue(Cue::kTopBeyond) = 0.5 * (left + right);
  found_.cue(Cue::kTopBeyondBoth) = std::min(left, right);
}

bool Examination::lookAtJambs() {
  const int top = leafRow(height_ - 0.04);
  const int bottom = leafRow(0.03);
  double worse = 1.0;
  double better = 0.0;
  int seenRows = 0;
  int hiddenSides = 0;
  for (const UprightLine* line : {&found_.leftLine, &found_.rightLine}) {
    int visible = 0;
    int supported = 0;
    int hidden = 0;
    const int outside = (line == &found_.leftLine ? -1 : 1) * (RectifiedWall::kBlock + 2);
    for (int row = top; row < bottom; ++row) {
      const int column = static_cast<int>(std::lround(line->columnAt(row)));
      if (column < 2 || column >= wall_.width() - 2) continue;
      if (!isVisible(wall_.seen(column, row))) continue;
      ++visible;
      supported += edges_.support(*line, row, row + 1) > 0.0 ? 1 : 0;
      const int beside = std::clamp(column + outside, 0, wall_.width() - 1);
      hidden += wall_.seen(beside, row) == Seen::kHiding ? 1 : 0;
    }
    constexpr int kLeastRows = 40;  // 60 cm
    if (visible < kLeastRows) return false;
    const double share = static_cast<double>(supported) / visible;
    worse = std::min(worse, share);
    better = std::max(better, share);
    seenRows += visible;
    if (2 * hidden > visible) ++hiddenSides;
  }
  constexpr double kLeastShare = 0.4;
  if (worse < kLeastShare) return false;
  found_.cue(Cue::kWeakerJamb) = worse;
  found_.cue(Cue::kStrongerJamb) = better;
  found_.cue(Cue::kHidden) = hiddenSides;
  found_.cue(Cue::kCut) = 1.0 - seenRows / (2.0 * std::max(1, bottom - top));
  return true;
}

/// Two leaves meet in a line.
bool Examination::hasMiddleLine(const std::vector<UprightLine>& lines) {
  const double middleX = 0.5 * (found_.left_x + found_.right_x) * wall_.shrinkage(found_.leaf_y);
  const double tolerance = 0.07 * (last_ - first_);
  const int top = leafRow(height_ - 0.1);
  const int bottom = leafRow(0.1);
  return std::ranges::any_of(lines, [&](const UprightLine& line) {
    return std::abs(line.columnAt(wall_.rowOf(1.0)) - wall_.columnOf(middleX)) < tolerance &&
           edges_.support(line, top, bottom) > 0.5;
  });
}

/// A frame has an edge on its inner and one on its outer side.
void Examination::lookBesideJambs(const std::vector<UprightLine>& lines) {
  const double near = 0.025 / RectifiedWall::kPixel;
  const double far = 0.11 / RectifiedWall::kPixel;
  const int top = leafRow(height_ - 0.1);
  const int bottom = leafRow(0.1);
  const auto strongest = [&](const UprightLine& jamb, double direction) {
    double most = 0.0;
    for (const auto& line : lines) {
      const double aside = direction * (line.columnAt(jamb.middleRow) - jamb.column);
      if (aside > near && aside < far) most = std::max(most, edges_.support(line, top, bottom));
    }
    return most;
  };
  found_.cue(Cue::kLineInside) = strongest(found_.leftLine, 1.0) + strongest(found_.rightLine, -1.0);
  found_.cue(Cue::kLineOutside) = strongest(found_.leftLine, -1.0) + strongest(found_.rightLine, 1.0);
}

void Examination::lookAtFoot() {
  const Box low = insideBox(0.06, 0.02, 0.06);
  const Box above = insideBox(0.06, 0.32, 0.6);
  const auto foot = medianColor(colorsIn(wall_, low, 1), 12);
  const auto leaf = medianColor(colorsIn(wall_, above, 3), 12);
  if (!foot || !leaf) return;
  found_.bottomIsSeen = true;
  double edge = 0.0;
  for (int row = leafRow(0.15); row < leafRow(0.045); ++row) {
    edge = std::max(edge, edges_.levelEdge(row, first_ + 2, last_ - 2));
  }
  found_.cue(Cue::kSkirting) = std::max(0.0, edge - 0.3);
  found_.cue(Cue::kReachesFloor) = 1.0 - std::min(1.0, difference(*foot, *leaf) / 40.0);
  std::vector<cv::Vec3b> outside =
      colorsIn(wall_, {first_ - columns(0.35), first_ - columns(kFrame), wallRow(0.055), wallRow(0.015)}, 1);
  const auto right =
      colorsIn(wall_, {last_ + columns(kFrame), last_ + columns(0.35), wallRow(0.055), wallRow(0.015)}, 1);
  outside.insert(outside.end(), right.begin(), right.end());
  if (const auto skirting = medianColor(outside, 10)) {
    // A leaf of the skirting's colour has no edge above it.
    const double alike = 1.0 - std::min(1.0, difference(*foot, *skirting) / 40.0);
    found_.cue(Cue::kSkirtingAlike) = alike * (1.0 - found_.cue(Cue::kReachesFloor));
  }
}

void Examination::lookAtLeaf() {
  const Box leaf = insideBox(0.05, 0.3, height_ - 0.08);
  const auto colors = colorsIn(wall_, leaf, 4);
  const auto color = medianColor(colors, 20);
  if (!color) return;
  found_.cue(Cue::kUniform) = shareLike(colors, *color) - 0.5;
  found_.cue(Cue::kClutter) = edges_.density(leaf.first, leaf.last, leaf.top, leaf.bottom);
  const int from = 2;
  const int to = std::max(4, columns(0.055));
  const auto atLeft = colorsIn(wall_, {first_ + from, first_ + to, leaf.top, leaf.bottom}, 2);
  const auto atRight = colorsIn(wall_, {last_ - to, last_ - from, leaf.top, leaf.bottom}, 2);
  if (atLeft.size() < 10 || atRight.size() < 10) return;
  found_.cue(Cue::kEdgeOfLeaf) = std::min(shareLike(atLeft, *color), shareLike(atRight, *color)) - 0.5;
}

/// A cupboard stands before what is around it, and a leaf that is open out of its wall.
void Examination::lookAtSurroundings() {
  constexpr int kEnough = 10;  // blocks
  const int near = columns(0.09);
  const int far = columns(0.35);
  const int top = wallRow(1.8);
  const int bottom = wallRow(0.4);
  const Box over{first_, last_, wallRow(height_ + 0.35), wallRow(height_ + 0.12)};
  const Places left = placesIn({first_ - far, first_ - near, top, bottom});
  const Places right = placesIn({last_ + near, last_ + far, top, bottom});
  const Places above = placesIn(over);
  found_.cue(Cue::kNothingAround) = (left.shareBehind() + right.shareBehind() + above.shareBehind()) / 2.0;
  const int known = left.known + right.known + above.known;
  const int apart = left.behind + left.before + right.behind + right.before + above.behind + above.before;
  if (known >= kEnough) found_.cue(Cue::kApart) = static_cast<double>(apart) / known;
  if (above.known >= kEnough) found_.cue(Cue::kTurnedAbove) = tiltedShare(profileOf(wall_, over), 0.015 + 1.5 * sigma_);
}

/// Of the wall's surface around a closed leaf, which lies at most a recess before it.
Examination::Places Examination::placesIn(const Box& unclipped) const {
  constexpr double kBehind = 0.1;   // metres
  constexpr double kRecess = 0.25;  // metres
  const double noise = 2.0 * sigma_;
  const Box box = clipped(unclipped, wall_);
  Places places;
  for (int row = box.top; row < box.bottom; row += RectifiedWall::kBlock) {
    for (int column = box.first; column < box.last; column += RectifiedWall::kBlock) {
      const float offset = wall_.offset(column, row);
      if (std::isnan(offset)) continue;
      const double deeper = static_cast<double>(offset) - found_.leaf_y;
      ++places.known;
      places.behind += deeper > kBehind + noise ? 1 : 0;
      places.before += deeper < -kRecess - noise ? 1 : 0;
    }
  }
  return places;
}

void Examination::lookAtHandle() {
  found_.handle = findHandle(wall_, found_.left_x, found_.right_x, found_.leaf_y);
  const Handle& handle = found_.handle;
  const double corner = found_.leaves == 2 ? handle.middle : std::max(handle.left, handle.right);
  if (corner > 0.0 && handle.leaf > 0.0) found_.cue(Cue::kHandle) = std::log(corner / handle.leaf);
}

/// Its size, and how well it is seen at all.
void Examination::judgeView() {
  const double leaf = found_.width() / found_.leaves;
  found_.cue(Cue::kNarrow) = std::max(0.0, 0.75 - leaf) / 0.1;
  found_.cue(Cue::kWide) = std::max(0.0, leaf - 1.05) / 0.1;
  const double middle = 0.5 * (found_.left_x + found_.right_x);
  found_.cue(Cue::kFar) = std::max(0.0, wall_.rangeAt(middle) - 4.0) / 2.0;
  found_.cue(Cue::kOblique) = std::min(4.0, std::tan(wall_.obliquenessAt(middle)));
  if (found_.top_z <= 0.0) return;
  found_.cue(Cue::kLow) = std::max(0.0, 1.7 - found_.top_z) / 0.1;
  found_.cue(Cue::kHigh) = std::max(0.0, found_.top_z - 2.15) / 0.1;
}

}  // namespace

std::vector<DoorCandidate> pairLines(const RectifiedWall& wall, const WallEdges& edges,
                                     const std::vector<UprightLine>& lines) {
  std::vector<DoorCandidate> candidates;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      const double appears = (lines[j].column - lines[i].column) * RectifiedWall::kPixel;
      if (appears < 0.6 * kLeastWidth || appears > 1.1 * kMostWidth) continue;
      const double slant = std::abs(lines[j].slope - lines[i].slope);
      if (slant > 0.06) continue;
      if (auto candidate = Examination(wall, edges, lines[i], lines[j]).run(lines)) candidates.push_back(*candidate);
    }
  }
  return candidates;
}

}  // namespace prodomos::perception
