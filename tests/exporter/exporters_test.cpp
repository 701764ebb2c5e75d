// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/exporter/exporter.hpp"

#include "exporter/write_file.hpp"
#include "exporter/written.hpp"
#include "support/sample_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace prodomos::exporter {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// What every format must hold, whoever writes it.
class EveryFormat : public testing::TestWithParam<Exporter> {
 protected:
  static const map::MapView& sampleView() {
    static const test::SampleMap sample;
    static const map::MapView view = sample.view();
    return view;
  }
};

std::string nameOf(const testing::TestParamInfo<Exporter>& info) {
  return std::string(info.param.format);
}

INSTANTIATE_TEST_SUITE_P(Exporters, EveryFormat, testing::ValuesIn(exporters().begin(), exporters().end()), nameOf);

TEST_P(EveryFormat, WritesTheSameBytesForTheSameMap) {
  const auto files = test::writeAll(GetParam().format, sampleView());
  EXPECT_THAT(files, Not(IsEmpty()));
  const test::SampleMap again;
  EXPECT_TRUE(files == test::writeAll(GetParam().format, again.view()));
}

TEST_P(EveryFormat, LeavesNoUnfinishedFiles) {
  for (const auto& [name, bytes] : test::writeAll(GetParam().format, sampleView())) {
    EXPECT_THAT(name, Not(HasSubstr(".part")));
    EXPECT_THAT(bytes, Not(IsEmpty())) << name;
  }
}

TEST_P(EveryFormat, TellsNothingOfTheMachineItWasMadeOn) {
  for (const auto& [name, bytes] : test::writeAll(GetParam().format, sampleView())) {
    EXPECT_EQ(bytes.find("/home/somebody"), std::string::npos) << name;
  }
}

TEST_P(EveryFormat, RefusesAFolderThatIsNotThere) {
  try {
    GetParam().write(sampleView(), "/nonexistent/folder/map");
    ADD_FAILURE() << "wrote into a folder that is not there";
  } catch (const base::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nonexistent/folder/map"));
  }
}

TEST_P(EveryFormat, OverwritesWhatWasThere) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / ("map" + std::string(GetParam().extension));
  GetParam().write(sampleView(), path);
  EXPECT_NO_THROW(GetParam().write(sampleView(), path));
}

TEST_P(EveryFormat, WritesOrRefusesAnEmptyMapButNeverCrashes) {
  const auto view = map::MapStore::inMemory().view();
  const test::TemporaryFolder folder;
  try {
    GetParam().write(view, folder.path() / "map");
    EXPECT_FALSE(std::filesystem::is_empty(folder.path()));
  } catch (const base::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("found none"));
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
}

TEST(Exporters, AreFoundByName) {
  ASSERT_NE(findExporter("graphml"), nullptr);
  EXPECT_EQ(findExporter("graphml")->extension, ".graphml");
  EXPECT_EQ(findExporter("GraphML"), nullptr);
  EXPECT_EQ(findExporter(""), nullptr);
}

TEST(Exporters, HaveNamesOfTheirOwn) {
  std::set<std::string_view> formats;
  for (const auto& exporter : exporters()) {
    EXPECT_TRUE(formats.insert(exporter.format).second) << exporter.format;
    EXPECT_FALSE(exporter.text.empty());
  }
}

TEST(WriteFile, KeepsTheOldFileWhereTheNewOneCannotBeWritten) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "file";
  writeFile(path, "old");
  std::filesystem::create_directory(folder.path() / "file.part");  // where the new one would be written first
  EXPECT_THROW(writeFile(path, "new"), base::FileError);
  EXPECT_EQ(test::readFile(path), "old");
}

TEST(WriteFile, SaysThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", folder.path() / "file.part");
  try {
    writeFile(folder.path() / "file", std::string(100'000, 'x'));
    ADD_FAILURE() << "wrote to a full disk";
  } catch (const base::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("No space left"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "file"));
}

TEST(WriteFile, RefusesAFolder) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(writeFile(folder.path(), "bytes"), base::FileError);
}

}  // namespace
}  // namespace prodomos::exporter
