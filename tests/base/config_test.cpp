// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/config.hpp"

#include "prodomos/base/error.hpp"

#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace prodomos::base {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Dish {
  double salt = 0.1;
  double anything = -1e-300;
  int eggs = 3;
  bool vegan = false;
  std::uint64_t seed = 18'446'744'073'709'551'615U;
  std::string name = "omelette";
  int size = 1;
  struct {
    int hours = 2;
  } oven;

  bool operator==(const Dish& other) const {
    return salt == other.salt && anything == other.anything && eggs == other.eggs && vegan == other.vegan &&
           seed == other.seed && name == other.name && size == other.size && oven.hours == other.oven.hours;
  }
};

constexpr std::array<std::string_view, 3> kSizes = {"small", "medium", "large"};

void describe(ConfigVisitor& visitor, Dish& dish) {
  visitor.section("dish", "what is cooked");
  visitor.key("salt", dish.salt, "g", {0.0, 5.0}, "how much salt");
  visitor.key("anything", dish.anything, "", {}, "any number");
  visitor.key("eggs", dish.eggs, "", {1.0, 12.0}, "how many eggs");
  visitor.key("vegan", dish.vegan, "without the eggs");
  visitor.key("seed", dish.seed, "of randomness");
  visitor.key("name", dish.name, "what it is called");
  visitor.choice("size", dish.size, kSizes, "of the plate");
  visitor.section("oven", "where it is cooked");
  visitor.key("hours", dish.oven.hours, "h", {0.0, 24.0}, "how long");
  visitor.endSection();
  visitor.endSection();
}

Dish fromText(const std::string& text, std::vector<std::string> assignments = {}) {
  return readConfig<Dish>({.file = {}, .text = text, .assignments = std::move(assignments)});
}

std::vector<std::string> faultsOf(const ConfigInput& input) {
  try {
    readConfig<Dish>(input);
  } catch (const UsageError& error) {
    return error.faults();
  }
  return {};
}

std::vector<std::string> faultsOfText(const std::string& text) {
  return faultsOf({.file = {}, .text = text, .assignments = {}});
}

std::vector<std::string> faultsOfFile(const std::filesystem::path& file) {
  return faultsOf({.file = file, .text = {}, .assignments = {}});
}

TEST(Config, HasItsDefaultsWhereNothingIsGiven) {
  EXPECT_EQ(fromText(""), Dish());
  EXPECT_EQ(fromText("# a comment alone\n"), Dish());
}

TEST(Config, IsReadBackAsItIsWritten) {
  Dish dish;
  dish.salt = 1.0 / 3.0;
  dish.anything = 6.02214076e23;
  dish.eggs = 12;
  dish.vegan = true;
  dish.seed = 0;
  dish.size = 2;
  dish.oven.hours = 24;
  for (const bool explained : {false, true}) {
    EXPECT_EQ(fromText(writeConfig(Dish(), explained)), Dish());
    EXPECT_EQ(fromText(writeConfig(dish, explained)), dish) << writeConfig(dish, explained);
  }
}

TEST(Config, KeepsTextsOfAnyCharacters) {
  for (const char* name :
       {"",           " ",    "true",        "5",          "null",    "~",        "a: b",    "# no comment",
        "\"quoted\"", "it's", "back\\slash", "two\nlines", "tab\t",   "{a: [1]}", "&anchor", "*alias",
        "!tag",       "%",    "@",           "- list",     "öçß 日本"}) {
    Dish dish;
    dish.name = name;
    for (const bool explained : {false, true}) EXPECT_EQ(fromText(writeConfig(dish, explained)).name, name);
  }
}

TEST(Config, IsExplainedWithUnitsAndBounds) {
  const auto text = writeConfig(Dish(), true);
  EXPECT_THAT(text, HasSubstr("# what is cooked\ndish:\n"));
  EXPECT_THAT(text, HasSubstr("  # how much salt [g, 0 to 5]\n  salt: 0.1\n"));
  EXPECT_THAT(text, HasSubstr("  # of the plate [small | medium | large]\n  size: medium\n"));
  EXPECT_THAT(text, HasSubstr("    # how long [h, 0 to 24]\n    hours: 2\n"));
  EXPECT_THAT(writeConfig(Dish(), false), testing::Not(HasSubstr("#")));
}

TEST(Config, ReportsAllMistakesOfAFileInItsOrder) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("dish.yaml",
                                 "dish:\n"
                                 "  seed: 7\n"
                                 "  pepper: 1\n"
                                 "  eggs: many\n"
                                 "  oven:\n"
                                 "    hours: 25\n"
                                 "  salt: 0.2\n");
  const auto at = file.string() + ":";
  EXPECT_THAT(faultsOfFile(file),
              ElementsAre(at + "3: unknown key 'dish.pepper' (prodomos config prints the known ones)",
                          at + "4: key 'dish.eggs': expected a whole number (1 to 12), found 'many'",
                          at + "6: key 'dish.oven.hours': expected a whole number (0 to 24 h), found '25'"));
}

