// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
//
// floor_baselines FLOORS
//
// What the trivial predictors of rooms, and the guess of the room behind a door, reach on floors that they were not
// fitted to, drawn by others: in each folder of
// FLOORS (buildings/floors) occ_map.npy, 0 where there is a wall, and valid_space.npy, the number of the room of each
// pixel, 0 for none; 10 pixels a metre. A door is where the pixels of two rooms meet along 0.6 to 2.5 m, or a gap of
// that width that is free and of no room, between two. A space with four doors or more is a corridor. Corridors count
// as seen, and of the other rooms 0, 30 and 60 %, drawn by seed: what is seen is known with its walls, 0.1 m thick.
// Each door between a seen space and an unseen room of at most 60 m² is a case.
#include "prodomos/base/error.hpp"
#include "prodomos/base/random.hpp"
#include "prodomos/evaluation/baselines.hpp"
#include "prodomos/evaluation/room_shapes.hpp"
#include "prodomos/prediction/room_guess.hpp"

#include "support/seen_world.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace prodomos {
namespace {

namespace fs = std::filesystem;

constexpr double kPixel = 0.1;  // metres
constexpr std::size_t kDoorsOfCorridor = 4;
constexpr int kWall = 0;
constexpr double kLeastWidth = 0.6;  // metres, of a door
constexpr double kMostWidth = 2.5;
constexpr double kMostDepth = 0.8;  // metres from its middle into the rooms

struct Raster {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;

  int at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return 0;
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// NumPy's format, of bytes in two dimensions. The first row is the uppermost.
Raster readRaster(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto fail = [&](const std::string& found) -> Raster {
    throw base::FileError(base::expectedFound(path.string(), "a NumPy array of bytes in two dimensions", found));
  };
  if (bytes.size() < 10 || bytes.substr(1, 5) != "NUMPY") return fail("another file, or none");
  const std::size_t begin = 10 + static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
  const std::string header = bytes.substr(10, begin - 10);
  const auto shape = header.find("'shape': (");
  Raster raster;
  if (header.find("'|u1'") == std::string::npos || header.find("'fortran_order': False") == std::string::npos ||
      shape == std::string::npos ||
      std::sscanf(header.c_str() + shape, "'shape': (%d, %d)", &raster.height, &raster.width) != 2 ||
      bytes.size() - begin != static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height)) {
    return fail(header);
  }
  raster.pixels.assign(bytes.begin() + static_cast<std::ptrdiff_t>(begin), bytes.end());
  return raster;
}

/// Rooms by pixels, walls taken out; rows from below.
class Floor {
 public:
  explicit Floor(const fs::path& folder) : name_(folder.filename()), rooms_(readRaster(folder / "valid_space.npy")) {
    walls_ = readRaster(folder / "occ_map.npy");
    if (walls_.pixels.size() != rooms_.pixels.size())
      throw base::FileError(folder.string() + ": arrays differ in size");
    for (std::size_t i = 0; i < walls_.pixels.size(); ++i) {
      if (walls_.pixels[i] == kWall) rooms_.pixels[i] = 0;
    }
    findContacts();
    findGaps();
  }

  struct Door {
    std::array<int, 2> rooms{};
    geometry::Pose2 pose;  ///< x-axis into rooms[1]
    double width = 0.0;    ///< metres
  };

  const std::string& name() const { return name_; }
  const std::vector<Door>& doors() const { return doors_; }
  geometry::CellBox box() const { return {{-1, -1}, {rooms_.width, rooms_.height}}; }
  int roomAt(geometry::CellIndex cell) const { return rooms_.at(cell.x, rooms_.height - 1 - cell.y); }

  std::set<int> corridors() const {
    std::map<int, std::size_t> doorsOf;
    for (const auto& door : doors_) {
      for (const int room : door.rooms) ++doorsOf[room];
    }
    std::set<int> found;
    for (const auto& [room, count] : doorsOf) {
      if (count >= kDoorsOfCorridor) found.insert(room);
    }
    return found;
  }

  /// The outer loop of the room's pixel edges, counter-clockwise.
  evaluation::Polygon outlineOf(int room) const {
    std::multimap<geometry::CellIndex, geometry::CellIndex> edges;  // each with the room on its left
    for (int y = 0; y < rooms_.height; ++y) {
      for (int x = 0; x < rooms_.width; ++x) {
        if (roomAt({x, y}) != room) continue;
        if (roomAt({x, y - 1}) != room) edges.insert({{x, y}, {x + 1, y}});
        if (roomAt({x + 1, y}) != room) edges.insert({{x + 1, y}, {x + 1, y + 1}});
        if (roomAt({x, y + 1}) != room) edges.insert({{x + 1, y + 1}, {x, y + 1}});
        if (roomAt({x - 1, y}) != room) edges.insert({{x, y + 1}, {x, y}});
      }
    }
    evaluation::Polygon longest;
    while (!edges.empty()) {
      evaluation::Polygon loop;
      const auto begin = edges.begin()->first;
      auto here = begin;
      do {
        loop.emplace_back(kPixel * here.x, kPixel * here.y);
        const auto edge = edges.find(here);
        here = edge->second;
        edges.erase(edge);
      } while (here != begin);
      if (loop.size() > longest.size()) longest = std::move(loop);
    }
    return longest;
  }

