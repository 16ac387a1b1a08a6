// Live reload as the game does it: a hundred edits of the walker's files while it runs, a third of them broken. The
// last good version keeps running, the errors name the place, and the end state is that of a fresh start.

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <gmock/gmock.h>

#include "game/simulation.hpp"
#include "modules/muscle/content/content_reloader.hpp"
#include "modules/muscle/muscle.hpp"
#include "tests/support/copy_folder.hpp"

namespace fascicle::game {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void write(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return text;
}

class LiveReload : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("fascicle_live_reload_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "characters");
    const fs::path content = fs::path(FASCICLE_SOURCE_DIR) / "content";
    fs::copy(content / "scenes", folder_ / "scenes", fs::copy_options::recursive);
    fs::copy(content / "schema", folder_ / "schema", fs::copy_options::recursive);
    test::copy_character_folder(content / "characters" / "walker", folder_ / "characters" / "walker");
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_F(LiveReload, AHundredEditsAThirdOfThemBroken) {
  const fs::path scene_file = folder_ / "scenes" / "walker.scene.json";
  const fs::path character_file = folder_ / "characters" / "walker" / "walker.character.json";
  const std::string good = read(character_file);
  auto scene = muscle::load_scene(scene_file);
  ASSERT_TRUE(scene.ok()) << to_text(scene.diagnostics());

  Simulation simulation(*scene, {.workers = 2, .skin_meshes = false});
  muscle::ContentReloader reloader(scene_file, *scene);
  std::mt19937 random(7);
  int good_edits = 0, broken_edits = 0, swaps = 0, refusals = 0;
  for (int edit = 0; edit < 100; ++edit) {
    const bool broken = edit % 3 == 1;
    if (broken) {
      switch (random() % 4) {
        case 0: write(character_file, good.substr(0, good.size() / 2)); break;
        case 1: write(character_file, replaced(good, "\"origin\"", "\"orgin\"")); break;
        case 2: write(character_file, replaced(good, "\"section_vertices\": 16", "\"section_vertices\": 7")); break;
        case 3: write(character_file, replaced(good, "\"bone\": \"femur_r\"", "\"bone\": \"fermur_r\"")); break;
      }
      ++broken_edits;
    } else {
      write(character_file, replaced(good, "\"section_vertices\": 16",
                                     "\"section_vertices\": " + std::to_string(6 + 2 * (random() % 6))));
      ++good_edits;
    }
    for (int i = 0; i < 2; ++i) simulation.step();
    const std::uint64_t running = simulation.hash();
    const auto outcome = reloader.wait();
    if (!outcome) continue;  // the edit happened to change nothing
    if (outcome->scene) {
      EXPECT_FALSE(broken);
      simulation.swap_scene(outcome->scene);
      ++swaps;
    } else {
      EXPECT_TRUE(broken) << to_text(outcome->diagnostics);
      ASSERT_FALSE(outcome->diagnostics.errors.empty());
      for (const Diagnostic& error : outcome->diagnostics.errors) {
        EXPECT_THAT(error.file, testing::EndsWith("walker.character.json"));
        EXPECT_GT(error.line, 0);
        EXPECT_FALSE(error.remedy.empty()) << to_string(error);
      }
      EXPECT_EQ(simulation.hash(), running) << "the last good version is untouched";
      ++refusals;
    }
  }
  EXPECT_EQ(refusals, broken_edits);
  EXPECT_GT(swaps, good_edits / 2);

  // What is pressed at a moment depends on the steps before; everything else must be as if just loaded.
  write(folder_ / "characters" / "walker" / "walker.collision.json",
        "{ \"version\": 1, \"settings\": { \"enabled\": false } }");
  const auto uncollided = reloader.wait();
  ASSERT_TRUE(uncollided && uncollided->scene);
  simulation.swap_scene(uncollided->scene);
  write(character_file, good);
  const auto last = reloader.wait();
  if (last) {
    ASSERT_TRUE(last->scene) << to_text(last->diagnostics);
    simulation.swap_scene(last->scene);
  }
  for (int i = 0; i < 10; ++i) simulation.step();

  const auto fresh_scene = muscle::load_scene(scene_file);
  ASSERT_TRUE(fresh_scene.ok());
  Simulation fresh(*fresh_scene, {.workers = 2, .skin_meshes = false});
  while (fresh.steps() < simulation.steps()) fresh.step();
  EXPECT_EQ(fresh.hash(), simulation.hash());
}

}  // namespace
}  // namespace fascicle::game
