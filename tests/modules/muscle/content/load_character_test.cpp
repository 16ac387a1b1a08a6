#include "modules/muscle/content/character_asset.hpp"

#include <gmock/gmock.h>

#include "engine/animation/clip.hpp"
#include "engine/animation/joint_model.hpp"
#include "engine/animation/skinning.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "tests/modules/muscle/content/scratch_content.hpp"

namespace fascicle::muscle {
namespace {

using test::kBlock;
using test::kLegs;
using test::kShapes;
using test::ScratchFolder;
using test::with;
using testing::ElementsAre;
using testing::HasSubstr;

class LoadCharacter : public testing::Test {
 protected:
  std::shared_ptr<const CharacterAsset> load(std::string_view text, LoadOptions options = {}) {
    folder.write("shapes.gltf", kShapes);
    Result<std::shared_ptr<const CharacterAsset>> loaded =
        load_character(folder.write("legs.character.json", text), options);
    EXPECT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
    return loaded.ok() ? *loaded : nullptr;
  }
  ScratchFolder folder;
};

glm::vec3 rest_place(const CharacterAsset& asset, const AttachmentDescription& attachment) {
  const glm::mat4& rest = asset.skeleton->rest_world[static_cast<std::size_t>(attachment.bone)];
  return glm::vec3(rest * glm::vec4(attachment.position, 1.0f));
}

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-6f) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST_F(LoadCharacter, FillsEveryPart) {
  const auto legs = load(kLegs);
  ASSERT_TRUE(legs);
  EXPECT_EQ(legs->name, "legs");
  EXPECT_TRUE(legs->joints);
  EXPECT_TRUE(legs->clips.empty());
  ASSERT_EQ(legs->descriptions.size(), 3u);
  EXPECT_EQ(legs->descriptions[0].name, "vastus_r");
  EXPECT_EQ(legs->descriptions[1].name, "vastus_l");
  EXPECT_EQ(legs->descriptions[2].name, "soleus_r");
  ASSERT_TRUE(legs->muscles);
  EXPECT_EQ(legs->muscles->size(), 3u);
  EXPECT_THAT(legs->files, ElementsAre(folder.path() / "legs.character.json", folder.path() / "shapes.gltf",
                                       folder.path() / "legs.fit.json"));
}

// A character on another's muscles takes the fits that are stored beside that one: what they are good for, their hashes
// tell. Here they are broken, which is told and does no harm.
TEST_F(LoadCharacter, LooksForStoredFitsWhereItsMusclesComeFrom) {
  folder.write("shapes.gltf", kShapes);
  folder.write("base.character.json", kLegs);
  folder.write("base.fit.json", "no JSON");
  std::string text(kLegs);
  text.replace(text.find("\"muscles\": ["), std::string::npos, "\"muscles_from\": \"base.character.json\"\n}\n");
  const auto loaded = load_character(folder.write("legs.character.json", text));
  ASSERT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
  EXPECT_EQ((*loaded)->descriptions.size(), 3u);
  EXPECT_THAT(to_text(loaded.diagnostics()), HasSubstr("base.fit.json:1:1: the stored fits cannot be used"));
  EXPECT_THAT((*loaded)->files, testing::IsSupersetOf({folder.path() / "legs.fit.json", folder.path() / "base.fit.json"}));
}

TEST_F(LoadCharacter, MuscleFieldsGoBeforeTheFilesAndOptionsBeforeBoth) {
  const auto legs = load(kLegs);
  ASSERT_TRUE(legs);
  const MuscleDescription& vastus = legs->descriptions[0];
  const MuscleDescription& soleus = legs->descriptions[2];
  EXPECT_EQ(vastus.section_vertices, 10u);
  EXPECT_EQ(vastus.longitudinal_subdivision, 2u);
  EXPECT_FLOAT_EQ(vastus.specific_tension, 600000.0f);
  EXPECT_EQ(soleus.section_vertices, 8u);
  EXPECT_EQ(soleus.longitudinal_subdivision, 1u);
  EXPECT_FLOAT_EQ(soleus.specific_tension, 500000.0f);
  EXPECT_FLOAT_EQ(soleus.source_length, 0.3f);
  EXPECT_FLOAT_EQ(soleus.volume.value(), 0.0003f);
  EXPECT_FLOAT_EQ(vastus.hill.pennation, 0.05f);
  EXPECT_THAT(vastus.profile.radii, ElementsAre(0.3f, 1.0f, 0.2f));
  EXPECT_FALSE(vastus.attachments[2].counts);
  EXPECT_THAT(vastus.where.path, "/muscles/0");
  EXPECT_EQ(vastus.where.line, 27);

  const auto coarse = load(kLegs, {.section_vertices = 6, .longitudinal_subdivision = 0});
  ASSERT_TRUE(coarse);
  for (const MuscleDescription& muscle : coarse->descriptions) {
    EXPECT_EQ(muscle.section_vertices, 6u);
    EXPECT_EQ(muscle.longitudinal_subdivision, 0u);
  }
}

TEST_F(LoadCharacter, KeepsPositionsInTheBonesFrameBitForBit) {
  const auto legs = load(kLegs);
  ASSERT_TRUE(legs);
  const AttachmentDescription& origin = legs->descriptions[0].attachments[0];
  EXPECT_EQ(origin.position, glm::vec3(0.03f, -0.1f, 0.01f));
  EXPECT_EQ(legs->skeleton->names[static_cast<std::size_t>(origin.bone)], "femur_r");
}

TEST_F(LoadCharacter, MirrorsInTheRestSpace) {
  const auto legs = load(kLegs);
  ASSERT_TRUE(legs);
  const MuscleDescription& right = legs->descriptions[0];
  const MuscleDescription& left = legs->descriptions[1];
  ASSERT_EQ(left.attachments.size(), right.attachments.size());
  for (std::size_t i = 0; i < right.attachments.size(); ++i) {
    const glm::vec3 place = rest_place(*legs, right.attachments[i]);
    expect_near(rest_place(*legs, left.attachments[i]), {-place.x, place.y, place.z});
    EXPECT_EQ(left.attachments[i].counts, right.attachments[i].counts);
    const std::string& bone = legs->skeleton->names[static_cast<std::size_t>(left.attachments[i].bone)];
    EXPECT_TRUE(bone.ends_with("_l")) << bone;
  }
  // The model's axes: right is z > 0 there, x < 0 here; femur_r hangs at z = 0.08 and the origin lies 0.01 beyond.
  expect_near(rest_place(*legs, right.attachments[0]), {-0.09f, 0.8f, 0.03f});
}

TEST_F(LoadCharacter, TakesPositionsFromTheRestSpaceToTheBones) {
  std::string text = with(std::string(kLegs), "\"attachment_space\": \"bone\"", "\"attachment_space\": \"character\"");
  text = with(text, "[0.03, -0.1, 0.01]", "[-0.09, 0.8, 0.03]");
  text = with(text, "[0.04, -0.33, 0.01]", "[-0.09, 0.57, 0.04]");
  text = with(text, "[0.02, 0, 0]", "[-0.08, 0.52, 0.07]");
  text = with(text, "[0.03, -0.06, 0]", "[-0.08, 0.44, 0.03]");
  text = with(text, "[-0.02, -0.1, 0]", "[-0.08, 0.4, -0.02]");
  text = with(text, "[-0.05, 0, 0]", "[-0.08, 0.1, -0.05]");
  const auto legs = load(text);
  ASSERT_TRUE(legs);
  const auto same = load(kLegs);
  ASSERT_TRUE(same);
  for (std::size_t m = 0; m < same->descriptions.size(); ++m) {
    for (std::size_t i = 0; i < same->descriptions[m].attachments.size(); ++i) {
      expect_near(legs->descriptions[m].attachments[i].position, same->descriptions[m].attachments[i].position);
    }
  }
}

TEST_F(LoadCharacter, PlacesBoneMeshes) {
  const auto legs = load(kLegs);
  ASSERT_TRUE(legs);
  ASSERT_EQ(legs->bone_meshes.size(), 1u);
  const BoneMesh& block = legs->bone_meshes[0];
  EXPECT_EQ(legs->skeleton->names[static_cast<std::size_t>(block.bone)], "pelvis");
  EXPECT_EQ(block.mesh->positions.size(), 4u);
  expect_near(glm::vec3(block.transform * glm::vec4(0.1f, 0.0f, 0.0f, 1.0f)), {0.2f, 0.1f, 0.0f});

  const auto placed = load(with(std::string(kLegs), "\"scale\": [2, 1, 1], ", "\"space\": \"character\", "));
  ASSERT_TRUE(placed);
  const BoneMesh& there = placed->bone_meshes[0];
  const glm::mat4& pelvis = placed->skeleton->rest_world[static_cast<std::size_t>(there.bone)];
  expect_near(glm::vec3(pelvis * there.transform * glm::vec4(0.1f, 0.0f, 0.0f, 1.0f)), {0.1f, 0.1f, 0.0f});
}

TEST_F(LoadCharacter, MirroredMuscleTakesTheReflectedMesh) {
  const auto legs = load(kLegs);
  ASSERT_TRUE(legs);
  ASSERT_EQ(legs->muscle_meshes.size(), 2u);
  const TriangleMesh& right = *legs->muscle_meshes.at("vastus_r");
  const TriangleMesh& left = *legs->muscle_meshes.at("vastus_l");
  EXPECT_EQ(legs->descriptions[1].mesh, "vastus_l");
  expect_near(right.positions[0], {-0.1f, 0.5f, 0.0f});
  expect_near(left.positions[1], {0.0f, 0.5f, 0.0f});
  const auto volume = [](const TriangleMesh& mesh) {
    float sum = 0.0f;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const glm::vec3& a = mesh.positions[mesh.indices[i]];
      sum += glm::dot(a, glm::cross(mesh.positions[mesh.indices[i + 1]], mesh.positions[mesh.indices[i + 2]])) / 6.0f;
    }
    return sum;
  };
  EXPECT_NEAR(volume(right), 0.001f / 6.0f, 1e-7f);
  EXPECT_NEAR(volume(left), volume(right), 1e-7f);  // not inside out
}

