// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prediction/room_features.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::prediction {

namespace {

using geometry::CellIndex;
using map::CellState;

constexpr double kCell = Surroundings::kCell;
constexpr std::array kRows = {0.5, 1.2, 2.0, 3.0, 4.5, 6.0, 8.0};        // metres ahead
constexpr std::array kColumns = {-5.0, -2.5, -1.0, 0.0, 1.0, 2.5, 5.0};  // metres to the left
constexpr CellIndex kAhead{1, 0};
constexpr CellIndex kBack{-1, 0};
constexpr CellIndex kLeft{0, 1};
constexpr CellIndex kRight{0, -1};
constexpr double kBehindLeaf = 0.35;  // metres: the own wall is thinner
constexpr double kOwnWall = 0.7;      // metres: doors no farther ahead or behind belong to it
constexpr double kStep = 1.0;         // metres behind an opening, in the space that it leads to

constexpr std::array kBeyond = {0.15, 0.75};  // metres beyond a wall that may be there

float valueAt(const std::vector<float>& byCell, double distance) {
  const auto cell = static_cast<std::size_t>(distance / kCell);
  return cell < byCell.size() ? byCell[cell] : RoomFeatures::kFar;
}

/// False for what is not a number.
bool isInWindow(const geometry::Pose2& pose) {
  const auto& box = Surroundings::kBox;
  return pose.x >= kCell * box.first.x && pose.x < kCell * (box.last.x + 1) && pose.y >= kCell * box.first.y &&
         pose.y < kCell * (box.last.y + 1) && std::isfinite(pose.theta);
}

}  // namespace

ReachableArea areaOf(const CellSet& reachable) {
  ReachableArea area;
  const auto& box = reachable.box();
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      if (reachable.at({x, y}) == 0) continue;
      area.all += 1.0F;
      if (x < 50 && y >= -40 && y < 40) area.nearby += 1.0F;
      if (x < 20 && y >= -15 && y < 15) area.close += 1.0F;
    }
  }
  for (auto* cells : {&area.close, &area.nearby, &area.all}) *cells *= static_cast<float>(kCell * kCell);
  return area;
}

RoomFeatures::RoomFeatures(const Surroundings& around, double doorWidth, bool mirrored)
    : around_(around), mirrored_(mirrored), doorWidth_(doorWidth) {
  sortOpenings(mirrored);
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    rowsLeft_[i] = firstKnown(kRows[i], 0.05, kLeft);
    rowsRight_[i] = firstKnown(kRows[i], -0.05, kRight);
    columns_[i] = firstKnown(kBehindLeaf, kColumns[i], kAhead);
  }
  for (int x = 0; x <= Surroundings::kBox.last.x; ++x) {
    const double ahead = geometry::cellCentre(x, kCell);
    toLeft_.push_back(firstKnown(ahead, 0.05, kLeft).distance);
    toRight_.push_back(firstKnown(ahead, -0.05, kRight).distance);
  }
  for (int y = 0; y <= Surroundings::kBox.last.y; ++y) {
    toEnd_.push_back(firstKnown(kBehindLeaf, geometry::cellCentre(y, kCell), kAhead).distance);
  }
  seenLeft_ = seenRoom(1);
  seenRight_ = seenRoom(-1);
  tellDoors();
  tellCorridor();
  tellSpace();
  tellSeenRooms();
}

CellState RoomFeatures::at(CellIndex cell) const {
  return around_.state(CellIndex{cell.x, mirrored_ ? -1 - cell.y : cell.y});
}

CellState RoomFeatures::at(double ahead, double across) const {
  return at(geometry::cellAt(ahead, across, kCell));
}

RoomFeatures::Hit RoomFeatures::firstKnown(double ahead, double across, CellIndex step) const {
  CellIndex cell = geometry::cellAt(ahead, across, kCell);
  for (int steps = 0; Surroundings::kBox.contains(cell); ++steps, cell = {cell.x + step.x, cell.y + step.y}) {
    const auto state = at(cell);
    if (state == CellState::kUnknown) continue;
    const double from = step.x != 0 ? std::abs(ahead) : std::abs(across);
    return {static_cast<float>(from + steps * kCell), state == CellState::kFree};
  }
  return {};
}

/// Metres from there.
float RoomFeatures::endOfFree(double ahead, double across, CellIndex step) const {
  CellIndex cell = geometry::cellAt(ahead, across, kCell);
  int steps = 0;
  for (; Surroundings::kBox.contains(cell); ++steps, cell = {cell.x + step.x, cell.y + step.y}) {
    if (at(cell) != CellState::kFree) return static_cast<float>(steps * kCell);
  }
  return kFar;
}

