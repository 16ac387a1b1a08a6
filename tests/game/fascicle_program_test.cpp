// The game as a program: exit statuses, and the files that it writes.

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <json/json.h>

#include "game/game_options.hpp"

namespace fascicle::game {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// The leak sanitizer's own tracer crashes now and then over the rasteriser's threads that end with the program. Leaks are
// looked for in game_test and render_test, which do the same in their own process.
#if defined(__SANITIZE_ADDRESS__)
const std::string kSanitizerOptions = "ASAN_OPTIONS=detect_leaks=0 ";
#else
const std::string kSanitizerOptions;
#endif

class FascicleProgram : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("fascicle_program_" + std::to_string(::getpid()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Runs the game with `arguments`; `environment` stands before the command.
  int run(const std::string& arguments, const std::string& environment = "") {
    const std::string command = kSanitizerOptions + environment + " '" FASCICLE_PROGRAM "' " + arguments + " >'" + file("out") + "' 2>'" +
                                file("err") + "' </dev/null";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string out() const { return read(folder_ / "out"); }
  std::string err() const { return read(folder_ / "err"); }

  fs::path folder_;
};

TEST_F(FascicleProgram, AnUnknownSceneIsAnErrorThatNamesTheFile) {
  EXPECT_EQ(run("--headless --no-draw --scene nowhere"), kExitBadContent);
  EXPECT_THAT(err(), HasSubstr("nowhere.scene.json"));
}

TEST_F(FascicleProgram, ABrokenSceneIsExplainedWithItsPlace) {
  std::ofstream(file("broken.scene.json")) << "{ \"version\": 1,\n  \"name\": \"broken\",\n  \"charcters\": [] }\n";
  EXPECT_EQ(run("--headless --no-draw --scene '" + file("broken.scene.json") + "'"), kExitBadContent);
  EXPECT_THAT(err(), HasSubstr("broken.scene.json:3:"));
  EXPECT_THAT(err(), HasSubstr("characters"));
}

TEST_F(FascicleProgram, MissingDataHasAStatusOfItsOwn) {
  for (const char* scene : {"gait2392", "cesium-man", "box", "hip-gluteus", "hip-iliacus", "hip-hull"}) {
    EXPECT_EQ(run(std::string("--headless --no-draw --scene ") + scene, "FASCICLE_DATA='" + file("absent") + "'"),
              kExitNoData);
    EXPECT_THAT(err(), HasSubstr("FASCICLE_DATA"));
  }
}

TEST_F(FascicleProgram, WrongArgumentsAreAUsageError) {
  EXPECT_EQ(run("--headless --frames none"), kExitUsage);
  EXPECT_THAT(err(), HasSubstr("--frames"));
}

TEST_F(FascicleProgram, FilesThatCannotBeWrittenAreReported) {
  std::ofstream(file("taken")) << "a file, not a folder";
  EXPECT_EQ(run("--headless --no-draw --frames 3 --report '" + file("taken/r.json") + "'"), kExitNoOutput);
  EXPECT_THAT(err(), HasSubstr("taken/r.json"));
}

TEST_F(FascicleProgram, AFullOutputIsNoticed) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const std::string command = kSanitizerOptions + "'" FASCICLE_PROGRAM "' --headless --no-draw --frames 3 --hash " +
                              ">/dev/full 2>'" + file("err") + "'";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), kExitNoOutput);
  EXPECT_THAT(err(), HasSubstr("cannot be written"));
}

TEST_F(FascicleProgram, APictureOfAFrameThatNeverComesIsAnError) {
  const int status = run("--headless --frames 2 --width 64 --height 64 --screenshot '" + file("p.png@1") + "'");
  if (status == kExitNoOutput && err().find("EGL") != std::string::npos) GTEST_SKIP() << err();
  std::ofstream(file("short.scene.json"))
      << "{ \"version\": 1, \"name\": \"short\", \"frames\": 2, \"characters\": [ { \"file\": \"" FASCICLE_SOURCE_DIR
         "/content/characters/walker/walker.character.json\" } ] }";
  EXPECT_EQ(run("--headless --width 64 --height 64 --scene '" + file("short.scene.json") + "' --screenshot '" +
                file("late.png@5") + "'"),
            kExitNoOutput)
      << err();
  EXPECT_THAT(err(), HasSubstr("late.png"));
}

