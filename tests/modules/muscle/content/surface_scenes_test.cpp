// The scenes of the method's page 4.3 as content: what they attach, how their bones move, and that their muscles are
// what they are said to be.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/animation/joint_model.hpp"
#include "engine/animation/joint_systems.hpp"
#include "engine/animation/motion.hpp"
#include "engine/animation/skeleton.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/content/scene_asset.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::muscle {
namespace {

using testing::HasSubstr;

const std::filesystem::path kScenes = std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "scenes";

// Each scene is loaded once.
std::shared_ptr<const SceneAsset> load(const std::string& name) {
  static std::map<std::string, std::shared_ptr<const SceneAsset>> scenes;
  if (const auto known = scenes.find(name); known != scenes.end()) return known->second;
  // The bones' fields are other tests' business; without them a load is quick.
  const auto loaded = load_scene(kScenes / (name + ".scene.json"),
                                 {.data_folder = test::data_folder(), .bone_fields = false});
  EXPECT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
  EXPECT_TRUE(loaded.diagnostics().warnings.empty()) << to_text(loaded.diagnostics());
  return scenes.emplace(name, loaded.ok() ? *loaded : nullptr).first->second;
}

// The figure of the method's 4.3: 100 steps out, 100 back, 100 at rest, and one more, so that step 300 is no repetition.
int turning_point(int step) { return step <= 100 ? step : std::max(0, 200 - step); }

// The bone's motion against its rest at a step, as the game plays it: a player that is advanced by the scene's step.
glm::mat4 motion_at(const SceneAsset& scene, const char* bone, int step) {
  const SceneCharacter& placed = scene.characters.at(0);
  const CharacterAsset& character = *placed.character;
  const float seconds = 1.0f / scene.step_hz;
  double time = 0.0;
  for (int i = 0; i < step; ++i) time += 1.0 * static_cast<double>(seconds);
  CoordinatePose pose = make_coordinate_pose(character.joints);
  sample_cycle(*placed.animation.motion, time, placed.in_place, pose.values);
  LocalPose local{character.skeleton, character.skeleton->rest_local};
  pose_joints(*pose.model, pose.values, local.bones);
  std::vector<glm::mat4> world(local.bones.size());
  compose(*character.skeleton, local.bones, glm::mat4(1.0f), world);
  const auto b = static_cast<std::size_t>(character.skeleton->find(bone));
  return world[b] * glm::inverse(character.skeleton->rest_world[b]);
}

void expect_same_motion(const glm::mat4& found, const glm::mat4& expected, int step) {
  // Corners of a box as large as the scene: what the motion does to them, m.
  for (int i = 0; i < 8; ++i) {
    const glm::vec4 corner(i & 1 ? 0.3f : 0.0f, i & 2 ? -0.9f : -0.3f, i & 4 ? -0.4f : 0.0f, 1.0f);
    ASSERT_LT(glm::distance(glm::vec3(found * corner), glm::vec3(expected * corner)), 1e-6f) << "step " << step;
  }
}

TEST(SurfaceScenes, BoxIsPressedAndLetGo) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/box.vtk");
  const auto scene = load("box");
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->frames, 300);
  EXPECT_EQ(scene->step_hz, 60.0f);
  const CharacterAsset& character = *scene->characters.at(0).character;
  ASSERT_EQ(character.surface_muscles.size(), 1u);
  const SurfaceAsset& box = *character.surface_muscles[0];
  EXPECT_EQ(box.vertex_count, 2648u);
  EXPECT_EQ(box.triangle_count(), 5292u);
  EXPECT_TRUE(box.attached.empty());
  EXPECT_EQ(box.frame_bone, character.skeleton->find("plate_bottom"));
  EXPECT_EQ(box.bones.size(), 2u);
  const Bounds bounds = mesh_bounds(character.surface_descriptions[0].mesh);
  EXPECT_NEAR(glm::distance(bounds.lower, glm::vec3(-0.05f, 0.01f, -0.05f)), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(bounds.upper, glm::vec3(0.05f, 0.09f, 0.05f)), 0.0f, 1e-6f);
  for (int step = 0; step <= 300; ++step) {
    const glm::mat4 down =
        glm::translate(glm::mat4(1.0f), {0.0f, -0.0009f * static_cast<float>(turning_point(step)), 0.0f});
    expect_same_motion(motion_at(*scene, "plate_top", step), down, step);
    expect_same_motion(motion_at(*scene, "plate_bottom", step), glm::mat4(1.0f), step);
  }
}

