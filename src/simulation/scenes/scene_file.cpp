// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/scene_file.hpp"

#include "prodomos/base/error.hpp"

#include "simulation/scenes/scene_reader.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

namespace prodomos::simulation {

Building SceneReader::read(const YAML::Node& root) {
  YamlMap map(faults_, root, "scene");
  building_.name = map.text("scene").value_or("");
  wallThickness_ = map.number("wall_thickness", {0.05, 0.6}).value_or(wallThickness_);
  slab_ = map.number("floor_thickness", {0.1, 1.0}).value_or(slab_);
  map.require("storeys", "a list of storeys");
  const auto storeys = map.list("storeys");
  if (map.has("storeys") && storeys.empty()) map.fault("storeys", "one storey or more", "none");
  std::vector<YamlMap> maps;
  for (std::size_t i = 0; i < storeys.size(); ++i) {
    maps.emplace_back(faults_, storeys[i], "storey " + std::to_string(i));
    readStorey(maps.back(), static_cast<int>(i));
  }
  const auto readAll = [&](std::string_view key, auto read) {
    for (std::size_t i = 0; i < maps.size(); ++i) {
      for (const auto& node : maps[i].list(key)) (this->*read)(node, static_cast<int>(i));
    }
  };
  readAll("doors", &SceneReader::readDoor);
  readAll("stairs", &SceneReader::readStairs);
  readAll("furniture", &SceneReader::readThing);
  readAll("people", &SceneReader::readPersonOf);
  for (const auto& node : map.list("lifts")) readLift(node);
  readLighting(map);
  for (auto& storey : maps) storey.finish();
  map.finish();
  faults_.throwIfAny();
  markFurnished();
  seatPeople();
  drawStates();
  return std::move(building_);
}

void SceneReader::readStorey(YamlMap& map, int storey) {
  const double below = storey == 0 ? 0.0 : building_.storeys.back().floor_z + rise(storey - 1);
  const double height = map.number("height", {2.2, 10.0}).value_or(2.8);
  building_.storeys.push_back({below, height});
  if (map.require("rooms", "a list of rooms")) {
    for (const auto& node : map.list("rooms")) readRoom(node, storey);
  }
  checkRoomsAreApart(storey);
  for (const auto& lamp : map.list("lamps")) {
    const auto point = parsePoint(lamp);
    if (!point || roomAt(building_, storey, *point) == kOutside) {
      map.fault("lamps", "a point [x, y] in a room", shown(lamp));
    } else {
      building_.lighting.lamps.emplace_back(point->x(), point->y(), below + height - 0.15);
    }
  }
}

std::string SceneReader::readId(YamlMap& map, std::string_view what) {
  if (!map.require("id", "a name")) return "";
  auto id = map.text("id").value_or("");
  map.rename(std::string(what) + " '" + id + "'");
  if (id == kOutsideName || !ids_.insert(id).second) {
    map.fault("id", "a name that nothing else has", "'" + id + "'");
  }
  return id;
}

std::optional<int> SceneReader::roomNamed(const std::string& id) const {
  const auto room = std::ranges::find(building_.rooms, id, &Room::id);
  if (room == building_.rooms.end()) return std::nullopt;
  return static_cast<int>(room - building_.rooms.begin());
}

void SceneReader::readRoom(const YAML::Node& node, int storey) {
  YamlMap map(faults_, node, "room");
  Room room;
  room.storey = storey;
  room.id = readId(map, "room");
  if (map.require("label", "what the room is: OFFICE, CORRIDOR, STAIRS")) room.label = map.text("label").value_or("");
  room.use = useOfLabel(room.label);
  const auto furnish = map.flag("furnish");
  const auto centreLines = readOutline(map);
  map.finish();
  if (centreLines.empty()) return;
  room.outline = insetBy(centreLines, wallThickness_ / 2.0);
  if (findSelfCrossing(room.outline) || signedArea(room.outline) < 0.1) {
    faults_.add(map.line(), map.name(), "a room wider than its walls are thick", "none between them");
    return;
  }
  building_.rooms.push_back(std::move(room));
  centreLines_.push_back(centreLines);
  roomLines_.push_back(map.line());
  furnish_.push_back(furnish);
}

/// Centre lines of the walls, counter-clockwise; empty where they are faulty.
Polygon SceneReader::readOutline(YamlMap& map) {
  if (map.has("rectangle") == map.has("polygon")) {
    map.fault("rectangle", "either 'rectangle' or 'polygon'", map.has("polygon") ? "both" : "none");
    map.find("rectangle");
    map.find("polygon");
    return {};
  }
  if (map.find("rectangle")) {
    const auto sides = map.numbers("rectangle", 4);
    if (!sides) return {};
    const auto& [x0, y0, x1, y1] = std::array{(*sides)[0], (*sides)[1], (*sides)[2], (*sides)[3]};
    if (x0 < x1 && y0 < y1) return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    map.fault("rectangle", "[x0, y0, x1, y1] with x0 < x1 and y0 < y1", shown(*map.find("rectangle")));
    return {};
  }
  Polygon polygon;
  for (const auto& item : map.list("polygon")) {
    const auto corner = parsePoint(item);
    if (corner) {
      polygon.push_back(*corner);
    } else {
      map.fault("polygon", "corners [x, y]", shown(item));
      return {};
    }
  }
  if (polygon.size() < 3) {
    map.fault("polygon", "three corners or more", std::to_string(polygon.size()));
    return {};
  }
  if (const auto crossing = findSelfCrossing(polygon)) {
    map.fault("polygon", "walls that do not cross or touch",
              "those from " + toText(polygon[crossing->first]) + " and from " + toText(polygon[crossing->second]));
    return {};
  }
  return tidied(std::move(polygon));
}

void SceneReader::checkRoomsAreApart(int storey) {
  for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto& room = building_.rooms[i];
      const auto& other = building_.rooms[j];
      if (room.storey != storey || other.storey != storey || !overlap(room.outline, other.outline)) continue;
      faults_.add(roomLines_[i], "room '" + room.id + "'", "a room of its own", "one that overlaps '" + other.id + "'");
    }
  }
}

bool isSceneFile(const std::filesystem::path& path) {
  constexpr std::size_t kEnough = 4096;
  std::ifstream file(path, std::ios::binary);
  std::string begin(kEnough, '\0');
  file.read(begin.data(), kEnough);
  begin.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  for (std::size_t at = 0; at < begin.size();) {
    const auto end = std::min(begin.find('\n', at), begin.size());
    const std::string_view line = std::string_view(begin).substr(at, end - at);
    const auto word = line.find_first_not_of(" \t\r");
    if (word != std::string_view::npos && line[word] != '#' && !line.starts_with("---")) {
      return line.starts_with("scene:");
    }
    at = end + 1;
  }
  return false;
}

Building readSceneFile(const std::filesystem::path& path, std::uint64_t seed) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw base::FileError(base::expectedFound(path.string(), "a scene file", "none that can be read"));
  }
  const std::string text(std::istreambuf_iterator<char>(file), {});
  try {
    return SceneReader(path, seed).read(YAML::Load(text));
  } catch (const YAML::Exception& fault) {
    throw base::FileError(
        base::expectedFound(path.string() + ":" + std::to_string(fault.mark.line + 1), "YAML", fault.msg));
  }
}

}  // namespace prodomos::simulation
