// The file of bones' grids: what goes in comes back, and what is broken is no harm.
#include "modules/muscle/asset/bone_fields/bone_grid_file.hpp"

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "engine/content/file_text.hpp"
#include "engine/math/state_hash.hpp"
#include "tests/modules/muscle/asset/bone_fields/field_points.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

namespace fs = std::filesystem;

class BoneGridFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("fascicle_bones_" + std::to_string(std::random_device()()));
    fs::create_directories(folder_);
    file_ = folder_ / "some.bones.vdb";
  }
  void TearDown() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  static StoredBoneGrid make(const std::string& name, float radius) {
    const TriangleMesh mesh = test::make_sphere(radius, 12, 24, {0.01f, 0.02f, -0.3f});
    auto grid = build_bone_grid({&mesh, 1}, name);
    EXPECT_TRUE(grid.ok());
    return {name, hash_bone_inputs({&mesh, 1}, {}), *grid};
  }

  void write(const std::string& bytes) { std::ofstream(file_, std::ios::binary) << bytes; }
  std::string bytes() { return *read_text_file(file_); }

  fs::path folder_, file_;
};

TEST_F(BoneGridFile, MissingIsEmpty) {
  EXPECT_TRUE(read_bone_grids(file_).empty());
  EXPECT_TRUE(read_bone_grids(folder_).empty());
}

TEST_F(BoneGridFile, GridsComeBackBitForBit) {
  const std::vector<StoredBoneGrid> grids = {make("femur", 0.02f), make("tibia", 0.01f)};
  ASSERT_TRUE(write_bone_grids(file_, grids));
  const std::vector<StoredBoneGrid> back = read_bone_grids(file_);
  ASSERT_EQ(back.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back[i].bone, grids[i].bone);
    EXPECT_EQ(back[i].inputs, grids[i].inputs);
    EXPECT_EQ(back[i].grid.active_voxels(), grids[i].grid.active_voxels());
    const BoneField before = flatten(grids[i].grid), after = flatten(back[i].grid);
    EXPECT_EQ(before.lower(), after.lower());
    EXPECT_EQ(before.upper(), after.upper());
    EXPECT_EQ(before.band(), after.band());
    EXPECT_EQ(before.voxel(), after.voxel());
    EXPECT_EQ(before.brick_count(), after.brick_count());
    for (const glm::vec3& point : test::points_in_box(before.lower() - 0.05f, before.upper() + 0.05f, 20'000)) {
      const float one = before.distance(point), other = after.distance(point);
      ASSERT_EQ(std::bit_cast<std::uint32_t>(one), std::bit_cast<std::uint32_t>(other));
    }
  }
}

TEST_F(BoneGridFile, CutOffOrChangedIsEmpty) {
  const std::vector<StoredBoneGrid> grids = {make("femur", 0.01f)};
  ASSERT_TRUE(write_bone_grids(file_, grids));
  const std::string whole = bytes();
  ASSERT_EQ(read_bone_grids(file_).size(), 1u);
  for (const std::size_t length : {std::size_t{0}, std::size_t{1}, std::size_t{39}, std::size_t{40}, whole.size() / 2,
                                   whole.size() - 41, whole.size() - 1}) {
    write(whole.substr(0, length));
    EXPECT_TRUE(read_bone_grids(file_).empty()) << length;
  }
  for (std::size_t at = 0; at < whole.size(); at += whole.size() / 97 + 1) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x40);
    write(changed);
    EXPECT_TRUE(read_bone_grids(file_).empty()) << at;
  }
  write(whole + "more");
  EXPECT_TRUE(read_bone_grids(file_).empty());
  write(std::string(100'000, 'x'));
  EXPECT_TRUE(read_bone_grids(file_).empty());
  write(whole);
  EXPECT_EQ(read_bone_grids(file_).size(), 1u);
}

TEST_F(BoneGridFile, AnotherVersionIsEmpty) {
  ASSERT_TRUE(write_bone_grids(file_, std::vector<StoredBoneGrid>{make("femur", 0.01f)}));
  std::string changed = bytes();
  changed[changed.size() - 24] = static_cast<char>(changed[changed.size() - 24] + 1);  // of the seal
  write(changed);
  EXPECT_TRUE(read_bone_grids(file_).empty());
}

// As if another build of OpenVDB had written it: the seal is right, and what is under it makes no sense.
TEST_F(BoneGridFile, NonsenseUnderARightSealIsEmpty) {
  ASSERT_TRUE(write_bone_grids(file_, std::vector<StoredBoneGrid>{make("femur", 0.01f)}));
  const std::string whole = bytes();
  for (const std::string& nonsense : {std::string(5'000, 'n'), std::string(), whole.substr(0, 300)}) {
    std::string seal = whole.substr(whole.size() - 40);
    const std::uint64_t length = nonsense.size();
    StateHash hash;
    hash.add(std::span<const char>(nonsense.data(), nonsense.size()));
    const std::uint64_t value = hash.value();
    std::memcpy(seal.data() + 24, &length, 8);
    std::memcpy(seal.data() + 32, &value, 8);
    write(nonsense + seal);
    EXPECT_TRUE(read_bone_grids(file_).empty());
  }
}

TEST_F(BoneGridFile, AFolderThatCannotBeWrittenIsTold) {
  write("no folder");
  EXPECT_FALSE(write_bone_grids(file_ / "below.bones.vdb", std::vector<StoredBoneGrid>{make("femur", 0.01f)}));
}

TEST_F(BoneGridFile, TheHashTellsMeshesAndVoxelsApart) {
  const TriangleMesh mesh = test::make_sphere(0.01f, 8, 16);
  const std::uint64_t hash = hash_bone_inputs({&mesh, 1}, {});
  EXPECT_EQ(hash, hash_bone_inputs({&mesh, 1}, {}));
  EXPECT_NE(hash, hash_bone_inputs({&mesh, 1}, {.voxel = 0.001f}));
  TriangleMesh moved = mesh;
  moved.positions[5].y = std::nextafter(moved.positions[5].y, 1.0f);
  EXPECT_NE(hash, hash_bone_inputs({&moved, 1}, {}));
  TriangleMesh turned = mesh;
  std::swap(turned.indices[0], turned.indices[1]);
  EXPECT_NE(hash, hash_bone_inputs({&turned, 1}, {}));
  const std::vector<TriangleMesh> twice = {mesh, mesh};
  EXPECT_NE(hash, hash_bone_inputs(twice, {}));
}

TEST_F(BoneGridFile, WritersAtTheSameTimeLeaveAWholeFile) {
  const std::vector<StoredBoneGrid> first = {make("femur", 0.010f)}, second = {make("tibia", 0.012f)};
  ASSERT_TRUE(write_bone_grids(file_, first));
  std::thread one([&] { for (int i = 0; i < 20; ++i) EXPECT_TRUE(write_bone_grids(file_, first)); });
  std::thread two([&] { for (int i = 0; i < 20; ++i) EXPECT_TRUE(write_bone_grids(file_, second)); });
  for (int i = 0; i < 40; ++i) {
    const std::vector<StoredBoneGrid> found = read_bone_grids(file_);
    EXPECT_TRUE(found.size() == 1 && (found[0].inputs == first[0].inputs || found[0].inputs == second[0].inputs));
  }
  one.join();
  two.join();
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);  // nothing left lying about
}

}  // namespace
}  // namespace fascicle::muscle