struct Hip {
  const char* scene;
  const char* muscle;
  std::size_t vertices, triangles, on_femur;
  double volume;  // m^3
  float held_above;  // m: of the file's z
  std::size_t fibres;
};

class HipScenes : public testing::TestWithParam<Hip> {};

TEST_P(HipScenes, AreAttachedAsTheyAreSaidToBe) {
  FASCICLE_SKIP_WITHOUT_DATA(std::string("pbd/") + GetParam().muscle + ".vtk");
  const auto scene = load(GetParam().scene);
  ASSERT_TRUE(scene);
  const CharacterAsset& character = *scene->characters.at(0).character;
  ASSERT_EQ(character.surface_muscles.size(), 1u);
  const SurfaceAsset& muscle = *character.surface_muscles[0];
  EXPECT_EQ(muscle.name, GetParam().muscle);
  EXPECT_EQ(muscle.vertex_count, GetParam().vertices);
  EXPECT_EQ(muscle.triangle_count(), GetParam().triangles);
  EXPECT_NEAR(muscle.volume, GetParam().volume, 1e-7);
  EXPECT_EQ(muscle.frame_bone, character.skeleton->find("pelvis"));
  EXPECT_EQ(muscle.fibres.size(), GetParam().fibres);
  ASSERT_TRUE(character.fibre_bundles.at(0));
  EXPECT_EQ(character.fibre_bundles[0]->count, 1000u);
  ASSERT_EQ(muscle.attachments.size(), 2u);
  EXPECT_EQ(muscle.attachments[0].bone, character.skeleton->find("pelvis"));
  EXPECT_TRUE(muscle.attachments[0].origin);
  EXPECT_EQ(muscle.attachments[1].bone, character.skeleton->find("femur"));
  EXPECT_FALSE(muscle.attachments[1].origin);
  EXPECT_EQ(muscle.attachments[1].count, GetParam().on_femur);
  // The file's z is up here.
  std::size_t above = 0;
  for (const glm::vec3& p : character.surface_descriptions[0].mesh.positions) above += p.y > GetParam().held_above;
  EXPECT_EQ(muscle.attachments[0].count, above);
}

TEST_P(HipScenes, BendTheHipByAHundredthOfARadianAStep) {
  FASCICLE_SKIP_WITHOUT_DATA(std::string("pbd/") + GetParam().muscle + ".vtk");
  const auto scene = load(GetParam().scene);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->frames, 300);
  // The data's x axis through (146, 238, -431) mm, z up, is ours through (0.146, -0.431, -0.238) m, y up.
  const glm::vec3 centre(0.146f, -0.431f, -0.238f);
  for (int step = 0; step <= 300; ++step) {
    const float angle = -0.01f * static_cast<float>(turning_point(step));
    const glm::mat4 turn = glm::translate(glm::mat4(1.0f), centre) *
                           glm::rotate(glm::mat4(1.0f), angle, {1.0f, 0.0f, 0.0f}) *
                           glm::translate(glm::mat4(1.0f), -centre);
    expect_same_motion(motion_at(*scene, "femur", step), turn, step);
    expect_same_motion(motion_at(*scene, "pelvis", step), glm::mat4(1.0f), step);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Both, HipScenes,
    testing::Values(Hip{"hip-gluteus", "gluteus_maximus", 9878, 19752, 269, 746.6e-6, -0.3437f, 5},
                    Hip{"hip-iliacus", "iliacus", 6931, 13858, 267, 102.3e-6, -0.3138f, 0}),
    [](const auto& one) { return std::string(one.param.muscle); });

TEST(SurfaceScenes, SayWhatIsMissingWithoutTheData) {
  for (const char* name : {"box", "hip-gluteus", "hip-iliacus"}) {
    const auto loaded = load_scene(kScenes / (std::string(name) + ".scene.json"), {.data_folder = "/no/such/folder"});
    ASSERT_FALSE(loaded.ok());
    EXPECT_TRUE(lacks_data(loaded.diagnostics()));
    EXPECT_EQ(loaded.diagnostics().errors.size(), 1u) << to_text(loaded.diagnostics());
    EXPECT_THAT(to_text(loaded.diagnostics()), HasSubstr("FASCICLE_DATA"));
  }
}

}  // namespace
}  // namespace fascicle::muscle
