// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/id.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <unordered_set>

namespace prodomos::base {
namespace {

TEST(Id, PrintsTheLetterOfItsKindAndItsNumber) {
  EXPECT_EQ(toString(SubMapId{12}), "s12");
  EXPECT_EQ(toString(EdgeId{1}), "e1");
  EXPECT_EQ(toString(EntityId{7}), "o7");
  EXPECT_EQ(toString(PredictionId{0}), "p0");
  EXPECT_EQ(toString(SessionId{3}), "r3");
  EXPECT_EQ(toString(TrackId{4}), "t4");
  std::ostringstream out;
  out << SubMapId{5};
  EXPECT_EQ(out.str(), "s5");
}

TEST(Id, IsReadBackAsItIsPrinted) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const EdgeId id{static_cast<std::int64_t>(random.uniform(0, 1e17))};
    EXPECT_EQ(parseId<EdgeId>(toString(id)), id);
  }
  EXPECT_EQ(parseId<SubMapId>("s0"), SubMapId{0});
  EXPECT_EQ(parseId<SubMapId>("s999999999999999999"), SubMapId{999'999'999'999'999'999});
}

TEST(Id, IsNotReadFromAnythingElse) {
  for (const char* text : {"", "s", "12", "S12", "e12", "s 12", " s12", "s12 ", "s-1", "s+1", "s1.0", "s1e3", "ss1",
                           "s0x1", "s99999999999999999999999999"}) {
    EXPECT_EQ(parseId<SubMapId>(text), std::nullopt) << "'" << text << "'";
  }
}

TEST(Id, IsOrderedByItsNumberAndHashes) {
  EXPECT_LT(SubMapId{2}, SubMapId{10});
  EXPECT_EQ((std::unordered_set<SubMapId>{{1}, {2}, {1}}).size(), 2U);
}

}  // namespace
}  // namespace prodomos::base
