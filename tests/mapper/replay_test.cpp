// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/mapper/replay.hpp"

#include "prodomos/base/error.hpp"

#include "mapper/drive.hpp"
#include "mapper/tables.hpp"
#include "support/memory_source.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::mapper {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

/// A log in which scans wait: odometry is told late, of every third step only, and some items are no readings.
std::vector<sensors::SourceItem> unevenLog() {
  std::vector<sensors::SourceItem> items;
  std::vector<sensors::Reading> late;
  int step = 0;
  for (auto& reading : shortDrive()) {
    if (reading.sensor != "odometry") {
      items.emplace_back(reading);
    } else if (step++ % 3 == 0) {
      late.push_back(reading);
    }
    if (items.size() % 4 == 3) {
      for (auto& odometry : late) items.emplace_back(odometry);
      late.clear();
      items.emplace_back(sensors::Skipped{"unsupported CObservationGPS", "", reading.time});
    }
  }
  return items;
}

class Replay : public ::testing::Test {
 protected:
  std::filesystem::path map(const std::string& name) const { return folder_.path() / name; }

  /// Into a new file, or on in one that is there. False where the source broke.
  bool run(const std::filesystem::path& path, test::MemorySource source, const MapperConfig& config = {}) {
    auto store = std::filesystem::exists(path) ? map::MapStore::openForWriting(path) : map::MapStore::create(path);
    Mapper mapper(store, config, std::as_const(source).info());
    try {
      replay(source, mapper);
    } catch (const test::Kill&) {
      return false;
    }
    report_ = mapper.report();
    return true;
  }

  test::TemporaryFolder folder_;
  Report report_;
};

TEST_F(Replay, GivesTheMapThatALiveProgramGets) {
  ASSERT_TRUE(run(map("replayed"), test::MemorySource(shortDrive())));
  {
    auto store = map::MapStore::create(map("live"));
    Mapper mapper(store, {}, liveInfo());
    for (auto& reading : shortDrive()) {
      mapper.process(reading);
      if (mapper.report().read % 50 == 0) mapper.view();  // to look at it changes nothing
    }
    mapper.finish();
  }
  EXPECT_TRUE(test::tablesOf(map("replayed")) == test::tablesOf(map("live")));
}

TEST_F(Replay, GivesTheSameMapTwice) {
  ASSERT_TRUE(run(map("one"), test::MemorySource(unevenLog())));
  ASSERT_TRUE(run(map("two"), test::MemorySource(unevenLog())));
  EXPECT_TRUE(test::tablesOf(map("one")) == test::tablesOf(map("two")));
}

TEST_F(Replay, EndsInTheSameMapWhereverItWasInterrupted) {
  const auto log = unevenLog();
  ASSERT_TRUE(run(map("undisturbed"), test::MemorySource(log)));
  const auto expected = test::tablesOf(map("undisturbed"));
  const auto report = report_;
  ASSERT_GT(report.submaps, 3);

  for (std::size_t item = 1; item <= log.size(); item += 23) {
    SCOPED_TRACE("interrupted at item " + std::to_string(item));
    const auto path = map("at" + std::to_string(item));
    ASSERT_FALSE(run(path, test::MemorySource(log).breakAt(item)));
    ASSERT_TRUE(run(path, test::MemorySource(log)));
    ASSERT_TRUE(test::tablesOf(path) == expected) << "interrupted at item " << item;
    EXPECT_EQ(report_.read, report.read);
    EXPECT_EQ(report_.used, report.used);
    EXPECT_EQ(report_.usedByKind, report.usedByKind);
    EXPECT_EQ(report_.skippedByReason, report.skippedByReason);
    EXPECT_EQ(report_.submaps, report.submaps);
    EXPECT_EQ(report_.distance, report.distance);
  }
}

/// The items with which a log's sub-maps are committed.
std::vector<std::size_t> commitsOf(const std::vector<sensors::SourceItem>& log, const MapperConfig& config) {
  std::vector<std::size_t> commits;
  auto store = map::MapStore::inMemory();
  Mapper mapper(store, config, liveInfo());
  int submaps = 0;
  for (std::size_t item = 0; item < log.size(); ++item) {
    if (const auto* reading = std::get_if<sensors::Reading>(&log[item])) mapper.process(*reading);
    if (mapper.report().submaps > std::max(submaps, 1)) commits.push_back(item);
    submaps = mapper.report().submaps;
  }
  return commits;
}