TEST_F(LoadCharacter, ReadsSkeletonClipsAndSkinFromGltf) {
  folder.write("shapes.gltf", kShapes);
  const auto loaded = load_character(folder.write("block.character.json", kBlock));
  ASSERT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
  const CharacterAsset& block = **loaded;
  EXPECT_FALSE(block.joints);
  EXPECT_FALSE(block.muscles);
  ASSERT_EQ(block.clips.size(), 1u);
  EXPECT_EQ(block.clips[0]->name, "nod");
  ASSERT_EQ(block.skins.size(), 1u);
  EXPECT_EQ(block.skins[0]->positions.size(), 4u);
}

TEST_F(LoadCharacter, TakesMusclesFromAnotherFile) {
  folder.write("base.character.json", kLegs);
  const auto text = with(with(std::string(kLegs), "\"name\": \"soleus_r\"", "\"name\": \"soleus_again_r\""),
                         "\"attachment_space\"", "\"muscles_from\": \"base.character.json\", \"attachment_space\"");
  const auto twice = load_character(folder.write("legs.character.json", text));
  folder.write("shapes.gltf", kShapes);
  EXPECT_FALSE(twice.ok());  // the vastus is there twice
  const auto legs = load(with(with(text, "\"name\": \"vastus_r\", \"mirror\": true", "\"name\": \"other_r\""),
                              "\"muscles_from\"", "\"muscles_from\""));
  ASSERT_TRUE(legs);
  std::vector<std::string> names;
  for (const auto& muscle : legs->descriptions) names.push_back(muscle.name);
  EXPECT_THAT(names, ElementsAre("vastus_r", "vastus_l", "soleus_r", "other_r", "soleus_again_r"));
  EXPECT_THAT(legs->files, testing::Contains(folder.path() / "base.character.json"));
  EXPECT_THAT(legs->descriptions[0].where.file, HasSubstr("base.character.json"));
}

}  // namespace
}  // namespace fascicle::muscle
