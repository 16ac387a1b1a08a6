#include "engine/content/mesh_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/content/gltf_builder.hpp"
#include "tests/engine/content/temporary_folder.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle {
namespace {

using test::GltfBuilder;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(MeshReference, OnlyGltfFilesHaveNames) {
  EXPECT_EQ(split_mesh_reference("a/b.glb#pelvis").file, "a/b.glb");
  EXPECT_EQ(split_mesh_reference("a/b.glb#pelvis").name, "pelvis");
  EXPECT_EQ(split_mesh_reference("b.GLTF#a").name, "a");
  EXPECT_EQ(split_mesh_reference("a#b/c.vtp").file, "a#b/c.vtp");
  EXPECT_EQ(split_mesh_reference("a#b/c.glb").file, "a#b/c.glb");
  EXPECT_EQ(split_mesh_reference("").name, "");
}

class MeshReader : public testing::Test {
 protected:
  MeshReader() {
    GltfBuilder builder;
    builder.vec3({1, 0, 0, 2, 0, 0, 1, 1, 0});
    builder.section("meshes", R"([{"name": "tri", "primitives": [{"attributes": {"POSITION": 0}}]}])");
    builder.section("nodes",
                    R"([{"name": "up", "translation": [0, 0, 5], "children": [1]}, {"name": "pelvis", "mesh": 0},
                                 {"name": "mirror", "scale": [-1, 1, 1], "mesh": 0}])");
    test::write_in_place(folder_ / "a.glb", builder.glb());
  }
  std::string file(std::string_view name) const { return (folder_ / name).string(); }

  test::TemporaryFolder folder_;
};

TEST_F(MeshReader, UnknownFormatsListWhatIsSupported) {
  EXPECT_EQ(
      to_text(read_mesh("bone.fbx").diagnostics()),
      "error: bone.fbx: unknown mesh format '.fbx'; supported are .vtk, .vtp, .obj, .ply, .stl, .glb and .gltf\n");
  EXPECT_THAT(to_text(read_mesh("none.vtp").diagnostics()), HasSubstr("none.vtp: no such file"));
  EXPECT_THAT(to_text(read_mesh("none.glb#a").diagnostics()), HasSubstr("none.glb: no such file"));
}

TEST_F(MeshReader, UnknownNamesSuggestTheClosest) {
  EXPECT_THAT(to_text(read_mesh(file("a.glb#plevis")).diagnostics()),
              HasSubstr("/meshes: no mesh named 'plevis'; did you mean 'pelvis'?"));
}

TEST_F(MeshReader, NodeTransformsAreApplied) {
  const Result<TriangleMesh> mesh = read_mesh(file("a.glb#pelvis"));
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_EQ(mesh->name, "pelvis");
  EXPECT_THAT(mesh->positions, ElementsAre(glm::vec3(1, 0, 5), glm::vec3(2, 0, 5), glm::vec3(1, 1, 5)));
  EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2));
}

TEST_F(MeshReader, AMirrorTurnsTheTriangles) {
  const Result<TriangleMesh> mesh = read_mesh(file("a.glb#mirror"));
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_THAT(mesh->positions, ElementsAre(glm::vec3(-1, 0, 0), glm::vec3(-2, 0, 0), glm::vec3(-1, 1, 0)));
  EXPECT_THAT(mesh->indices, ElementsAre(0, 2, 1));
  EXPECT_EQ(mesh->normals[0], glm::vec3(0, 0, 1));
}

TEST_F(MeshReader, WithoutANameAllAreJoined) {
  const Result<TriangleMesh> mesh = read_mesh(file("a.glb"));
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_EQ(mesh->name, "a");
  EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2, 3, 5, 4));
}

TEST_F(MeshReader, SkinnedMeshesStandAtRest) {
  GltfBuilder builder;
  builder.vec3({1, 0, 0, 2, 0, 0, 1, 1, 0});
  builder.accessor(builder.view(std::vector<std::uint8_t>(12, 0)), GltfBuilder::kUnsignedByte, 3, "VEC4");
  builder.vec4({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  builder.section("meshes", R"([{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}]}])");
  builder.section("nodes", R"([{"mesh": 0, "skin": 0, "translation": [9, 9, 9]}, {"translation": [0, 1, 0]}])");
  builder.section("skins", R"([{"joints": [1]}])");
  test::write_in_place(folder_ / "s.glb", builder.glb());
  const Result<TriangleMesh> mesh = read_mesh(file("s.glb"));
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_EQ(mesh->positions[1], glm::vec3(2, 1, 0));  // the joint counts, the node does not
}

TEST(MeshReaderData, BonesAndCharactersAreRead) {
  FASCICLE_SKIP_WITHOUT_DATA("opensim/Geometry/femur_r.vtp");
  EXPECT_TRUE(read_mesh((test::data_folder() / "opensim/Geometry/femur_r.vtp").string()).ok());
  EXPECT_TRUE(read_mesh((test::data_folder() / "gltf/CesiumMan.glb").string() + "#Cesium_Man").ok());
}

}  // namespace
}  // namespace fascicle
