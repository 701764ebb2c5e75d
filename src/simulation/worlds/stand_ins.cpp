// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/stand_ins.hpp"

#include "prodomos/simulation/furniture.hpp"

#include "simulation/worlds/storey_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string>
#include <utility>

namespace prodomos::simulation {
namespace {

constexpr double kAgainstWall = 0.8;  ///< what is nearer to a wall than this stands or hangs against it
constexpr double kQuarter = std::numbers::pi / 2.0;

Eigen::Vector2d unit(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

/// Heading of the front.
double frontOf(const StandIn& standIn, const geometry::Pose2& pose, const std::vector<Segment>& walls) {
  if (standIn.front == Front::kX) return pose.theta;
  if (standIn.front == Front::kMinusY) return pose.theta - kQuarter;
  const double step = standIn.front == Front::kXOffWall ? 2.0 * kQuarter : kQuarter;
  double best = pose.theta;
  double nearest = std::numeric_limits<double>::infinity();
  for (double turn = 0.0; turn < 3.9 * kQuarter; turn += step) {
    const double distance = distanceTo(walls, {pose.x, pose.y}, -unit(pose.theta + turn));
    if (distance < nearest) std::tie(nearest, best) = std::pair(distance, pose.theta + turn);
  }
  return best;
}

/// The middle of the thing, moved so that its back touches the wall it stands against, or does not stick in it.
Eigen::Vector2d middleOf(const StandIn& standIn, const geometry::Pose2& pose, double front, bool hangs,
                         const std::vector<Segment>& walls) {
  Eigen::Vector2d middle = Eigen::Vector2d(pose.x, pose.y) + standIn.forward * unit(front);
  const double wall = distanceTo(walls, middle, -unit(front));
  const double room = wall - standIn.size.x() / 2.0;
  if (wall > kAgainstWall || (room > 0.0 && !hangs)) return middle;
  return middle - room * unit(front);
}

std::string numbered(std::string_view prefix, std::size_t number) {
  return std::string(prefix) + std::to_string(number);
}

void addPerson(const StandIn& standIn, int storey, const Eigen::Vector2d& position, double heading,
               Building& building) {
  building.people.push_back({.id = numbered("p", building.people.size()),
                             .storey = storey,
                             .height = standIn.personHeight,
                             .sits = standIn.person == Posture::kSits,
                             .heading = geometry::normalizeAngle(heading),
                             .way = {{0.0, position}},
                             .look = building.people.size() + 1});
}

}  // namespace

std::span<const StandIn> standIns() {
  using Size = Eigen::Vector3d;
  using enum Front;
  using enum Posture;
  static const std::array kTable{
      StandIn{"AdjTable", "desk", Size(0.8, 1.6, 0.74)},
      StandIn{"AnesthesiaMachine", "printer", Size(0.65, 0.75, 1.15), kOffWall},
      StandIn{"BMWCart", "cart", Size(0.55, 0.8, 1.0)},
      StandIn{"BPCart", "cart", Size(0.5, 0.5, 1.1)},
      StandIn{"BedTable", "table", Size(0.45, 0.8, 0.9)},
      StandIn{"BedsideTable", "bedside_table", Size(0.42, 0.48, 0.6), kOffWall},
      StandIn{"BloodPressureMonitor", "cart", Size(0.5, 0.5, 1.1)},
      StandIn{"CGMClassic", "hospital_bed", Size(2.1, 0.98, 1.0), kXOffWall},
      StandIn{"Chair", "chair", Size(0.5, 0.46, 0.88)},
      StandIn{"Drawer", "filing_cabinet", Size(0.5, 0.45, 0.7), kOffWall},
      StandIn{"ElderLadyPatient", "hospital_bed", Size(2.1, 0.98, 1.0), kXOffWall},
      StandIn{"ElderMalePatient", "hospital_bed", Size(2.1, 0.98, 1.0), kXOffWall},
      StandIn{"FemaleVisitor", "", Size::Zero(), kMinusY, 0.0, kStands, 1.66},
      StandIn{"FemaleVisitorSit", "", Size::Zero(), kMinusY, 0.0, kSits, 1.66},
      StandIn{"InstrumentCart1", "cart", Size(0.5, 0.8, 1.0), kOffWall},
      StandIn{"InstrumentCart2", "cart", Size(0.5, 0.8, 1.0), kOffWall},
      StandIn{"KitchenSink", "sink", Size(0.5, 0.6, 0.88), kXOffWall},
      StandIn{"MalePatientBed", "hospital_bed", Size(2.1, 0.98, 1.0), kXOffWall},
      StandIn{"MaleVisitorOnPhone", "", Size::Zero(), kMinusY, 0.0, kStands, 1.79},
      StandIn{"MaleVisitorSit", "", Size::Zero(), kMinusY, 0.0, kSits, 1.78},
      StandIn{"MetalCabinet", "cupboard", Size(0.5, 0.95, 1.9), kOffWall},
      StandIn{"MopCart3", "cart", Size(0.5, 0.9, 1.0)},
      StandIn{"OfficeChairBlack", "office_chair", Size(0.6, 0.6, 1.05)},
      StandIn{"ParkingTrolleyMax", "cart", Size(0.6, 1.0, 1.1), kOffWall},
      StandIn{"ParkingTrolleyMin", "cart", Size(0.5, 0.75, 1.0), kOffWall},
      StandIn{"PatientWheelChair", "office_chair", Size(0.62, 0.6, 0.95), kMinusY, 0.0, kSits, 1.68},
      StandIn{"PotatoChipChair", "bench", Size(0.45, 1.45, 0.46), kX, 0.25},
      StandIn{"Scrubs", "", Size::Zero(), kMinusY, 0.0, kStands, 1.74},
      StandIn{"Shower", "bathtub", Size(0.8, 0.9, 0.55), kOffWall},
      StandIn{"StorageRack", "storage_shelf", Size(0.5, 1.2, 1.8), kOffWall},
      StandIn{"StorageRackCoverOpen", "storage_shelf", Size(0.5, 1.2, 1.8), kOffWall},
      StandIn{"StorageRackCovered", "cupboard", Size(0.5, 1.2, 1.8), kOffWall},
      StandIn{"SurgicalTrolley", "cart", Size(0.55, 0.9, 0.95)},
      StandIn{"SurgicalTrolleyMed", "cart", Size(0.55, 0.9, 0.95)},
      StandIn{"Toilet", "toilet", Size(0.68, 0.4, 0.8), kXOffWall},
      StandIn{"TrolleyBed", "hospital_bed", Size(2.05, 0.95, 0.95), kX},
      StandIn{"TrolleyBedPatient", "hospital_bed", Size(2.05, 0.95, 0.95), kX},
      StandIn{"VendingMachine", "vending_machine", Size(0.8, 0.95, 1.85), kXOffWall},
      StandIn{"VisitorKidSit", "", Size::Zero(), kMinusY, 0.0, kSits, 1.25},
      StandIn{"WhiteChipChair", "chair", Size(0.5, 0.46, 0.85), kX},
      StandIn{"XRayMachine", "vending_machine", Size(0.85, 1.0, 1.8), kOffWall},
      StandIn{"aws_robomaker_hospital_curtain_closed_01", "curtain", Size(0.1, 2.4, 2.1), kX, 1.1},
      StandIn{"aws_robomaker_hospital_curtain_half_open_01", "curtain", Size(0.1, 1.3, 2.1), kX, 1.1},
      StandIn{"aws_robomaker_hospital_curtain_open_01", "curtain", Size(0.12, 0.6, 2.1), kX, 1.1},
      StandIn{"aws_robomaker_hospital_nursesstation_01", "counter", Size(0.8, 2.8, 1.1), kMinusY},
      StandIn{"aws_robomaker_residential_CoffeeTable_01", "coffee_table", Size(0.6, 1.1, 0.42)},
      StandIn{"aws_robomaker_residential_KitchenCabinet_01", "kitchen_counter", Size(0.6, 2.2, 0.9), kOffWall},
      StandIn{"aws_robomaker_residential_PortraitA_01", "poster", Size(0.01, 0.6, 0.8), kOffWall},
      StandIn{"aws_robomaker_residential_PortraitD_01", "poster", Size(0.01, 0.7, 0.9), kOffWall},
      StandIn{"aws_robomaker_residential_PortraitD_02", "poster", Size(0.01, 0.7, 0.9), kOffWall},
      StandIn{"aws_robomaker_residential_PortraitE_01", "poster", Size(0.01, 0.6, 0.6), kOffWall},
      StandIn{"aws_robomaker_residential_PortraitE_02", "poster", Size(0.01, 0.6, 0.6), kOffWall},
      StandIn{"aws_robomaker_residential_Refrigerator_01", "fridge", Size(0.66, 0.7, 1.8), kOffWall},
      StandIn{"aws_robomaker_residential_SofaB_01", "armchair", Size(0.85, 0.85, 0.85), kX},
      StandIn{"aws_robomaker_residential_Sofa_01", "sofa", Size(0.9, 2.0, 0.85), kX},
      StandIn{"aws_robomaker_residential_TV_02", "tv", Size(0.06, 1.2, 0.7), kOffWall},
      StandIn{"aws_robomaker_residential_Trash_01", "bin", Size(0.3, 0.3, 0.4)},
      StandIn{"aws_robomaker_warehouse_ClutteringA_01", "box_pile", Size(1.2, 1.1, 1.1)},
      StandIn{"aws_robomaker_warehouse_ClutteringC_01", "box_pile", Size(1.2, 1.1, 1.1)},
  };
  return kTable;
}

const StandIn* findStandIn(std::string_view model) {
  const auto all = standIns();
  const auto found = std::ranges::find(all, model, &StandIn::model);
  return found == all.end() ? nullptr : &*found;
}

void addStandIn(const StandIn& standIn, int storey, const geometry::Pose3& T_world_model,
                const std::vector<Segment>& walls, Building& building) {
  const auto pose = geometry::toPose2(T_world_model);
  const double front = frontOf(standIn, pose, walls);
  if (standIn.person != Posture::kNone) addPerson(standIn, storey, {pose.x, pose.y}, front, building);
  if (standIn.kind.empty()) return;
  const ThingKind& kind = *findThingKind(standIn.kind);
  // Curtains hang from rails between beds, everything else that hangs does so on walls.
  const bool hangsOnWall = kind.hangs && standIn.front == Front::kOffWall;
  const Eigen::Vector2d middle = middleOf(standIn, pose, front, hangsOnWall, walls);
  const double level = building.storeys[static_cast<std::size_t>(storey)].floor_z;
  const double z = hangsOnWall ? T_world_model.translation().z() : level + kind.bottom + standIn.size.z() / 2.0;
  building.things.push_back({.id = numbered("t", building.things.size()),
                             .kind = std::string(standIn.kind),
                             .storey = storey,
                             .T_world_thing = geometry::toPose3({middle.x(), middle.y(), front}, z),
                             .size = standIn.size});
}

std::string_view labelByThings(const Building& building, int room) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kLabels{{{"toilet", "TOILET"},
                                                                                  {"hospital_bed", "WARD"},
                                                                                  {"desk", "OFFICE"},
                                                                                  {"sofa", "LOUNGE"},
                                                                                  {"bathtub", "WASHROOM"},
                                                                                  {"sink", "WASHROOM"},
                                                                                  {"cupboard", "STORE"},
                                                                                  {"storage_shelf", "STORE"}}};
  const auto& outline = building.rooms[static_cast<std::size_t>(room)].outline;
  const int storey = building.rooms[static_cast<std::size_t>(room)].storey;
  for (const auto& [kind, label] : kLabels) {
    for (const auto& thing : building.things) {
      const Eigen::Vector2d position = thing.T_world_thing.translation().head<2>();
      if (thing.kind == kind && thing.storey == storey && contains(outline, position)) return label;
    }
  }
  return "ROOM";
}

}  // namespace prodomos::simulation