 private:
  /// Where rooms meet.
  void findContacts() {
    std::map<std::array<int, 2>, std::vector<geometry::CellIndex>> met;  // by rooms: corners between their pixels
    for (int y = 0; y < rooms_.height; ++y) {
      for (int x = 0; x < rooms_.width; ++x) {
        const int here = roomAt({x, y});
        for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}}) {
          const int next = roomAt({x + dx, y + dy});
          if (here == 0 || next == 0 || here == next) continue;
          met[{std::min(here, next), std::max(here, next)}].push_back({x + dx, y + dy});
        }
      }
    }
    for (const auto& [rooms, corners] : met) addDoors(rooms, corners);
  }

  /// Corners no more than two pixels apart are one opening.
  void addDoors(const std::array<int, 2>& rooms, std::vector<geometry::CellIndex> corners) {
    while (!corners.empty()) {
      std::vector<geometry::CellIndex> opening = {corners.back()};
      corners.pop_back();
      for (std::size_t i = 0; i < opening.size(); ++i) {
        const auto isNear = [&](const auto& corner) {
          return std::abs(corner.x - opening[i].x) <= 2 && std::abs(corner.y - opening[i].y) <= 2;
        };
        std::ranges::copy_if(corners, std::back_inserter(opening), isNear);
        std::erase_if(corners, isNear);
      }
      addDoor(rooms, opening);
    }
  }

  bool isGap(geometry::CellIndex cell) const {
    return roomAt(cell) == 0 && walls_.at(cell.x, walls_.height - 1 - cell.y) != kWall;
  }

  /// Small free parts of no room that touch two rooms.
  void findGaps() {
    std::set<geometry::CellIndex> seen;
    for (int y = 0; y < rooms_.height; ++y) {
      for (int x = 0; x < rooms_.width; ++x) {
        if (!isGap({x, y}) || !seen.insert({x, y}).second) continue;
        std::vector<geometry::CellIndex> gap = {{x, y}};
        std::set<int> rooms;
        for (std::size_t i = 0; i < gap.size(); ++i) {
          for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
            const geometry::CellIndex next{gap[i].x + dx, gap[i].y + dy};
            if (roomAt(next) != 0) rooms.insert(roomAt(next));
            if (isGap(next) && seen.insert(next).second) gap.push_back(next);
          }
        }
        if (rooms.size() == 2) addDoor({*rooms.begin(), *rooms.rbegin()}, gap);
      }
    }
  }

  void addDoor(std::array<int, 2> rooms, const std::vector<geometry::CellIndex>& opening) {
    geometry::CellBox box;
    for (const auto cell : opening) box.add(cell);
    const Eigen::Vector2d middle(0.5 * (box.first.x + box.last.x + 1), 0.5 * (box.first.y + box.last.y + 1));
    // A wall with an opening, not a corner: the rooms lie on either side of it.
    for (const bool alongX : {true, false}) {
      const double width = kPixel * (alongX ? box.width() : box.height());
      const double reach = 0.5 * (alongX ? box.height() : box.width()) + 2.0;  // pixels
      const Eigen::Vector2d normal = alongX ? Eigen::Vector2d::UnitY() : Eigen::Vector2d::UnitX();
      const auto roomAhead = [&](double pixels) {
        const Eigen::Vector2d spot = middle + pixels * normal;
        return roomAt(geometry::cellAt(spot.x(), spot.y(), 1.0));
      };
      if (width < kLeastWidth || width > kMostWidth || kPixel * reach > kMostDepth) continue;
      if (roomAhead(reach) == rooms[0] && roomAhead(-reach) == rooms[1]) std::swap(rooms[0], rooms[1]);
      if (roomAhead(reach) != rooms[1] || roomAhead(-reach) != rooms[0]) continue;
      doors_.push_back(
          {rooms, {kPixel * middle.x(), kPixel * middle.y(), alongX ? 0.5 * std::numbers::pi : 0.0}, width});
      return;
    }
  }

  std::string name_;
  Raster rooms_;
  Raster walls_;
  std::vector<Door> doors_;
};

/// Sums of IoUs.
struct Reached {
  std::size_t count = 0;
  double halfDisc = 0.0;
  double fixedBox = 0.0;
  double clippedBox = 0.0;
  double guess = 0.0;
  double oracleBox = 0.0;