TEST_F(Replay, EndsInTheSameMapWhicheverSubMapItWasInterruptedIn) {  // loops and all
  const std::vector<sensors::SourceItem> log(slippingTour().begin(), slippingTour().end());
  ASSERT_TRUE(run(map("undisturbed"), test::MemorySource(log)));
  const auto expected = test::tablesOf(map("undisturbed"));
  const auto commits = commitsOf(log, {});
  ASSERT_GT(commits.size(), 8U);
  ASSERT_GT(expected.at("edge").size(), expected.at("node").size()) << "no loop was found";
  for (const std::size_t commit : commits) {
    const auto path = map("disturbed" + std::to_string(commit));
    ASSERT_FALSE(run(path, test::MemorySource(log).breakAt(commit + 1)));
    ASSERT_TRUE(run(path, test::MemorySource(log)));
    ASSERT_TRUE(test::tablesOf(path) == expected) << "interrupted after item " << commit;
  }
}

TEST_F(Replay, EndsInTheSameMapWithoutOdometry) {
  std::vector<sensors::SourceItem> log;
  for (const auto& reading : slippingTour()) {
    if (reading.sensor == "laser") log.emplace_back(reading);
  }
  log.resize(log.size() / 2);
  ASSERT_TRUE(run(map("undisturbed"), test::MemorySource(log)));
  for (const std::size_t item : {log.size() / 2, log.size() - 1}) {
    const auto path = map("disturbed" + std::to_string(item));
    ASSERT_FALSE(run(path, test::MemorySource(log).breakAt(item)));
    ASSERT_TRUE(run(path, test::MemorySource(log)));
    ASSERT_TRUE(test::tablesOf(path) == test::tablesOf(map("undisturbed"))) << "interrupted at item " << item;
  }
}

TEST_F(Replay, GoesOnWithAFurtherSessionInTheMapOfTheFirst) {
  const std::vector<sensors::SourceItem> log(slippingTour().begin(), slippingTour().end());
  for (const char* name : {"undisturbed", "disturbed"}) ASSERT_TRUE(run(map(name), test::MemorySource(log)));
  ASSERT_TRUE(run(map("undisturbed"), test::MemorySource(log)));
  ASSERT_FALSE(run(map("disturbed"), test::MemorySource(log).breakAt(log.size() / 2)));
  ASSERT_TRUE(run(map("disturbed"), test::MemorySource(log)));
  EXPECT_TRUE(test::tablesOf(map("disturbed")) == test::tablesOf(map("undisturbed")));
}

TEST_F(Replay, BearsBeingInterruptedAgainAndAgain) {
  const auto log = unevenLog();
  ASSERT_TRUE(run(map("undisturbed"), test::MemorySource(log)));
  for (std::size_t item = 60; item < log.size(); item += 60) {
    ASSERT_FALSE(run(map("disturbed"), test::MemorySource(log).breakAt(item)));
  }
  ASSERT_TRUE(run(map("disturbed"), test::MemorySource(log)));
  EXPECT_TRUE(test::tablesOf(map("disturbed")) == test::tablesOf(map("undisturbed")));
}

TEST_F(Replay, GoesOnWithRecordedPosesAsWell) {
  std::vector<sensors::SourceItem> log;
  for (auto& reading : shortDrive()) {
    if (const auto* odometry = std::get_if<sensors::Odometry>(&reading.data)) {
      log.emplace_back(sensors::Reading{reading.time, "pose", sensors::RecordedPose{odometry->T_odom_body}, ""});
    } else {
      log.emplace_back(reading);
    }
  }
  MapperConfig config;
  config.input.poses = "recorded";
  ASSERT_TRUE(run(map("undisturbed"), test::MemorySource(log), config));
  ASSERT_FALSE(run(map("disturbed"), test::MemorySource(log).breakAt(log.size() / 2), config));
  ASSERT_TRUE(run(map("disturbed"), test::MemorySource(log), config));
  EXPECT_TRUE(test::tablesOf(map("disturbed")) == test::tablesOf(map("undisturbed")));
}

TEST_F(Replay, RefusesToGoOnUnderAnotherConfiguration) {
  ASSERT_FALSE(run(map("map"), test::MemorySource(shortDrive()).breakAt(200)));
  MapperConfig other;
  other.submap.maxDistance = 3.0;
  EXPECT_THROW(run(map("map"), test::MemorySource(shortDrive()), other), base::UsageError);
  EXPECT_TRUE(run(map("map"), test::MemorySource(shortDrive())));
}

