// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/sensors/source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::sensors {
namespace {

using testing::ElementsAre;

base::Time at(int seconds) {
  return base::Time(std::chrono::seconds(seconds));
}

/// A scan of the sensors "front" and "rear", and odometry, at each of the seconds 0 to 3.
class FourSeconds final : public SensorSource {
 public:
  const SourceInfo& info() const override { return info_; }
  base::Progress progress() const override { return {static_cast<double>(next_), 12.0}; }
  SourceItem next() override {
    if (next_ == 12) return EndOfLog{};
    const auto time = at(next_ / 3);
    switch (next_++ % 3) {
      case 0:
        return Reading{time, "odometry", Odometry{}};
      case 1:
        return Reading{time, "front", LaserScan{}, "a bad beam"};
      default:
        return Reading{time, "rear", LaserScan{}};
    }
  }

 private:
  SourceInfo info_;
  int next_ = 0;
};

/// Of each item a word: the sensor, or the reason.
std::vector<std::string> words(SensorSource& source) {
  std::vector<std::string> result;
  for (auto item = source.next(); !std::holds_alternative<EndOfLog>(item); item = source.next()) {
    const auto* reading = std::get_if<Reading>(&item);
    result.push_back(reading != nullptr ? reading->sensor : std::get<Skipped>(item).reason);
  }
  return result;
}

TEST(Select, KeepsAllWhereNothingIsAskedFor) {
  const auto source = select(std::make_unique<FourSeconds>(), {});
  EXPECT_EQ(words(*source).size(), 12U);
}

TEST(Select, AlwaysKeepsOdometryBesideTheChosenSensors) {
  const auto source = select(std::make_unique<FourSeconds>(), {{"rear"}, {}, at(0)});
  EXPECT_THAT(words(*source),
              ElementsAre("odometry", "sensor not chosen", "rear", "after end", "after end", "after end", "after end",
                          "after end", "after end", "after end", "after end", "after end"));
}

TEST(Select, IncludesStartAndEnd) {
  const auto source = select(std::make_unique<FourSeconds>(), {{}, at(1), at(2)});
  EXPECT_THAT(words(*source), ElementsAre("before start", "before start", "before start", "odometry", "front", "rear",
                                          "odometry", "front", "rear", "after end", "after end", "after end"));
}

TEST(Select, CountsItemsAsTheLogDoes) {
  const auto source = select(std::make_unique<FourSeconds>(), {{"rear"}, {}, {}});
  source->skip(8);
  EXPECT_THAT(words(*source), ElementsAre("rear", "odometry", "sensor not chosen", "rear"));
  EXPECT_TRUE(std::holds_alternative<EndOfLog>(source->next()));
}

TEST(Select, TellsDamageInReadingsThatAreNotChosen) {
  const auto source = select(std::make_unique<FourSeconds>(), {{"rear"}, {}, {}});
  source->next();
  const auto item = source->next();
  EXPECT_EQ(std::get<Skipped>(item).fault, "a bad beam");
}

}  // namespace
}  // namespace prodomos::sensors
