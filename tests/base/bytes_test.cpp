// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/bytes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace prodomos::base {
namespace {

enum class Colour : std::uint8_t { kRed, kGreen };

struct Dot {
  float x = 0;
  float y = 0;
  bool operator==(const Dot&) const = default;
};

struct Everything {
  bool yes = false;
  std::int8_t small = 0;
  std::int64_t large = 0;
  double real = 0;
  float infinite = 0;
  double notANumber = 0;
  Colour colour = Colour::kRed;
  std::string text;
  std::string noText = "not read yet";
  std::vector<Dot> dots;
  std::vector<double> noDoubles{1, 2, 3};
};

ByteWriter writeEverything() {
  ByteWriter out;
  out << true << std::int8_t{-5} << std::int64_t{-1'234'567'890'123} << 0.1 << -std::numeric_limits<float>::infinity()
      << std::numeric_limits<double>::quiet_NaN() << Colour::kGreen << std::string("two\0words", 9) << ""
      << std::vector<Dot>{{1, 2}, {3, 4}} << std::vector<double>{};
  return out;
}

Everything readEverything(ByteReader& in) {
  Everything e;
  in >> e.yes >> e.small >> e.large >> e.real >> e.infinite >> e.notANumber >> e.colour >> e.text >> e.noText >>
      e.dots >> e.noDoubles;
  return e;
}

TEST(Bytes, AreReadBackAsTheyAreWritten) {
  const auto out = writeEverything();
  ByteReader in(out.bytes());
  const auto e = readEverything(in);
  EXPECT_EQ(in.left(), 0U);
  EXPECT_TRUE(e.yes);
  EXPECT_EQ(e.small, -5);
  EXPECT_EQ(e.large, -1'234'567'890'123);
  EXPECT_EQ(e.real, 0.1);
  EXPECT_EQ(e.infinite, -std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(e.notANumber));
  EXPECT_EQ(e.colour, Colour::kGreen);
  EXPECT_EQ(e.text, std::string("two\0words", 9));
  EXPECT_EQ(e.noText, "");
  EXPECT_EQ(e.dots, (std::vector<Dot>{{1, 2}, {3, 4}}));
  EXPECT_TRUE(e.noDoubles.empty());
}

TEST(Bytes, ThrowWhereverTheyAreCutOff) {
  const auto bytes = writeEverything().take();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    ByteReader in(std::span<const std::byte>(bytes).first(length));
    EXPECT_THROW(readEverything(in), Error) << length << " of " << bytes.size() << " bytes";
  }
}

TEST(Bytes, ThrowOnALengthThatCannotBe) {
  for (const std::uint64_t length : {std::uint64_t{1}, std::uint64_t{1} << 40U, ~std::uint64_t{0}}) {
    ByteWriter out;
    out << length;
    ByteReader text(out.bytes());
    std::string string;
    EXPECT_THROW(text >> string, Error) << length;
    ByteReader numbers(out.bytes());
    std::vector<double> values;
    EXPECT_THROW(numbers >> values, Error) << length;
  }
}

TEST(Bytes, AreLittleEndian) {
  ByteWriter out;
  out << std::uint32_t{0x01020304} << "a";
  const auto bytes = out.take();
  ASSERT_EQ(bytes.size(), 4U + 8U + 1U) << "a text has its length before it, in eight bytes";
  EXPECT_EQ(bytes[0], std::byte{4});
  EXPECT_EQ(bytes[3], std::byte{1});
  EXPECT_EQ(bytes[4], std::byte{1});
  EXPECT_EQ(bytes[12], std::byte{'a'});
}

}  // namespace
}  // namespace prodomos::base