TEST(Config, RefusesUnknownSections) {
  EXPECT_THAT(faultsOfText("meal:\n  salt: 1\n"), ElementsAre(HasSubstr("configuration:2: unknown key 'meal.salt'")));
  EXPECT_THAT(faultsOfText("salt: 1\n"), ElementsAre(HasSubstr("configuration:1: unknown key 'salt'")));
}

TEST(Config, RefusesValuesOfAnotherType) {
  for (const char* line :
       {"salt: much", "salt: 1 g", "salt: nan", "salt: ''", "eggs: 2.5", "eggs: 99999999999", "vegan: yes", "vegan: 1",
        "seed: -1", "seed: 18446744073709551616", "size: huge", "size: 1", "size: Medium"}) {
    EXPECT_THAT(faultsOfText("dish:\n  " + std::string(line) + "\n"),
                ElementsAre(HasSubstr("configuration:2: key 'dish.")))
        << line;
  }
}

TEST(Config, RefusesValuesOutOfBoundsAndTakesTheBounds) {
  for (const char* line : {"salt: -0.001", "salt: 5.001", "salt: inf", "eggs: 0", "eggs: 13"}) {
    EXPECT_THAT(faultsOfText("dish:\n  " + std::string(line)), ElementsAre(HasSubstr("expected a"))) << line;
  }
  for (const char* line : {"salt: 0", "salt: 5", "eggs: 1", "eggs: 12", "anything: 1e308"}) {
    EXPECT_THAT(faultsOfText("dish:\n  " + std::string(line)), ElementsAre()) << line;
  }
}

TEST(Config, RefusesAListOrNothingWhereAValueBelongs) {
  EXPECT_THAT(faultsOfText("dish:\n  salt: [1, 2]\n"),
              ElementsAre(HasSubstr("configuration:2: key 'dish.salt': expected a value")));
  EXPECT_THAT(faultsOfText("dish:\n  salt:\n"),
              ElementsAre(HasSubstr("configuration:2: key 'dish.salt': expected a value")));
  EXPECT_THAT(faultsOfText("- dish\n"), ElementsAre(HasSubstr("configuration:1: expected sections with keys")));
}

TEST(Config, TakesAChoiceByItsName) {
  EXPECT_EQ(fromText("dish: {size: large}").size, 2);
  EXPECT_THAT(faultsOfText("dish: {size: huge}"),
              ElementsAre(HasSubstr("expected one of small, medium, large, found 'huge'")));
}

TEST(Config, LetsAssignmentsWinOverTheFile) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("dish.yaml", "dish:\n  eggs: 4\n  salt: 9\n");
  const auto dish =
      readConfig<Dish>({.file = file,
                        .text = {},
                        .assignments = {"dish.salt=2", "dish.oven.hours=3", "dish.name=a=b: c", "dish.salt=1"}});
  EXPECT_EQ(dish.eggs, 4);
  EXPECT_EQ(dish.salt, 1.0);
  EXPECT_EQ(dish.oven.hours, 3);
  EXPECT_EQ(dish.name, "a=b: c");
}

TEST(Config, ReportsAssignmentsThatAreNone) {
  EXPECT_THAT(
      faultsOf({.file = {}, .text = {}, .assignments = {"dish.eggs", "=5", "dish.eggs=", "dish.pepper=1", "eggs=1"}}),
      ElementsAre(
          "--set: expected section.key=value, found 'dish.eggs'", "--set: expected section.key=value, found '=5'",
          "--set dish.eggs: key 'dish.eggs': expected a whole number (1 to 12), found ''",
          HasSubstr("--set dish.pepper: unknown key 'dish.pepper'"), HasSubstr("--set eggs: unknown key 'eggs'")));
}

TEST(Config, ReportsAKeyThatIsGivenTwice) {
  EXPECT_THAT(faultsOfText("dish:\n  eggs: 1\n  salt: 1\n  eggs: 2\n"),
              ElementsAre("configuration:4: key 'dish.eggs' is given twice"));
  EXPECT_THAT(faultsOfText("dish:\n  eggs: 1\ndish:\n  eggs: 2\n"),
              ElementsAre("configuration:4: key 'dish.eggs' is given twice"));
}

TEST(Config, ReportsTheLineOfASyntaxError) {
  EXPECT_THAT(faultsOfText("dish:\n  eggs: [1\n  salt: }\n"), ElementsAre(HasSubstr("configuration:3: ")));
  EXPECT_THAT(faultsOfText("dish:\n  name: one: two\n"), ElementsAre(HasSubstr("configuration:2: ")));
}

TEST(Config, ReportsAFileThatCannotBeRead) {
  const test::TemporaryFolder folder;
  const auto missing = folder.path() / "none.yaml";
  EXPECT_THAT(faultsOfFile(missing),
              ElementsAre(missing.string() + ": expected a YAML configuration file, found none that can be read"));
  EXPECT_THAT(faultsOfFile(folder.path()), ElementsAre(HasSubstr("found none that can be read")));
}

TEST(Config, TakesAnEmptyFileForNoSettings) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(readConfig<Dish>({.file = folder.write("dish.yaml", ""), .text = {}, .assignments = {}}), Dish());
}

}  // namespace
}  // namespace prodomos::base
