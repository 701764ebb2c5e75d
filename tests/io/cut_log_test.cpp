// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/random.hpp"
#include "prodomos/io/open_source.hpp"

#include "log.hpp"
#include "support/datasets.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::io {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

/// Reads it with nothing on stdout and stderr.
Log readQuietly(const std::filesystem::path& path) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  auto log = readAll(*openSource(path));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  return log;
}

void expectBeginningOf(const Log& whole, const Log& part) {
  ASSERT_LE(part.readings.size(), whole.readings.size());
  for (std::size_t i = 0; i < part.readings.size(); ++i) {
    EXPECT_EQ(part.readings[i].time, whole.readings[i].time);
    EXPECT_EQ(part.readings[i].data.index(), whole.readings[i].data.index());
  }
}

class CutRawlog : public testing::TestWithParam<const char*> {};

TEST_P(CutRawlog, HandsOnWhatIsCompleteAndTellsTheCut) {
  const auto path = test::dataset(GetParam());
  if (!path) GTEST_SKIP() << "needs " << GetParam();
  const auto bytes = test::readFile(*path);
  const auto whole = readAll(*openSource(*path));
  base::Random random(7);
  const test::TemporaryFolder folder;
  std::size_t mostReadings = 0;
  for (int i = 0; i < 10; ++i) {
    const auto size = static_cast<std::size_t>(random.uniform(2000.0, static_cast<double>(bytes.size() - 1)));
    const auto cut = folder.write("cut.rawlog", std::string_view(bytes).substr(0, size));
    const auto part = readQuietly(cut);
    expectBeginningOf(whole, part);
    mostReadings = std::max(mostReadings, part.readings.size());
    EXPECT_THAT(part.end.fault, HasSubstr("cut.rawlog: object "));
    EXPECT_THAT(part.end.fault, HasSubstr(" at (decompressed) byte "));
    EXPECT_THAT(part.end.fault, HasSubstr("expected "));
    EXPECT_EQ(part.end.fault.find('\n'), std::string::npos);
    // As many as the share of the file that is left, give or take how well its parts compress.
    const double share = static_cast<double>(size) / static_cast<double>(bytes.size());
    EXPECT_NEAR(static_cast<double>(part.items()) / static_cast<double>(whole.items()), share, 0.15);
  }
  EXPECT_GT(mostReadings, whole.readings.size() / 2);
}

INSTANTIATE_TEST_SUITE_P(Logs, CutRawlog, testing::Values("laser/fr079.rawlog", "laser/driving_in_office.rawlog"));

TEST(CutRawlog, IsToldFromAWholeOneWhereOnlyTheLastByteIsMissing) {
  const auto path = test::dataset("laser/sena_loop.rawlog");
  if (!path) GTEST_SKIP() << "needs laser/sena_loop.rawlog";
  const test::TemporaryFolder folder;
  const auto bytes = test::readFile(*path);
  const auto log = readQuietly(folder.write("cut.rawlog", std::string_view(bytes).substr(0, bytes.size() - 1)));
  EXPECT_EQ(log.items(), readAll(*openSource(*path)).items());
  EXPECT_THAT(log.end.fault, HasSubstr("another object or the end of the log, found the end of a cut compressed file"));
}

TEST(CutRawlog, TellsAChecksumThatDoesNotFit) {
  const auto path = test::dataset("laser/sena_loop.rawlog");
  if (!path) GTEST_SKIP() << "needs laser/sena_loop.rawlog";
  const test::TemporaryFolder folder;
  auto bytes = test::readFile(*path);
  constexpr std::size_t kTrailer = 8;  // checksum and size
  auto& byte = bytes[bytes.size() - kTrailer];
  byte = static_cast<char>(byte ^ 1);
  const auto log = readQuietly(folder.write("flipped.rawlog", bytes));
  EXPECT_EQ(log.items(), 449U);
  EXPECT_THAT(log.end.fault, HasSubstr("found damaged compressed bytes"));
}

TEST(StoredRawlog, IsReadLikeACompressedOne) {
  // One observation of odometry as MRPT 2.5 stores it, twice, written through the sink and inflated by hand would need
  // a second writer: a gzip stream of stored blocks is what `level 0` gives, and plain bytes are what is left without
  // it.
  const auto path = test::dataset("laser/sena_loop.rawlog");
  if (!path) GTEST_SKIP() << "needs laser/sena_loop.rawlog";
  const test::TemporaryFolder folder;
  const auto plain = folder.path() / "plain.rawlog";
  const auto command = "gzip -dc < '" + path->string() + "' > '" + plain.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const auto expected = readAll(*openSource(*path));
  const auto log = readAll(*openSource(plain));
  EXPECT_EQ(log.end.fault, "");
  ASSERT_EQ(log.readings.size(), expected.readings.size());
  expectBeginningOf(expected, log);

  const auto bytes = test::readFile(plain);
  const auto cut = readQuietly(folder.write("cut.rawlog", std::string_view(bytes).substr(0, bytes.size() / 2)));
  EXPECT_THAT(cut.end.fault, MatchesRegex(".*cut.rawlog: object [0-9]+ at .decompressed. byte [0-9]+: expected a "
                                          "complete C[A-Za-z]+, found the end of the file after [0-9]+ bytes of it"));
}

}  // namespace
}  // namespace prodomos::io
