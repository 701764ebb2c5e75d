// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/png_file.hpp"

#include "prodomos/base/error.hpp"

#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

namespace prodomos::simulation {
namespace {

using sensors::Rgb;
using ::testing::HasSubstr;

/// 2 x 2 pixels: red and blue above, two dark ones below.
std::string tinyPng() {
  constexpr std::array<unsigned char, 77> kBytes{
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
      0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02, 0x00, 0x00, 0x00, 0xfd, 0xd4, 0x9a,
      0x73, 0x00, 0x00, 0x00, 0x14, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8, 0xcf, 0x00, 0x04,
      0xff, 0x19, 0x18, 0x99, 0x98, 0x59, 0x58, 0xd9, 0x00, 0x15, 0x31, 0x02, 0x14, 0xb9, 0x63, 0xbe,
      0xce, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82,
  };
  return {kBytes.begin(), kBytes.end()};
}

std::string faultOf(const std::filesystem::path& path) {
  try {
    readPng(path);
  } catch (const base::FileError& error) {
    return error.what();
  }
  return "none";
}

TEST(PngFile, RowsBeginOnTop) {
  const test::TemporaryFolder folder;
  const auto image = readPng(folder.write("tiny.png", tinyPng()));
  ASSERT_EQ(image.width(), 2);
  ASSERT_EQ(image.height(), 2);
  EXPECT_EQ(image(0, 0), (Rgb{255, 0, 0}));
  EXPECT_EQ(image(1, 0), (Rgb{0, 0, 255}));
  EXPECT_EQ(image(0, 1), (Rgb{1, 2, 3}));
  EXPECT_EQ(image(1, 1), (Rgb{4, 5, 6}));
}

TEST(PngFile, FaultsNameTheFile) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(faultOf(folder.path() / "gone.png"), HasSubstr("gone.png: expected a PNG image, found"));
  EXPECT_THAT(faultOf(folder.write("text.png", "no picture")), HasSubstr("text.png: expected a PNG image, found"));
  EXPECT_THAT(faultOf(folder.write("cut.png", tinyPng().substr(0, 45))), HasSubstr("cut.png: expected a PNG image"));
}

}  // namespace
}  // namespace prodomos::simulation
