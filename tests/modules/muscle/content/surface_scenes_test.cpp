// The scenes of the method's page 4.3 as content: what they attach, how their bones move, and that their muscles are
// what they are said to be.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/animation/joint_model.hpp"
#include "engine/animation/joint_systems.hpp"
#include "engine/animation/motion.hpp"
#include "engine/animation/skeleton.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
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

auto figures(const SurfaceSettings& s) {
  return std::tuple(s.substeps, s.density, s.stretch_compliance, s.along_fibres, s.bend_compliance, s.volume_compliance,
                    s.anchor_compliance, s.damping, s.viscosity, s.contact_distance, s.friction, s.collide_with_bones,
                    s.collide_with_itself, s.collide_with_muscles);
}

// What compares the two solvers must differ in nothing else.
TEST(SurfaceScenes, HipHullIsTheTwoHipsWithHulls) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
  const auto both = load("hip-hull");
  ASSERT_TRUE(both);
  const CharacterAsset& character = *both->characters.at(0).character;
  ASSERT_EQ(character.surface_muscles.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto alone = load(i == 0 ? "hip-gluteus" : "hip-iliacus");
    ASSERT_TRUE(alone);
    const SurfaceAsset& muscle = *character.surface_muscles[i];
    const SurfaceAsset& same = *alone->characters.at(0).character->surface_muscles.at(0);
    EXPECT_EQ(muscle.name, same.name);
    EXPECT_EQ(muscle.file_vertex, same.file_vertex);
    EXPECT_EQ(muscle.volume, same.volume);
    ASSERT_EQ(muscle.attached.size(), same.attached.size());
    for (std::size_t v = 0; v < same.attached.size(); ++v) {
      ASSERT_EQ(muscle.attached[v].vertex, same.attached[v].vertex);
    }
    EXPECT_EQ(muscle.frame_bone, same.frame_bone);
    EXPECT_EQ(muscle.bones, same.bones);
    EXPECT_EQ(muscle.fibres.size(), same.fibres.size());
    EXPECT_EQ(figures(muscle.settings), figures(same.settings));
    ASSERT_EQ(muscle.packs.size(), same.packs.size());
    EXPECT_EQ(std::memcmp(muscle.packs.data(), same.packs.data(), muscle.packs.size() * sizeof(HingePack)), 0);

    ASSERT_TRUE(character.hulls.at(i));
    EXPECT_EQ(character.hulls[i]->rest.size(), 300u);
    ASSERT_EQ(character.hulls[i]->levels.size(), 1u);
    EXPECT_EQ(character.hulls[i]->levels[0].solver, SurfaceSolver::kCoarseHull);
    // The line runs through the muscle, from where the pelvis holds it to the femur.
    const SurfaceMuscleDescription& description = character.surface_descriptions[i];
    const auto& line = description.action_line;
    ASSERT_GE(line.size(), 4u);
    EXPECT_EQ(line.front().bone, muscle.attachments[0].bone);
    EXPECT_EQ(line.back().bone, muscle.attachments[1].bone);
    const WindingField inside(description.mesh);
    for (std::size_t k = 0; k < line.size(); ++k) {
      const bool end = k == 0 || k + 1 == line.size();
      EXPECT_TRUE(end || inside.inside(line[k].position)) << muscle.name << " point " << k;
    }
    for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
      glm::dvec3 middle(0.0);
      for (const std::uint32_t v : description.attachments[end].vertices) {
        middle += glm::dvec3(description.mesh.positions[v]);
      }
      middle /= static_cast<double>(description.attachments[end].vertices.size());
      const glm::vec3& point = end == 0 ? line.front().position : line.back().position;
      EXPECT_LT(glm::distance(glm::vec3(middle), point), 0.001f) << muscle.name;
    }
  }
}

// Every hundredth of a radian from 0 to 1, in no order; then twenty of them again, after other poses than before.
TEST(SurfaceScenes, HipHullTakesPosesInAnyOrder) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/femur.vtk");
  const auto scene = load("hip-hull");
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->frames, 150);
  const glm::vec3 centre(0.146f, -0.431f, -0.238f);
  const auto turn = [&](int pose) {
    return glm::translate(glm::mat4(1.0f), centre) *
           glm::rotate(glm::mat4(1.0f), -0.01f * static_cast<float>(pose), {1.0f, 0.0f, 0.0f}) *
           glm::translate(glm::mat4(1.0f), -centre);
  };
  std::vector<int> poses;
  for (int step = 0; step <= scene->frames; ++step) {
    const glm::mat4 motion = motion_at(*scene, "femur", step);
    poses.push_back(static_cast<int>(std::lround(-100.0 * std::atan2(motion[1].z, motion[1].y))));
    // No step is half-way to the next pose, however small a part of it.
    expect_same_motion(motion, turn(poses.back()), step);
  }
  EXPECT_EQ(poses[0], 0);
  std::map<int, std::set<int>> before;
  int falls = 0;
  for (std::size_t step = 1; step < poses.size(); ++step) {
    EXPECT_EQ(before[poses[step]].empty(), step <= 101) << "pose " << poses[step];
    EXPECT_TRUE(before[poses[step]].insert(poses[step - 1]).second) << "pose " << poses[step];
    falls += poses[step] < poses[step - 1];
  }
  EXPECT_EQ(before.size(), 101u);
  EXPECT_EQ(before.begin()->first, 0);
  EXPECT_EQ(before.rbegin()->first, 100);
  EXPECT_EQ(std::ranges::count_if(before, [](const auto& one) { return one.second.size() > 1; }), 20);
  EXPECT_GT(falls, 50);
}

TEST(SurfaceScenes, SayWhatIsMissingWithoutTheData) {
  for (const char* name : {"box", "hip-gluteus", "hip-iliacus", "hip-hull"}) {
    const auto loaded = load_scene(kScenes / (std::string(name) + ".scene.json"), {.data_folder = "/no/such/folder"});
    ASSERT_FALSE(loaded.ok());
    EXPECT_TRUE(lacks_data(loaded.diagnostics()));
    EXPECT_EQ(loaded.diagnostics().errors.size(), 1u) << to_text(loaded.diagnostics());
    EXPECT_THAT(to_text(loaded.diagnostics()), HasSubstr("FASCICLE_DATA"));
  }
}

}  // namespace
}  // namespace fascicle::muscle