/// `side` 1: left, -1: right.
RoomFeatures::SeenRoom RoomFeatures::seenRoom(int side) const {
  constexpr double kLook = 1.5;  // metres ahead
  CellIndex cell = geometry::cellAt(kLook, side * 0.5, kCell);
  while (Surroundings::kBox.contains(cell) && at(cell) != CellState::kFree) cell.y += side;
  if (!Surroundings::kBox.contains(cell)) return {};
  const double begin = geometry::cellCentre(cell.y, kCell);
  SeenRoom room{static_cast<float>(std::abs(begin)), endOfFree(kLook, begin, {0, side}), kFar};
  const double middle = begin + side * 0.5 * std::min(4.0, static_cast<double>(room.width));
  if (const float depth = endOfFree(kLook, middle, kAhead); depth < kFar)
    room.depth = static_cast<float>(kLook) + depth;
  return room;
}

void RoomFeatures::sortOpenings(bool mirrored) {
  for (const auto& opening : around_.openings) {
    geometry::Pose2 pose = opening.T_here_opening;
    if (!isInWindow(pose)) continue;
    if (mirrored) pose = {pose.x, -pose.y, -pose.theta};
    const double facing = std::cos(pose.theta);
    const auto behind = [&](double step) {
      const geometry::Pose2 there = pose * geometry::Pose2{step, 0.0, 0.0};
      return Eigen::Vector2d(there.x, there.y);
    };
    for (const double step : {kStep, -kStep}) {
      const auto point = behind(step);
      if (at(point.x(), point.y()) == CellState::kUnknown && point.x() > 0.0) entrances_.push_back(point);
    }
    if (std::abs(facing) < 0.8) continue;
    if (std::abs(pose.x) < kOwnWall && std::abs(pose.y) > 0.3) {
      const bool leadsToKnown = at(pose.x + kStep, pose.y) != CellState::kUnknown;
      (pose.y > 0.0 ? left_ : right_).push_back({std::abs(pose.y), leadsToKnown});
    } else if (pose.x < -kOwnWall && pose.x > -5.0) {
      opposite_.push_back(pose.y);
    } else if (pose.x > 1.5 && std::hypot(pose.x, pose.y) < std::hypot(oppositeAhead_, oppositeAcross_)) {
      oppositeAhead_ = static_cast<float>(pose.x);
      oppositeAcross_ = static_cast<float>(pose.y);
    }
  }
  const auto nearer = [](const Neighbour& a, const Neighbour& b) { return a.across < b.across; };
  std::ranges::sort(left_, nearer);
  std::ranges::sort(right_, nearer);
  std::ranges::sort(opposite_, [](double a, double b) { return std::abs(a) < std::abs(b); });
}

void RoomFeatures::tellDoors() {
  std::vector<float> gaps;
  for (const auto* side : {&left_, &right_}) {
    double from = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      const bool exists = i < side->size();
      door_.push_back(exists ? static_cast<float>((*side)[i].across) : kFar);
      if (i == 0) door_.push_back(exists ? ((*side)[i].leadsToKnown ? 1.0F : 0.0F) : -1.0F);
      if (exists) gaps.push_back(static_cast<float>((*side)[i].across - from));
      if (exists) from = (*side)[i].across;
    }
  }
  if (!gaps.empty()) {
    const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
    std::ranges::nth_element(gaps, middle);
    spacing_ = *middle;
  }
  door_.push_back(door_[2] - door_[0]);  // the next two doors' spacing
  door_.push_back(door_[5] - door_[3]);
  door_.push_back(door_[0] - door_[3]);
  door_.push_back(static_cast<float>(doorWidth_));
  door_.push_back(spacing_);
  door_.push_back(static_cast<float>(left_.size() + right_.size()));
  door_.push_back(opposite_.empty() ? kFar : static_cast<float>(opposite_[0]));
  door_.push_back(opposite_.size() < 2 ? kFar : static_cast<float>(std::abs(opposite_[1] - opposite_[0])));
  door_.push_back(oppositeAhead_);
  door_.push_back(oppositeAcross_);
}