  void add(const evaluation::DoorView& view, const evaluation::Polygon& guessed_in_world) {
    const auto& sizes = evaluation::trainedBaselines();
    const auto radius = static_cast<std::size_t>(std::lround(sizes.halfDiscRadius / evaluation::kRadiusStep)) - 1;
    ++count;
    halfDisc += view.iousOfHalfDiscs()[radius];
    fixedBox += view.iou(sizes.fixedBox);
    clippedBox += view.iouClipped(sizes.clippedBox);
    guess += view.iou(guessed_in_world);
    oracleBox += view.iou(view.bestBox());
  }
  void print(const std::string& name) const {
    const auto mean = [this](double sum) { return count == 0 ? 0.0 : sum / static_cast<double>(count); };
    std::printf("%-18s %6zu %10.3f %10.3f %12.3f %7.3f %11.3f\n", name.c_str(), count, mean(halfDisc), mean(fixedBox),
                mean(clippedBox), mean(guess), mean(oracleBox));
  }
};

/// Seen rooms, and the walls around them, a pixel thick.
test::SeenWorld worldOf(const Floor& floor, const std::set<int>& seen) {
  geometry::CellMap<map::CellState> cells(floor.box(), map::CellState::kUnknown);
  for (int y = floor.box().first.y; y <= floor.box().last.y; ++y) {
    for (int x = floor.box().first.x; x <= floor.box().last.x; ++x) {
      if (seen.contains(floor.roomAt({x, y}))) {
        *cells.find({x, y}) = map::CellState::kFree;
        continue;
      }
      for (const int dy : {-1, 0, 1}) {
        for (const int dx : {-1, 0, 1}) {
          if (seen.contains(floor.roomAt({x + dx, y + dy}))) *cells.find({x, y}) = map::CellState::kOccupied;
        }
      }
    }
  }
  return {std::move(cells), kPixel};
}

evaluation::Polygon guessedRoom(const Floor& floor, const Floor::Door& door, const geometry::Pose2& T_world_door,
                                const std::set<int>& seen, const test::SeenWorld& world) {
  auto around = world.around(T_world_door);
  for (const auto& other : floor.doors()) {
    if (&other == &door || (!seen.contains(other.rooms[0]) && !seen.contains(other.rooms[1]))) continue;
    around.openings.push_back(
        {.id = {}, .T_here_opening = geometry::inverse(T_world_door) * other.pose, .width = other.width});
  }
  return geometry::transformed(T_world_door, prediction::guessRoom(around, door.width).outline_here);
}

void visitDoors(const Floor& floor, double shareSeen, Reached& reached, Reached& all) {
  auto seen = floor.corridors();
  base::Random random(static_cast<std::uint64_t>(100 * shareSeen), "floor_baselines " + floor.name());
  for (int room = 1; room < 256; ++room) {
    if (random.uniform() < shareSeen) seen.insert(room);
  }
  const auto world = worldOf(floor, seen);
  const auto isKnown = [&](const Eigen::Vector2d& point) { return world.at(point) != map::CellState::kUnknown; };
  for (const auto& door : floor.doors()) {
    for (const std::size_t far : {0U, 1U}) {
      if (seen.contains(door.rooms[far]) || !seen.contains(door.rooms[1 - far])) continue;
      const auto T_world_door = door.pose * geometry::Pose2{0.0, 0.0, far == 1 ? 0.0 : std::numbers::pi};
      const evaluation::DoorView view(T_world_door, floor.outlineOf(door.rooms[far]), isKnown, kPixel);
      if (view.roomArea() > evaluation::kLargestRoom) continue;
      const auto guessed = guessedRoom(floor, door, T_world_door, seen, world);
      reached.add(view, guessed);
      all.add(view, guessed);
    }
  }
}

int run(const fs::path& folder) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (fs::exists(entry.path() / "valid_space.npy")) folders.push_back(entry.path());
  }
  std::ranges::sort(folders);
  std::printf("%-18s %6s %10s %10s %12s %7s %11s   (mean IoU)\n", "floor", "cases", "half-disc", "fixed box",
              "clipped box", "guess", "oracle box");
  std::map<double, Reached> byShare;
  for (const auto& path : folders) {
    const Floor floor(path);
    Reached reached;
    for (const double share : test::kSharesSeen) visitDoors(floor, share, reached, byShare[share]);
    reached.print(floor.name());
  }
  for (const auto& [share, reached] : byShare) {
    reached.print("all, " + std::to_string(std::lround(100 * share)) + " % seen");
  }
  return 0;
}

}  // namespace
}  // namespace prodomos

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: floor_baselines FLOORS\n";
    return 2;
  }
  try {
    return prodomos::run(argv[1]);
  } catch (const std::exception& fault) {
    std::cerr << "floor_baselines: " << fault.what() << '\n';
    return 1;
  }
}
