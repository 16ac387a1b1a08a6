// Bones' fields with a character: made at load, kept beside its file, made again when they have to be.
#include "modules/muscle/content/bone_field_store.hpp"

#include <filesystem>
#include <fstream>
#include <memory>

#include <gtest/gtest.h>

#include "engine/animation/skeleton.hpp"
#include "engine/content/file_text.hpp"
#include "modules/muscle/asset/collision/bone_field.hpp"
#include "tests/modules/muscle/content/scratch_content.hpp"

namespace fascicle::muscle {
namespace {

namespace fs = std::filesystem;

class BoneFieldStore : public testing::Test {
 protected:
  BoneFieldStore() : file_(folder_.write("legs.character.json", test::kLegs)), store_(bone_field_store_of(file_)) {
    folder_.write("shapes.gltf", test::kShapes);
  }

  std::shared_ptr<const CharacterAsset> load(LoadOptions options = {}) {
    options.fit = FitMode::kNone;
    const auto character = load_character(file_, options);
    EXPECT_TRUE(character.ok()) << to_text(character.diagnostics());
    return character ? *character : nullptr;
  }

  test::ScratchFolder folder_;
  fs::path file_, store_;
};

const BoneField& block_of(const CharacterAsset& character) {
  return *character.bone_fields.at(static_cast<std::size_t>(character.bone_meshes.at(0).bone));
}

// A point of the skeleton's pelvis whose distance is known: the corner of the block lies at 0, 0.1, 0.
void expect_block(const CharacterAsset& character) {
  ASSERT_EQ(character.bone_fields.size(), character.skeleton->names.size());
  for (std::size_t bone = 0; bone < character.bone_fields.size(); ++bone) {
    EXPECT_EQ(character.bone_fields[bone] != nullptr, character.skeleton->names[bone] == "pelvis");
    if (!character.bone_fields[bone]) continue;
    EXPECT_NEAR(character.bone_fields[bone]->distance({0.05f, 0.13f, -0.004f}), 0.004f, 1e-5f);
    EXPECT_NEAR(character.bone_fields[bone]->distance({0.05f, 0.12f, 0.006f}), -0.006f, 1e-5f);
  }
}

TEST_F(BoneFieldStore, LiesBesideTheCharacterFile) {
  EXPECT_EQ(bone_field_store_of("a/walker.character.json"), fs::path("a/walker.bones.vdb"));
  EXPECT_EQ(bone_field_store_of("walker.json"), fs::path("walker.bones.vdb"));
}

TEST_F(BoneFieldStore, ALoadMakesFieldsAndKeepsThem) {
  const auto first = load();
  ASSERT_NE(first, nullptr);
  expect_block(*first);
  EXPECT_TRUE(fs::exists(store_));
  for (const fs::path& file : first->files) EXPECT_NE(file.extension(), ".vdb");  // nothing to be watched
  CharacterAsset again = *first;
  Diagnostics diagnostics;
  EXPECT_EQ(load_bone_fields(file_, again, diagnostics), 0u);
  expect_block(again);
  EXPECT_EQ(load_bone_fields(file_, again, diagnostics, /*rebuild=*/true), 1u);
  expect_block(again);
  EXPECT_TRUE(diagnostics.errors.empty() && diagnostics.warnings.empty());
}

TEST_F(BoneFieldStore, WhoNeedsNoneGetsNone) {
  const auto character = load({.bone_fields = false});
  ASSERT_NE(character, nullptr);
  EXPECT_TRUE(character->bone_fields.empty());
  EXPECT_FALSE(fs::exists(store_));
}

TEST_F(BoneFieldStore, BrokenOrOutdatedIsMadeAgain) {
  const auto character = load();
  ASSERT_NE(character, nullptr);
  CharacterAsset asset = *character;
  Diagnostics diagnostics;
  const std::string whole = *read_text_file(store_);
  for (const std::string& broken : {std::string(), std::string("garbage"), whole.substr(0, whole.size() / 2)}) {
    std::ofstream(store_, std::ios::binary | std::ios::trunc) << broken;
    EXPECT_EQ(load_bone_fields(file_, asset, diagnostics), 1u);
    expect_block(asset);
    EXPECT_EQ(load_bone_fields(file_, asset, diagnostics), 0u);  // and mended
  }
  asset.bone_meshes[0].transform[3][1] += 0.01f;  // the author moves the mesh
  EXPECT_EQ(load_bone_fields(file_, asset, diagnostics), 1u);
  EXPECT_NEAR(block_of(asset).distance({0.05f, 0.14f, -0.004f}), 0.004f, 1e-5f);
  asset.collision.settings.bone_voxel = 0.004f;
  EXPECT_EQ(load_bone_fields(file_, asset, diagnostics), 1u);
  EXPECT_EQ(block_of(asset).voxel(), 0.004f);
  EXPECT_TRUE(diagnostics.errors.empty() && diagnostics.warnings.empty());
}

TEST_F(BoneFieldStore, WhereItCannotBeWrittenFieldsAreMadeEachTime) {
  fs::create_directories(store_ / "in the way");
  for (int i = 0; i < 2; ++i) {
    const auto character = load_character(file_, {.fit = FitMode::kNone});
    ASSERT_TRUE(character.ok());
    for (const Diagnostic& warning : character.diagnostics().warnings) {
      EXPECT_EQ(to_string(warning).find("bones"), std::string::npos) << to_string(warning);
    }
    expect_block(**character);
  }
}

TEST_F(BoneFieldStore, ABoneTooLargeForItsVoxelsIsToldAndHasNone) {
  CharacterAsset asset = *load({.bone_fields = false});
  asset.collision.settings.bone_voxel = 1e-6f;
  Diagnostics diagnostics;
  EXPECT_EQ(load_bone_fields(file_, asset, diagnostics), 0u);
  ASSERT_EQ(diagnostics.warnings.size(), 1u);
  EXPECT_NE(diagnostics.warnings[0].cause.find("'pelvis'"), std::string::npos);
  EXPECT_EQ(diagnostics.warnings[0].file, file_.string());
  for (const auto& field : asset.bone_fields) EXPECT_EQ(field, nullptr);
}

TEST_F(BoneFieldStore, MeshesOfABoneAreOneField) {
  CharacterAsset asset = *load({.bone_fields = false});
  BoneMesh second = asset.bone_meshes[0];
  second.transform[3][2] += 0.5f;
  asset.bone_meshes.push_back(second);
  Diagnostics diagnostics;
  EXPECT_EQ(load_bone_fields(file_, asset, diagnostics), 1u);
  expect_block(asset);
  EXPECT_NEAR(block_of(asset).distance({0.05f, 0.13f, 0.496f}), 0.004f, 1e-5f);
}

}  // namespace
}  // namespace fascicle::muscle
