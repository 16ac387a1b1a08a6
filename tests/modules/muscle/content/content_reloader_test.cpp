#include "modules/muscle/content/content_reloader.hpp"

#include <chrono>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "tests/modules/muscle/content/scratch_content.hpp"

namespace fascicle::muscle {
namespace {

using test::kBlock;
using test::kLegs;
using test::kScene;
using test::kShapes;
using test::ScratchFolder;
using test::with;
using testing::HasSubstr;

// Everything of a scene that an edit below can change, as text.
std::string describe(const SceneAsset& scene) {
  std::string text = fmt::format("{} {} {} {}\n", scene.name, scene.step_hz, scene.frames, scene.camera.distance);
  for (const SceneCharacter& placed : scene.characters) {
    text += fmt::format("{} {} {} clip {}\n", placed.character->name, placed.position.x, placed.heading,
                        placed.animation.clip != nullptr);
    for (const MuscleDescription& muscle : placed.character->descriptions) {
      text += fmt::format("  {} {} {} {}", muscle.name, muscle.hill.max_isometric_force, muscle.section_vertices,
                          muscle.longitudinal_subdivision);
      for (const auto& point : muscle.attachments) {
        text += fmt::format(" {}:{},{},{}", point.bone, point.position.x, point.position.y, point.position.z);
      }
      text += '\n';
    }
    if (placed.character->muscles) {
      for (const float x : placed.character->muscles->rest_x) text += fmt::format("{} ", x);
      for (const float r : placed.character->muscles->rest_radii) text += fmt::format("{} ", r);
    }
  }
  return text;
}

std::shared_ptr<const SceneAsset> load(const std::filesystem::path& file) {
  auto loaded = load_scene(file);
  EXPECT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
  return loaded.ok() ? *loaded : nullptr;
}

TEST(ContentReloader, SaysNothingWhereNothingChanges) {
  const ScratchFolder folder;
  const auto file = write_pair(folder);
  // A file written as it was being loaded would be loaded again.
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    const auto now = std::filesystem::file_time_type::clock::now();
    std::filesystem::last_write_time(entry.path(), now - std::chrono::hours(1));
  }
  ContentReloader reloader(file, load(file));
  EXPECT_FALSE(reloader.wait());
}

TEST(ContentReloader, SeesAChangeInEveryFileOfTheScene) {
  const ScratchFolder folder;
  const auto file = write_pair(folder);
  ContentReloader reloader(file, load(file));
  for (const auto& [name, text] : {std::pair{"legs.character.json", kLegs}, {"block.character.json", kBlock},
                                   {"shapes.gltf", kShapes}, {"pair.scene.json", kScene}}) {
    folder.write(name, std::string(text) + " ");
    const auto outcome = reloader.wait();
    ASSERT_TRUE(outcome) << name;
    EXPECT_TRUE(outcome->scene) << name << to_text(outcome->diagnostics);
  }
}

TEST(ContentReloader, SeesAnEditMadeBetweenTheLoadAndItsStart) {
  const ScratchFolder folder;
  const auto file = write_pair(folder);
  const auto scene = load(file);
  folder.write("pair.scene.json", with(std::string(kScene), "\"frames\": 10", "\"frames\": 11"));
  ContentReloader reloader(file, scene);
  const auto outcome = reloader.wait();
  ASSERT_TRUE(outcome && outcome->scene);
  EXPECT_EQ(outcome->scene->frames, 11);
}

TEST(ContentReloader, TellsTheErrorsAndRecovers) {
  const ScratchFolder folder;
  const auto file = write_pair(folder);
  ContentReloader reloader(file, load(file));
  folder.write("legs.character.json", with(std::string(kLegs), "1365", "-1365"));
  auto outcome = reloader.wait();
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(outcome->scene);
  EXPECT_THAT(test::errors_of(outcome->diagnostics, folder.path()),
              HasSubstr("legs.character.json:35:30: /muscles/0/max_isometric_force: -1365 is out of range"));
  EXPECT_FALSE(reloader.wait());  // told once
  // While the scene is no JSON, its other files are unknown, but still watched.
  folder.write("pair.scene.json", "{");
  ASSERT_TRUE(reloader.wait());
  folder.write("legs.character.json", kLegs);
  outcome = reloader.wait();
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(outcome->scene);
  folder.write("pair.scene.json", kScene);
  outcome = reloader.wait();
  ASSERT_TRUE(outcome && outcome->scene);
  EXPECT_EQ(describe(*outcome->scene), describe(*load(file)));
}

TEST(ContentReloader, NoticesAFileThatAppears) {
  const ScratchFolder folder;
  const auto file = write_pair(folder);
  ContentReloader reloader(file, load(file));
  folder.write("pair.scene.json", with(std::string(kScene), "\"./legs", "\"./more"));
  auto outcome = reloader.wait();
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(outcome->scene);
  folder.write("more.character.json", with(std::string(kLegs), "\"name\": \"legs\"", "\"name\": \"more\""));
  outcome = reloader.wait();
  ASSERT_TRUE(outcome && outcome->scene);
  EXPECT_EQ(outcome->scene->characters[2].character->name, "more");
}

// A file that stays away is an error that the running scene outlives; its return is news even where it is as it was.
TEST(ContentReloader, TellsOfAFileThatIsLostAndOfItsReturn) {
  const ScratchFolder folder;
  const auto file = write_pair(folder);
  ContentReloader reloader(file, load(file));
  reloader.wait();  // files as young as these may be loaded again
  const auto poll_long = [&] {
    std::optional<ReloadOutcome> outcome;
    for (int i = 0; i < 5000 && !outcome; ++i) {
      outcome = reloader.poll();
      if (!outcome) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return outcome;
  };
  std::filesystem::remove(folder.path() / "shapes.gltf");
  auto outcome = poll_long();
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(outcome->scene);
  EXPECT_THAT(to_text(outcome->diagnostics), HasSubstr("'shapes.gltf' does not exist"));
  folder.write("shapes.gltf", kShapes);
  outcome = poll_long();
  ASSERT_TRUE(outcome);
  EXPECT_TRUE(outcome->scene);
}

TEST(ContentReloader, StartsFromAFileThatDoesNotLoad) {
  const ScratchFolder folder;
  const auto file = write_pair(folder);
  folder.write("block.character.json", "{}");
  ContentReloader reloader(file, nullptr);
  auto outcome = reloader.wait();
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(outcome->scene);
  folder.write("block.character.json", kBlock);
  outcome = reloader.wait();
  EXPECT_TRUE(outcome && outcome->scene);
}

// One random edit: two in three sound, one in three broken in one of several ways.
struct Edit {
  std::string file;
  std::string text;
  bool broken = false;
};

Edit random_edit(std::mt19937& random) {
  const auto number = static_cast<std::size_t>(random() % 50);
  const std::string n = std::to_string(number);
  const std::string scene(kScene), legs(kLegs), shapes(kShapes);
  const auto vertices = [&](std::size_t count) {
    return with(legs, "\"section_vertices\": 8", "\"section_vertices\": " + std::to_string(count));
  };
  switch (random() % 12) {
    case 0: return {"pair.scene.json", with(scene, "\"frames\": 10", "\"frames\": 1" + n)};
    case 1: return {"pair.scene.json", with(scene, "\"heading\": 0.5", "\"heading\": 0." + n)};
    case 2: return {"legs.character.json", with(legs, "1365", "13" + n)};
    case 3: return {"legs.character.json", with(legs, "[0.04, -0.33, 0.01]", "[0.04, -0.3" + n + ", 0]")};
    case 4: return {"legs.character.json", vertices(6 + 2 * (number % 4))};
    case 5: return {"block.character.json", std::string(kBlock) + std::string(number, '\n')};
    case 6: return {"shapes.gltf", with(shapes, "0.5, 0]", "0." + n + ", 0]")};
    case 7: return {"legs.character.json", legs};
    case 8: return {"legs.character.json", vertices(7 + 2 * (number % 4)), true};
    case 9: return {"legs.character.json", legs.substr(0, 10 + legs.size() * number / 60), true};
    case 10: return {"pair.scene.json", with(scene, "\"nod\"", "\"nod" + n + "\""), true};
    default: return {"shapes.gltf", with(shapes, "\"count\": 12", "\"count\": 9" + n), true};
  }
}

// The last good version lives on through broken ones, errors are those of a fresh load, and the end state is that of
// a fresh load, wherever in an edit the polls fell.
TEST(ContentReloader, SurvivesAHundredRandomEdits) {
  std::mt19937 random(2392);
  const ScratchFolder folder;
  const auto file = write_pair(folder);
  std::shared_ptr<const SceneAsset> running = load(file);
  ASSERT_TRUE(running);
  ContentReloader reloader(file, running);
  const auto take = [&](std::optional<ReloadOutcome> outcome) {
    if (!outcome) return;
    if (outcome->scene) {
      running = outcome->scene;
    } else {
      EXPECT_FALSE(outcome->diagnostics.ok());
    }
    EXPECT_EQ(running->characters.size(), 3u);
  };
  int broken = 0;
  for (int i = 0; i < 100; ++i) {
    const Edit edit = random_edit(random);
    broken += edit.broken ? 1 : 0;
    if (random() % 2 == 0) {
      folder.write(edit.file, edit.text);
    } else {  // as editors do: a new file renamed over the old one
      std::filesystem::rename(folder.write("swap", edit.text), folder.path() / edit.file);
    }
    if (random() % 3 == 0) {
      for (std::size_t polls = random() % 4; polls > 0; --polls) take(reloader.poll());
      continue;
    }
    std::optional<ReloadOutcome> outcome = reloader.wait();
    if (!outcome) continue;  // the edit brought back what was there
    const auto fresh = load_scene(file);
    EXPECT_EQ(outcome->scene != nullptr, fresh.ok());
    if (fresh.ok() && outcome->scene) {
      EXPECT_EQ(describe(*outcome->scene), describe(**fresh));
    }
    if (!fresh.ok()) {
      EXPECT_EQ(to_text(outcome->diagnostics), to_text(fresh.diagnostics()));
    }
    take(std::move(outcome));
  }
  EXPECT_GT(broken, 20);
  EXPECT_LT(broken, 50);
  write_pair(folder);
  take(reloader.wait());
  EXPECT_EQ(describe(*running), describe(*load(file)));
}

}  // namespace
}  // namespace fascicle::muscle
