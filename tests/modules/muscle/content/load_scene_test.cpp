#include "modules/muscle/content/scene_asset.hpp"

#include <gmock/gmock.h>

#include "engine/animation/clip.hpp"
#include "engine/animation/motion.hpp"
#include "engine/animation/skeleton.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "tests/modules/muscle/content/scratch_content.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::muscle {
namespace {

using test::ScratchFolder;
using testing::ElementsAre;

TEST(LoadScene, PlacesItsCharactersAndLoadsEachFileOnce) {
  const ScratchFolder folder;
  const auto loaded = load_scene(write_pair(folder));
  ASSERT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
  const SceneAsset& scene = **loaded;
  EXPECT_EQ(scene.name, "pair");
  EXPECT_FALSE(scene.requires_data);
  EXPECT_FLOAT_EQ(scene.step_hz, 120.0f);
  EXPECT_EQ(scene.frames, 10);
  ASSERT_EQ(scene.characters.size(), 3u);
  const SceneCharacter& first = scene.characters[0];
  EXPECT_EQ(first.position, glm::vec3(1, 0, 0));
  EXPECT_FLOAT_EQ(first.heading, 0.5f);
  EXPECT_TRUE(first.in_place);
  EXPECT_FALSE(first.animation.clip);
  const SceneCharacter& second = scene.characters[1];
  ASSERT_TRUE(second.animation.clip);
  EXPECT_EQ(second.animation.clip->name, "nod");
  EXPECT_FLOAT_EQ(second.animation.speed, 2.0f);
  EXPECT_FLOAT_EQ(second.animation.phase, 0.25f);
  EXPECT_EQ(scene.characters[2].character, first.character);  // the same file by another name
  EXPECT_FLOAT_EQ(scene.camera.field_of_view, 0.8f);
  EXPECT_THAT(scene.files, ElementsAre(folder.path() / "pair.scene.json", folder.path() / "legs.character.json",
                                       folder.path() / "shapes.gltf", folder.path() / "legs.fit.json",
                                       folder.path() / "block.character.json"));
}

TEST(LoadScene, PlaysAMotionOnJoints) {
  const ScratchFolder folder;
  write_pair(folder);
  folder.write("turn.mot", "turn\nnRows=2\nnColumns=2\ninDegrees=yes\nendheader\ntime lift\n0 0\n1 90\n");
  folder.write("legs.character.json",
               test::with(test::with(std::string(test::kLegs), "\"coordinates\": []",
                                     R"("coordinates": [{ "name": "lift", "range": [-3, 3] }])"),
                          R"("name": "hip_r", )",
                          R"("name": "hip_r", "rotations": [{ "axis": [0, 0, 1], "coordinate": "lift" }], )"));
  const auto scene = folder.write("turn.scene.json", R"({ "version": 1, "name": "turn", "characters": [
    { "file": "legs.character.json", "animation": { "motion": "turn.mot" } }] })");
  const auto loaded = load_scene(scene);
  ASSERT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
  ASSERT_TRUE((*loaded)->characters[0].animation.motion);
  EXPECT_NEAR((*loaded)->characters[0].animation.motion->duration(), 1.0, 1e-12);
  EXPECT_THAT((*loaded)->files, testing::Contains(folder.path() / "turn.mot"));
}

TEST(LoadScene, AMotionMayRepeatAllOfItsRecord) {
  const ScratchFolder folder;
  write_pair(folder);
  std::string motion = "turn\ninDegrees=no\nendheader\ntime lift\n";
  for (int i = 0; i <= 20; ++i) motion += std::to_string(0.1 * i) + (i < 10 ? " " + std::to_string(i) : " 0") + '\n';
  folder.write("turn.mot", motion);
  folder.write("legs.character.json",
               test::with(test::with(std::string(test::kLegs), "\"coordinates\": []",
                                     R"("coordinates": [{ "name": "lift", "range": [-30, 30] }])"),
                          R"("name": "hip_r", )",
                          R"("name": "hip_r", "rotations": [{ "axis": [0, 0, 1], "coordinate": "lift" }], )"));
  const auto length = [&](const char* loop) {
    const auto scene = folder.write("turn.scene.json", std::string(R"({ "version": 1, "name": "turn", "characters": [
      { "file": "legs.character.json", "animation": { "motion": "turn.mot")") + loop + " } }] }");
    const auto loaded = load_scene(scene);
    EXPECT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
    return loaded.ok() ? (*loaded)->characters[0].animation.motion->cycle.length() : 0.0;
  };
  EXPECT_NEAR(length(R"(, "loop": "record")"), 2.0, 1e-9);
  EXPECT_LT(length(R"(, "loop": "cycle")"), 1.5);
  EXPECT_EQ(length(""), length(R"(, "loop": "cycle")"));
}

TEST(LoadScene, FoldersCanBeGiven) {
  const ScratchFolder folder;
  folder.write("shapes.gltf", test::kShapes);
  std::string block(test::kBlock);
  for (std::size_t at = block.find("\"shapes"); at != std::string::npos; at = block.find("\"shapes")) {
    block.insert(at + 1, "data:");
  }
  const auto file = folder.write("deep/down/block.character.json", block);
  EXPECT_FALSE(load_character(file, {.data_folder = folder.path() / "deep"}).ok());
  const auto loaded = load_character(file, {.data_folder = folder.path()});
  EXPECT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
}

// Real input: a downloaded character with the project's own muscles.
TEST(LoadScene, CesiumManHasTwelveMusclesInsideHisLegs) {
  FASCICLE_SKIP_WITHOUT_DATA("gltf/CesiumMan.glb");
  const auto loaded =
      load_scene(std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "scenes" / "cesium-man.scene.json",
                 {.data_folder = test::data_folder()});
  ASSERT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
  EXPECT_TRUE(loaded.diagnostics().warnings.empty()) << to_text(loaded.diagnostics());
  const SceneCharacter& man = (*loaded)->characters.at(0);
  ASSERT_EQ(man.character->descriptions.size(), 12u);
  ASSERT_TRUE(man.character->muscles);
  ASSERT_TRUE(man.animation.clip);
  EXPECT_NEAR(man.animation.clip->duration(), 2.0f, 0.1f);
  EXPECT_EQ(man.character->skins.size(), 1u);
  // The right leg's muscles stand at x < 0, their images at x > 0, all within the legs' box.
  const Skeleton& skeleton = *man.character->skeleton;
  for (const MuscleDescription& muscle : man.character->descriptions) {
    const bool right = muscle.name.ends_with("_R");
    EXPECT_TRUE(right || muscle.name.ends_with("_L")) << muscle.name;
    for (const AttachmentDescription& point : muscle.attachments) {
      const glm::vec3 place(skeleton.rest_world[static_cast<std::size_t>(point.bone)] *
                            glm::vec4(point.position, 1.0f));
      EXPECT_GT(right ? -place.x : place.x, 0.02f) << muscle.name;
      EXPECT_LT(right ? -place.x : place.x, 0.12f) << muscle.name;
      EXPECT_GT(place.y, 0.0f) << muscle.name;
      EXPECT_LT(place.y, 0.75f) << muscle.name;
      EXPECT_GT(place.z, -0.1f) << muscle.name;
      EXPECT_LT(place.z, 0.11f) << muscle.name;
    }
  }
}

}  // namespace
}  // namespace fascicle::muscle
