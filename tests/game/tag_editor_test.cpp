// An author adds a tag: what clicks and keys come to, what is behind a pixel of the walker, and that what is saved is
// what was clicked.
#include "game/tag_editor.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include "engine/animation/skeleton.hpp"
#include "game/pick_place.hpp"
#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/content/content_reloader.hpp"
#include "modules/muscle/content/save_collision.hpp"
#include "modules/muscle/muscle.hpp"
#include "tests/support/copy_folder.hpp"
#include "tests/support/surface_rays.hpp"

namespace fascicle::game {
namespace {

namespace fs = std::filesystem;

PickedPlace on_muscle(std::uint32_t muscle, float fraction = 0.5f) {
  return {0, "muscle_" + std::to_string(muscle), -1, {muscle, fraction, 1.0f}};
}
PickedPlace on_bone(std::int32_t bone) { return {0, "bone_" + std::to_string(bone), bone, {}}; }

TEST(TagEditor, RefusesABoneFirstTheSameMuscleTwiceAndAnotherCharacter) {
  TagEditor editor;
  editor.set_active(true);
  editor.pick(on_bone(1));
  EXPECT_TRUE(editor.places().empty());
  EXPECT_THAT(editor.task().lines.back(), testing::HasSubstr("must be on a muscle"));
  editor.pick(on_muscle(1));
  editor.pick(on_muscle(1, 0.7f));
  EXPECT_EQ(editor.places().size(), 1u);
  EXPECT_THAT(editor.task().lines.back(), testing::HasSubstr("choose another"));
  PickedPlace elsewhere = on_muscle(2);
  elsewhere.character = 1;
  editor.pick(elsewhere);
  EXPECT_EQ(editor.places().size(), 1u);
  EXPECT_FALSE(editor.tag().has_value());
}

TEST(TagEditor, TwoPlacesAreATagAndAThirdReplacesTheSecond) {
  TagEditor editor;
  editor.pick(on_muscle(1));
  editor.pick(on_muscle(2));
  editor.pick(on_muscle(3, 0.25f));
  auto tag = editor.tag();
  ASSERT_TRUE(tag.has_value());
  EXPECT_EQ(tag->first.muscle, 1u);
  EXPECT_EQ(tag->second.muscle, 3u);
  EXPECT_EQ(tag->second.fraction, 0.25f);
  EXPECT_EQ(tag->bone, -1);
  EXPECT_EQ(tag->yields, muscle::Yields::kBoth);
  EXPECT_FALSE(tag->sweeps || tag->automatic);
  EXPECT_EQ(editor.mirror(), std::nullopt);

  for (const TagCommand command : {TagCommand::kYields, TagCommand::kSweeps, TagCommand::kSides}) editor.apply(command);
  tag = editor.tag();
  EXPECT_EQ(tag->yields, muscle::Yields::kFirst);
  EXPECT_TRUE(tag->sweeps);
  EXPECT_EQ(editor.mirror(), false);
  editor.apply(TagCommand::kYields);
  EXPECT_EQ(editor.tag()->yields, muscle::Yields::kSecond);

  editor.pick(on_bone(7));
  EXPECT_EQ(editor.tag()->bone, 7);
  EXPECT_EQ(editor.tag()->yields, muscle::Yields::kBoth) << "a bone never yields";
  editor.apply(TagCommand::kForget);
  EXPECT_FALSE(editor.tag().has_value());
  EXPECT_EQ(editor.places().size(), 1u);
}

TEST(TagEditor, AFailureKeepsThePlacesAndASaveForgetsThem) {
  TagEditor editor;
  editor.set_active(true);
  editor.pick(on_muscle(1));
  editor.pick(on_muscle(2));
  editor.set_failed();
  EXPECT_TRUE(editor.tag().has_value());
  EXPECT_THAT(editor.task().lines.back(), testing::HasSubstr("not saved"));
  editor.set_active(false);
  EXPECT_TRUE(editor.tag().has_value()) << "nothing is lost by looking away";
  editor.set_active(true);
  editor.set_saved("walker.collision.json");
  EXPECT_TRUE(editor.places().empty());
  EXPECT_THAT(editor.task().lines.back(), testing::HasSubstr("walker.collision.json"));
}

TEST(TagEditor, KeysAndButtonsAreTheSameCommands) {
  TagEditor editor;
  EXPECT_TRUE(editor.task().title.empty());
  editor.set_active(true);
  InputState input;
  EXPECT_FALSE(TagEditor::command_of(input).has_value());
  const Key keys[] = {Key::enter, Key::backspace, Key::y, Key::w, Key::o, Key::escape};
  ASSERT_EQ(editor.task().buttons.size(), std::size(keys));
  for (std::size_t i = 0; i < std::size(keys); ++i) {
    input.pressed = {keys[i]};
    EXPECT_EQ(TagEditor::command_of(input), TagEditor::command_of_button(static_cast<int>(i)));
  }
  EXPECT_FALSE(editor.task().buttons[0].enabled) << "nothing to save yet";
  editor.pick(on_muscle(1));
  editor.pick(on_muscle(2));
  EXPECT_TRUE(editor.task().buttons[0].enabled);
}

std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// The walker in a folder of its own, in the middle of a step.
class TagWalker : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("fascicle_tag_editor_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "characters");
    const fs::path content = fs::path(FASCICLE_SOURCE_DIR) / "content";
    fs::copy(content / "scenes", folder_ / "scenes", fs::copy_options::recursive);
    fs::copy(content / "schema", folder_ / "schema", fs::copy_options::recursive);
    test::copy_character_folder(content / "characters" / "walker", folder_ / "characters" / "walker");
    const auto scene = muscle::load_scene(scene_file());
    ASSERT_TRUE(scene.ok()) << to_text(scene.diagnostics());
    scene_ = *scene;
    simulation_.emplace(scene_, SimulationOptions{.workers = 1, .skin_meshes = false});
    for (int i = 0; i < 20; ++i) simulation_->step();
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path scene_file() const { return folder_ / "scenes" / "walker.scene.json"; }
  const SpawnedCharacter& character() { return simulation_->characters()[0]; }
  template <class T>
  const T& get() {
    return simulation_->world().get<T>(character().musculature);
  }
  const muscle::MuscleAsset& muscles() { return *get<muscle::Musculature>().asset; }
  std::vector<test::SurfaceRay> rays(std::uint32_t m) {
    return test::surface_rays(muscles(), get<muscle::MuscleSurfaces>(), get<muscle::ActionLines>(),
                              get<muscle::CrossSections>(), m);
  }
  // Only muscle `m` is seen.
  std::optional<PickedPlace> pick(std::uint32_t m, const Ray& ray) {
    return pick_place(*simulation_, {.bones = false, .is_hidden = [&](const std::string& name) {
                        return name != muscles().muscles[m].name;
                      }}, ray);
  }
  std::uint32_t muscle(const char* name) { return static_cast<std::uint32_t>(find_muscle(muscles(), name)); }

  fs::path folder_;
  std::shared_ptr<const muscle::SceneAsset> scene_;
  std::optional<Simulation> simulation_;
};

TEST_F(TagWalker, EveryMusclesVerticesAreFoundAtEveryLevel) {
  for (const std::uint32_t level : {0u, 1u}) {
    simulation_->set_viewer({.enabled = true, .eye = {0, 1, 2}, .pixels_per_radian = 500.0f, .level = level});
    for (int i = 0; i < 4; ++i) simulation_->step();
    std::size_t asked = 0, right = 0;
    for (std::uint32_t m = 0; m < muscles().size(); ++m) {
      for (const test::SurfaceRay& ray : rays(m)) {
        const auto place = pick(m, ray.ray);
        ++asked;
        if (!place || place->name != muscles().muscles[m].name) continue;
        const muscle::TaggedVertex found = muscle::find_tagged_vertex(muscles(), place->tag);
        right += found.section == ray.section && found.vertex == ray.vertex ? 1 : 0;
      }
    }
    EXPECT_GT(asked, level == 0 ? 3000u : 500u);
    // Pressed surfaces may have another vertex of their triangle nearer to the place.
    EXPECT_GT(right, asked - asked / 100) << "of " << asked << " at level " << level;
  }
}

TEST_F(TagWalker, BonesArePickedWhereNoMuscleIsInFront) {
  const auto knee = static_cast<std::size_t>(character().asset->skeleton->find("tibia_r"));
  const glm::vec3 place(simulation_->world().get<BoneMatrices>(character().entity).world[knee][3]);
  const glm::vec3 from = place + glm::vec3(0.0f, -0.05f, 1.0f);
  const auto bone = pick_place(*simulation_, {.muscles = false}, {from, {0, 0, -1}});
  ASSERT_TRUE(bone.has_value());
  EXPECT_EQ(bone->bone, static_cast<std::int32_t>(knee));
  EXPECT_EQ(bone->name, "tibia_r");
  EXPECT_FALSE(pick_place(*simulation_, {.muscles = false, .bones = false}, {from, {0, 0, -1}}).has_value());
  EXPECT_FALSE(pick_place(*simulation_, {}, {{5, 5, 5}, {0, 1, 0}}).has_value());
}

TEST_F(TagWalker, WhatIsSavedIsWhatWasClickedAndRunsAfterTheReload) {
  muscle::ContentReloader reloader(scene_file(), scene_);
  const std::uint32_t first = muscle("rectus_femoris_r"), second = muscle("sartorius_r");
  const test::SurfaceRay a = rays(first).at(40), b = rays(second).at(25);
  TagEditor editor;
  editor.set_active(true);
  editor.pick(pick(first, a.ray).value());
  editor.pick(pick(second, b.ray).value());
  editor.apply(TagCommand::kYields);
  const auto tag = editor.tag();
  ASSERT_TRUE(tag.has_value());

  const muscle::CharacterAsset& asset = *character().asset;
  const auto saved = muscle::save_transversal(asset.files.front(), asset, *tag, editor.mirror());
  ASSERT_TRUE(saved.ok()) << to_text(saved.diagnostics());
  const auto outcome = reloader.wait();
  ASSERT_TRUE(outcome.has_value() && outcome->scene) << "the reload sees the file";
  simulation_->swap_scene(outcome->scene);
  simulation_->step();

  // The author's tags of the new simulation: what was clicked, and its image on the other side.
  const std::vector<muscle::TransversalTag>& tags = character().asset->collision.transversals;
  int found = 0, images = 0;
  for (const muscle::Transversal& transversal : get<muscle::MuscleCollision>().asset->transversals) {
    if (tags[transversal.tag].automatic) continue;
    const auto& sections = get<muscle::MuscleCollision>().asset->sections;
    const muscle::CollisionSection& one = sections[transversal.section];
    const muscle::CollisionSection& other = sections[transversal.other_section];
    if (one.muscle == muscle("rectus_femoris_l") && other.muscle == muscle("sartorius_l")) ++images;
    if (one.muscle != first || other.muscle != second) continue;
    ++found;
    EXPECT_EQ(one.section, a.section);
    EXPECT_EQ(transversal.vertex, a.vertex);
    EXPECT_EQ(other.section, b.section);
    EXPECT_EQ(transversal.other_vertex, b.vertex);
    EXPECT_TRUE(transversal.first_yields);
    EXPECT_FALSE(transversal.second_yields);
  }
  EXPECT_EQ(found, 1);
  EXPECT_EQ(images, 1);

  // Once more: refused with the place in the file, which stays as it is, and so do the clicks.
  const std::string text = read(saved->file);
  const auto again = muscle::save_transversal(asset.files.front(), *character().asset, *tag, editor.mirror());
  ASSERT_FALSE(again.ok());
  EXPECT_THAT(to_text(again.diagnostics()), testing::HasSubstr("tagged already"));
  EXPECT_EQ(read(saved->file), text);
  editor.set_failed();
  EXPECT_TRUE(editor.tag().has_value());
}

TEST_F(TagWalker, AReloadFindsPlacesByTheirNames) {
  TagEditor editor;
  editor.pick({0, "soleus_r", -1, {99, 0.5f, 0.0f}});
  editor.pick({0, "tibia_r", 99, {}});
  editor.rename({character().asset.get()});
  ASSERT_TRUE(editor.tag().has_value());
  EXPECT_EQ(editor.tag()->first.muscle, muscle("soleus_r"));
  EXPECT_EQ(editor.tag()->bone, character().asset->skeleton->find("tibia_r"));
  editor.rename({});
  EXPECT_TRUE(editor.places().empty());
  editor.pick({0, "no_such_muscle", -1, {0, 0.5f, 0.0f}});
  editor.rename({character().asset.get()});
  EXPECT_TRUE(editor.places().empty());
}

}  // namespace
}  // namespace fascicle::game