void RoomFeatures::tellCorridor() {
  std::array<float, 3> widths{};
  for (std::size_t i = 0; i < 3; ++i) widths[i] = endOfFree(-0.45, 0.4 * (static_cast<double>(i) - 1.0), kBack);
  std::ranges::sort(widths);
  door_.push_back(widths[1]);
  corridorLeft_ = endOfFree(-0.7, 0.0, kLeft);
  door_.push_back(corridorLeft_);
  door_.push_back(endOfFree(-0.7, 0.0, kRight));
  // Where the own wall ends: one looks past it.
  for (const int side : {1, -1}) {
    CellIndex cell = geometry::cellAt(kBehindLeaf, side * 0.5, kCell);
    while (Surroundings::kBox.contains(cell) && at(cell) != CellState::kFree) cell.y += side;
    door_.push_back(Surroundings::kBox.contains(cell) ? static_cast<float>(kCell * std::abs(cell.y)) : kFar);
  }
}

void RoomFeatures::tellSpace() {
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    door_.push_back(rowsLeft_[i].distance);
    door_.push_back(rowsRight_[i].distance);
    door_.push_back(columns_[i].distance);
  }
  door_.push_back(columns_[3].isFree ? 1.0F : 0.0F);
  std::array<int, 3> known{};
  std::array<int, 2> farthest{};
  for (int y = -80; y < 80; y += 2) {
    for (int x = 4; x < 100; x += 2) {
      if (!isKnown({x, y})) continue;
      ++known[y < -25 ? 0 : y < 25 ? 1 : 2];
      auto& end = farthest[std::abs(y) < 30 ? 0 : 1];
      end = std::max(end, x);
    }
  }
  for (const int count : known) door_.push_back(static_cast<float>(count) / 1000.0F);
  for (const int x : farthest) door_.push_back(static_cast<float>(kCell * x));
}

void RoomFeatures::tellSeenRooms() {
  for (const auto* room : {&seenLeft_, &seenRight_}) {
    door_.push_back(room->across);
    door_.push_back(room->width);
    door_.push_back(room->depth);
  }
}

/// How much nearer the point is to this door than to any other that may lead to it, metres.
float RoomFeatures::competition(double ahead, double across) const {
  const Eigen::Vector2d point(ahead, across);
  double nearest = kFar;
  for (const auto& entrance : entrances_) nearest = std::min(nearest, (entrance - point).norm());
  return static_cast<float>(nearest - (Eigen::Vector2d(kStep, 0.0) - point).norm());
}

const std::vector<float>& RoomFeatures::ofSide(double across, double other) {
  question_ = door_;
  const auto u = static_cast<float>(across);
  const auto tell = [this](float value) { question_.push_back(value); };
  tell(u);
  tell(static_cast<float>(other));
  tell(u + static_cast<float>(other));
  tell(static_cast<float>(other) - (right_.empty() ? kFar : static_cast<float>(right_.front().across)));
  const float neighbour = left_.empty() ? kFar : static_cast<float>(left_.front().across);
  tell(neighbour - u);
  tell(u / neighbour);
  tell(left_.size() < 2 ? kFar : static_cast<float>(left_[1].across) - u);
  for (const auto& hit : rowsLeft_) tell(hit.distance - u);
  float soonest = kFar;
  for (std::size_t i = 1; i < 5; ++i) soonest = std::min(soonest, rowsLeft_[i].distance);
  tell(soonest - u);
  for (const double more : kBeyond) tell(valueAt(toEnd_, across + more));
  tell(competition(1.5, across));
  tell(competition(3.5, across));
  tell(opposite_.empty() ? kFar : static_cast<float>(opposite_[0]) - u);
  tell(corridorLeft_ - u);  // the corridor's end
  tell(at(0.0, across + 0.15) == CellState::kOccupied ? 1.0F : 0.0F);
  tell(at(-0.5, across + 0.15) == CellState::kFree ? 1.0F : 0.0F);
  return question_;
}

const std::vector<float>& RoomFeatures::ofSpace(const ReachableArea& area) {
  question_ = door_;
  question_.insert(question_.end(), {area.close, area.nearby, area.all});
  return question_;
}

const std::vector<float>& RoomFeatures::ofEnd(double ahead, double width) {
  question_ = door_;
  const auto v = static_cast<float>(ahead);
  const auto tell = [this](float value) { question_.push_back(value); };
  tell(v);
  tell(static_cast<float>(width));
  tell(v / static_cast<float>(width));
  for (std::size_t i = 1; i < 6; ++i) tell(columns_[i].distance - v);
  tell(std::min({columns_[2].distance, columns_[3].distance, columns_[4].distance}) - v);
  tell(seenLeft_.depth - v);
  tell(seenRight_.depth - v);
  for (const double more : kBeyond) {
    tell(valueAt(toLeft_, ahead + more));
    tell(valueAt(toRight_, ahead + more));
  }
  tell(competition(ahead, 0.0));
  tell(oppositeAhead_ - v);
  return question_;
}

}  // namespace prodomos::prediction