TEST_F(Replay, RefusesToGoOnWithAnotherLog) {
  const auto log = unevenLog();
  ASSERT_FALSE(run(map("map"), test::MemorySource(log).breakAt(log.size() - 1)));
  const std::vector<sensors::SourceItem> shorter(log.begin(), log.begin() + 3);
  try {
    run(map("map"), test::MemorySource(shorter));
    FAIL() << "went on";
  } catch (const base::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("memory.log"));
  }
}

TEST_F(Replay, TakesNothingMoreOnceTheFileCannotBeWritten) {
  auto store = map::MapStore::create(map("map"));
  Mapper mapper(store, {}, liveInfo());
  sqlite3* database = nullptr;
  sqlite3_open(map("map").c_str(), &database);
  test::rowsOf(database, "ALTER TABLE trajectory_point RENAME TO elsewhere");
  test::MemorySource source(shortDrive());
  EXPECT_THROW(replay(source, mapper), base::FileError);
  EXPECT_THROW(mapper.process(shortDrive().front()), base::Error);
  EXPECT_THROW(mapper.finish(), base::Error);
  test::rowsOf(database, "ALTER TABLE elsewhere RENAME TO trajectory_point");
  sqlite3_close(database);
  EXPECT_TRUE(store.view().graph().nodes().empty()) << "all or nothing";
  test::MemorySource again(shortDrive());
  Mapper next(store, {}, liveInfo());
  replay(again, next);
  ASSERT_TRUE(run(map("undisturbed"), test::MemorySource(shortDrive())));
  store.close();
  EXPECT_TRUE(test::tablesOf(map("map")) == test::tablesOf(map("undisturbed")));
}

TEST_F(Replay, ReportsWhereALogIsDamaged) {
  std::vector<sensors::SourceItem> log;
  for (auto& reading : shortDrive()) log.emplace_back(reading);
  log.emplace_back(sensors::Skipped{"unreadable image", "memory.log: image 7 is damaged"});
  ASSERT_TRUE(run(map("map"), test::MemorySource(log, "memory.log: cut at byte 1000")));
  EXPECT_THAT(report_.faults, ElementsAre("memory.log: image 7 is damaged", "memory.log: cut at byte 1000"));
  EXPECT_EQ(report_.read, report_.used + skippedOf(report_));
  EXPECT_EQ(map::MapView::open(map("map")).sessions().back().state, map::SessionState::kComplete);
}

TEST_F(Replay, TellsItsProgress) {
  test::MemorySource source(shortDrive());
  auto store = map::MapStore::inMemory();
  Mapper mapper(store, {}, std::as_const(source).info());
  double done = 0.0;
  int calls = 0;
  replay(source, mapper, [&](const base::Progress& progress) {
    EXPECT_GT(progress.done, done);
    done = progress.done;
    EXPECT_LE(done, progress.total);
    ++calls;
  });
  EXPECT_EQ(calls, mapper.report().read);
}

TEST(SelectInput, TakesSensorsStartAndEndFromTheConfiguration) {
  std::vector<sensors::Reading> log;
  for (int second = 0; second < 4; ++second) {
    for (const char* sensor : {"front", "rear", "top"}) {
      log.push_back({base::Time(std::chrono::seconds(100 + second)), sensor, sensors::LaserScan{}, ""});
    }
  }
  InputConfig config;
  config.sensors = "front,top";
  config.start = "101";
  config.end = "102.0";
  const auto source = selectInput(std::make_unique<test::MemorySource>(log), config);
  auto store = map::MapStore::inMemory();
  Mapper mapper(store, {}, source->info());
  replay(*source, mapper);
  EXPECT_EQ(mapper.report().used, 4);
  EXPECT_THAT(mapper.report().skippedByReason,
              UnorderedElementsAre(Pair("before start", 3), Pair("after end", 3), Pair("sensor not chosen", 2)));
}

TEST(SelectInput, RefusesStampsThatAreNone) {
  for (const char* stamp : {"soon", "1e9", "12,5", "-"}) {
    InputConfig config;
    config.end = stamp;
    try {
      selectInput(std::make_unique<test::MemorySource>(shortDrive()), config);
      ADD_FAILURE() << stamp << " was taken";
    } catch (const base::UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr("input.end"));
      EXPECT_THAT(error.what(), HasSubstr(stamp));
    }
  }
}

}  // namespace
}  // namespace prodomos::mapper
