// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Maps while the robot drives, and asks the map meanwhile. A rawlog plays the robot's driver here.
#include "prodomos/base/error.hpp"
#include "prodomos/io/from_mrpt.hpp"
#include "prodomos/mapper/mapper.hpp"
#include "prodomos/query/query.hpp"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/serialization/CArchive.h>

#include <iostream>

using namespace prodomos;

namespace {

/// What the robot's driver calls with each observation.
void onObservation(mapper::Mapper& mapper, const mrpt::obs::CObservation& observation) {
  auto item = io::fromMrpt(observation);
  if (auto* reading = std::get_if<sensors::Reading>(&item)) mapper.process(std::move(*reading));
  if (const auto* skipped = std::get_if<sensors::Skipped>(&item)) mapper.skip(*skipped);
}

/// What the planner asks now and then. The view is of the moment: what comes later does not change it.
void plan(const mapper::Mapper& mapper) {
  const map::MapView view = mapper.view();
  const auto home = query::placeAt(view, {.x = 0.0, .y = 0.0, .floor = 0});
  std::cout << view.graph().nodes().size() << " sub-maps, " << view.graph().places().size() << " places";
  if (home.submap) std::cout << "; home lies in " << *home.submap;
  std::cout << '\n';
}

void run(const char* log, const char* map) {
  auto store = map::MapStore::create(map);
  mapper::Mapper mapper(store, {}, {.path = "live", .kind = "my robot"});
  mrpt::io::CFileGZInputStream file(log);
  auto archive = mrpt::serialization::archiveFrom(file);
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr frame;
  mrpt::obs::CObservation::Ptr observation;
  std::size_t entry = 0;
  while (mrpt::obs::CRawlog::getActionObservationPairOrObservation(archive, action, frame, observation, entry)) {
    if (observation) onObservation(mapper, *observation);
    if (entry % 2000 == 0) plan(mapper);
  }
  mapper.finish();
  plan(mapper);
  std::cout << mapper.report().used << " of " << mapper.report().read << " readings used\n";
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return std::cerr << "usage: live_mapper LOG.rawlog MAP\n", 2;
  try {
    run(arguments[1], arguments[2]);
  } catch (const base::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
