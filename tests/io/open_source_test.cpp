// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/io/open_source.hpp"

#include "log.hpp"
#include "support/datasets.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string errorFor(const std::filesystem::path& path) {
  auto message = errorOf([&] { openSource(path); });
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  return message;
}

TEST(OpenSource, SaysWhatItLookedFor) {
  const test::TemporaryFolder folder;
  const auto lookedFor = AllOf(HasSubstr("MRPT rawlog"), HasSubstr("CARMEN log"), HasSubstr("folder of images"));
  EXPECT_THAT(errorFor(folder.path() / "no.rawlog"),
              AllOf(lookedFor, HasSubstr("no.rawlog"), HasSubstr("no such file")));
  EXPECT_THAT(errorFor(folder.write("empty.rawlog", "")), AllOf(lookedFor, HasSubstr("found an empty file")));
  EXPECT_THAT(errorFor(folder.write("text.log", "hello\n")), AllOf(lookedFor, HasSubstr("found other content")));
  EXPECT_THAT(errorFor(folder.path()), AllOf(HasSubstr("a TUM folder"), HasSubstr("rgb/, depth/, camera.txt")));
}

TEST(OpenSource, RefusesAJpegThatIsNamedLikeARawlog) {
  const auto image = test::dataset("rgbd/stairs_kinect2/0000_color.jpg");
  if (!image) GTEST_SKIP() << "needs rgbd/stairs_kinect2";
  const test::TemporaryFolder folder;
  EXPECT_THAT(errorFor(folder.write("image.rawlog", test::readFile(*image))),
              AllOf(HasSubstr("image.rawlog: expected an MRPT rawlog"), HasSubstr("found other content")));
}

TEST(OpenSource, RefusesGzipThatHoldsNothingOrIsCutAtOnce) {
  const test::TemporaryFolder folder;
  const std::string header("\x1f\x8b\x08\0\0\0\0\0\0\x03", 10);
  EXPECT_THAT(errorFor(folder.write("cut.rawlog", header)), HasSubstr("found the end of a cut compressed file"));
  EXPECT_THAT(errorFor(folder.write("bad.rawlog", header + "\xff\xff\xff\xff")), HasSubstr("damaged compressed bytes"));
}

TEST(OpenSource, RefusesAnMrptFileThatIsNoLog) {
  const test::TemporaryFolder folder;
  const std::string map = std::string("\x8a", 1) + "CSimpleMap" + std::string(100, '\0');
  EXPECT_THAT(errorFor(folder.write("map.rawlog", map)), HasSubstr("found other content"));
}

TEST(OpenSource, GoesByContentNotByName) {
  const test::TemporaryFolder folder;
  const auto walk = folder.write("walk.rawlog", "ODOM 1 2 0 0 0 0 1.0 host 1\n");
  EXPECT_EQ(openSource(walk)->info().kind, "CARMEN log");
  const auto rawlog = test::dataset("laser/sena_loop.rawlog");
  if (!rawlog) GTEST_SKIP() << "needs laser/sena_loop.rawlog";
  const auto renamed = folder.write("walk.log", test::readFile(*rawlog));
  EXPECT_EQ(openSource(renamed)->info().kind, "MRPT rawlog");
}

TEST(OpenSource, ReadsCompressedCarmenLogs) {
  const test::TemporaryFolder folder;
  const auto plain = folder.write("walk.log", "ODOM 1 2 0 0 0 0 1.0 host 1\nODOM 1 2 0 0 0 0 2.0 host 1\n");
  for (const std::string tool : {"gzip", "bzip2"}) {
    const auto packed = folder.path() / ("walk." + tool);
    const auto command = tool + " -c '" + plain.string() + "' > '" + packed.string() + "'";
    if (std::system(command.c_str()) != 0) GTEST_SKIP() << "needs " << tool;
    const auto log = readAll(*openSource(packed));
    EXPECT_EQ(log.readings.size(), 2U);
    EXPECT_EQ(log.end.fault, "");

    const auto bytes = test::readFile(packed);
    const auto cut = folder.write("cut", std::string_view(bytes).substr(0, bytes.size() - 4));
    EXPECT_NE(readAll(*openSource(cut)).end.fault, "");
  }
}

}  // namespace
}  // namespace prodomos::io