TEST_F(FascicleProgram, WritesStatisticsTraceReportAndHash) {
  ASSERT_EQ(run("--headless --no-draw --frames 25 --threads 2 --characters 2 --hash --stats '" + file("s.csv") +
                "' --trace '" + file("t.json") + "' --report '" + file("r.json") + "'"),
            kExitOk)
      << err();
  EXPECT_THAT(out(), HasSubstr("write_surfaces"));
  const std::string hash = out().substr(out().rfind("hash ") + 5, 16);
  EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos) << out();

  EXPECT_THAT(read(folder_ / "s.csv"), HasSubstr("write_surfaces"));

  Json::Value trace, report;
  Json::Reader reader;
  ASSERT_TRUE(reader.parse(read(folder_ / "t.json"), trace));
  std::size_t complete = 0, names = 0, marks = 0, counters = 0;
  for (const Json::Value& event : trace["traceEvents"]) {
    const std::string phase = event["ph"].asString();
    complete += phase == "X";
    names += phase == "M";
    marks += phase == "i";
    counters += phase == "C";
  }
  EXPECT_GT(complete, 25u * 5u);
  EXPECT_GE(names, 1u);
  EXPECT_GE(counters, 25u);
  EXPECT_EQ(marks, 25u);

  ASSERT_TRUE(reader.parse(read(folder_ / "r.json"), report));
  EXPECT_EQ(report["scene"].asString(), "walker");
  EXPECT_EQ(report["frames"].asInt(), 25);
  EXPECT_EQ(report["hash"].asString(), hash);
  ASSERT_EQ(report["metrics"]["muscle.length_ratio_max"].size(), 25u);
  EXPECT_GT(report["metrics"]["muscle.length_ratio_max"][24].asDouble(), 1.0);
  EXPECT_EQ(report["metrics"]["held_steps"][24].asDouble(), 0.0);
  EXPECT_EQ(report["metrics"]["muscle.level_mean"].size(), 25u);
  EXPECT_GT(report["metrics"]["muscle.vertices"][24].asDouble(), 0.0);
  // Measured on the drawn surfaces: muscles touch bones, and nothing is missing.
  for (const char* name : {"penetration.bone_max_mm", "penetration.muscle_max_mm", "penetration.bone_pair_max_mm",
                           "penetration.muscle_pair_max_mm", "section_area_error_max", "solve.fallbacks"}) {
    ASSERT_EQ(report["metrics"][name].size(), 25u) << name;
    EXPECT_TRUE(report["metrics"][name][24].isNumeric()) << name;
    EXPECT_GE(report["metrics"][name][24].asDouble(), 0.0) << name;
  }
  EXPECT_GT(report["metrics"]["penetration.bone_deepest_mm"][24].asDouble(), 0.0);
  EXPECT_GT(report["metrics"]["penetration.muscle_deepest_mm"][24].asDouble(), 0.0);
  EXPECT_EQ(report["metrics"]["penetration.left_out"][24].asDouble(), 0.0);
}

TEST_F(FascicleProgram, DetailGivesRowsPerCharacterAndMuscle) {
  ASSERT_EQ(run("--headless --no-draw --frames 25 --characters 2 --detail --stats '" + file("s.csv") + "'"), kExitOk);
  const std::string table = read(folder_ / "s.csv");
  EXPECT_THAT(table, HasSubstr("walker 1"));
  EXPECT_THAT(table, HasSubstr("walker 2"));
  EXPECT_THAT(table, HasSubstr("soleus_r"));
}

TEST_F(FascicleProgram, ThreadsAndInstructionSetsGiveOneHash) {
  std::string first;
  for (const char* arguments : {"--threads 1", "--threads 8", "--simd portable", "--detail"}) {
    ASSERT_EQ(run(std::string("--headless --no-draw --frames 40 --hash ") + arguments), kExitOk);
    const std::string hash = out().substr(out().rfind("hash "));
    if (first.empty()) first = hash;
    EXPECT_EQ(hash, first) << arguments;
  }
}

TEST_F(FascicleProgram, PrintsTheScheduleAsTextAndAsGraph) {
  ASSERT_EQ(run("--schedule"), kExitOk);
  EXPECT_THAT(out(), HasSubstr("build_frames"));
  ASSERT_EQ(run("--schedule-dot"), kExitOk);
  EXPECT_THAT(out(), HasSubstr("digraph"));
}

TEST_F(FascicleProgram, WritesAPictureWithoutADisplay) {
  const int status = run("--headless --frames 2 --width 160 --height 120 --screenshot '" + file("p.png@1") + "'",
                         "env -u DISPLAY -u WAYLAND_DISPLAY");
  if (status == kExitNoOutput && err().find("EGL") != std::string::npos) GTEST_SKIP() << err();
  ASSERT_EQ(status, kExitOk) << err();
  EXPECT_EQ(read(folder_ / "p.png").substr(1, 3), "PNG");
}

}  // namespace
}  // namespace fascicle::game
