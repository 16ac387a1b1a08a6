// `fascicle-cook fit` as a program: exit statuses, messages and files.

#include <array>
#include <filesystem>
#include <sstream>

#include <gmock/gmock.h>

#include "modules/muscle/content/fit_store.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_data.hpp"
#include "tests/tools/fascicle_cook/cook_command.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class FitCommand : public CookCommand {
 protected:
  // A spindle of 50 cm by 10 cm along the z axis, and a character with one muscle in it.
  void write_character() const {
    TriangleMesh spindle = test::make_sphere(0.05f, 24, 36);
    for (glm::vec3& position : spindle.positions) position.z *= 5.0f;
    write_obj("spindle.obj", spindle);
    write("arm.character.json", R"({ "version": 1, "name": "arm",
      "skeleton": { "joints": { "bodies": [{ "name": "upper" }], "coordinates": [],
                                "joints": [{ "name": "root", "parent": "ground", "child": "upper" }] } },
      "attachment_space": "character", "level": { "section_vertices": 12, "longitudinal_subdivision": 2 },
      "muscles": [{ "name": "biceps", "mesh": { "file": "spindle.obj" }, "volume": 0.001,
                    "origin": { "bone": "upper", "position": [0, 0, -0.24] },
                    "insertion": { "bone": "upper", "position": [0, 0, 0.24] } }] })");
  }
};

TEST_F(FitCommand, WrongUsageIsTwo) {
  EXPECT_EQ(run("fit"), 2);
  EXPECT_EQ(run("fit walker --section-vertices 7"), 2);
  EXPECT_THAT(err(), HasSubstr("an even number from 6 to 256 is wanted"));
  EXPECT_EQ(run("fit walker --section-vertices six"), 2);
  EXPECT_EQ(run("fit walker --subdivision 9"), 2);
  EXPECT_EQ(run("fit walker --unit furlong"), 2);
}

TEST_F(FitCommand, WhatCannotBeFittedIsToldAndOne) {
  EXPECT_EQ(run("fit wlaker"), 1);
  EXPECT_THAT(err(), HasSubstr("did you mean 'walker'?"));
  EXPECT_EQ(run("fit '" + file("none.stl") + "'"), 1);
  EXPECT_THAT(err(), HasSubstr("none.stl"));
  write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(run("fit '" + file("flat.obj") + "'"), 1);
  EXPECT_THAT(err(), HasSubstr("closed"));
  write_obj("huge.obj", test::make_sphere(1.0e8f, 12, 12));
  EXPECT_EQ(run("fit '" + file("huge.obj") + "'"), 1);
  EXPECT_THAT(err(), HasSubstr("--unit"));
  write_character();
  EXPECT_EQ(run("fit '" + file("arm.character.json") + "' --muscle bizeps"), 1);
  EXPECT_THAT(err(), HasSubstr("did you mean 'biceps'?"));
  EXPECT_EQ(run("fit '" + file("arm.character.json") + "' --dry-run --report /dev/null/x"), 1);
}

TEST_F(FitCommand, StoresTheFitBesideTheCharacter) {
  write_character();
  const std::string character = "'" + file("arm.character.json") + "'";
  ASSERT_EQ(run("fit " + character + " --dry-run"), 0) << err();
  EXPECT_FALSE(exists("arm.fit.json"));
  ASSERT_EQ(run("fit " + character + " --section-vertices 36"), 0) << err();
  EXPECT_FALSE(exists("arm.fit.json"));  // not what the content asks for
  ASSERT_EQ(run("fit " + character + " --sections --report '" + file("report.json") + "'"), 0) << err();
  EXPECT_THAT(out(), HasSubstr("all (1 of 1 fitted)"));
  EXPECT_THAT(out(), HasSubstr("section   hits  misses"));
  EXPECT_THAT(read("report.json"), HasSubstr("\"fit_to_mesh\": { \"rms\": "));
  const auto store = muscle::read_fit_store(file("arm.fit.json"));
  ASSERT_TRUE(store.ok()) << to_text(store.diagnostics());
  EXPECT_EQ(store->at("biceps").levels.size(), 2u);  // 12 and 6 vertices a section
}

TEST_F(FitCommand, AMeshByItselfHasALine) {
  write_character();
  ASSERT_EQ(run("fit '" + file("spindle.obj") + "' --section-vertices 12 --subdivision 2"), 0) << err();
  EXPECT_THAT(out(), HasSubstr("spindle                    12    2"));
  EXPECT_FALSE(exists("spindle.fit.json"));
}

TEST_F(FitCommand, ComparesLevels) {
  write_character();
  ASSERT_EQ(run("fit '" + file("arm.character.json") + "' --levels --levels-csv '" + file("levels.csv") + "'"), 0) << err();
  EXPECT_THAT(out(), HasSubstr("LSS  |C|  vertices   fewer"));
  const std::string csv = read("levels.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 7 * 4);
  EXPECT_THAT(csv, HasSubstr("\nbiceps,3,36,326,"));
}

// The article's table 4, on the default content: it falls along rows and columns, and is zero from 36 rays on.
TEST_F(FitCommand, TheTableOfCentresOutsideFallsToZero) {
  ASSERT_EQ(run("fit walker --table"), 0) << err();
  std::istringstream lines(out());
  std::array<std::array<int, 8>, 6> table{};
  for (int row = 0; row < 6; ++row) {
    std::string css, bar;
    int number = 0;
    lines >> css >> number;
    EXPECT_EQ(css, "CSS");
    EXPECT_EQ(number, row + 1);
    lines.ignore(1, ':');
    auto& counts = table[static_cast<std::size_t>(row)];
    for (std::size_t i = 0; i < 4; ++i) lines >> counts[i];
    lines >> bar;
    EXPECT_EQ(bar, "|");
    for (std::size_t i = 4; i < 8; ++i) lines >> counts[i];
  }
  ASSERT_TRUE(lines);
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t i = 0; i < 8; ++i) {
      const int rays = (static_cast<int>(row) + 1) * (6 + 2 * static_cast<int>(i % 4));
      const auto place = [&] { return "CSS " + std::to_string(row + 1) + ", column " + std::to_string(i); };
      if (rays >= 36) {
        EXPECT_EQ(table[row][i], 0) << place();
      }
      if (row > 0) {
        EXPECT_LE(table[row][i], table[row - 1][i]) << place();
      }
      if (i % 4 > 0) {
        EXPECT_LE(table[row][i], table[row][i - 1]) << place();
      }
    }
  }
  // As hard as the article's muscles (23 19 7 8 | 42 24 12 17).
  EXPECT_GE(table[0][0], 15);
  EXPECT_LE(table[0][0], 35);
  EXPECT_GE(table[0][4], 30);
  EXPECT_LE(table[0][4], 60);
}

}  // namespace
}  // namespace fascicle::cook
