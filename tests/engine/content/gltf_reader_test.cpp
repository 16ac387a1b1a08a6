#include "engine/content/gltf_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "tests/engine/content/gltf_builder.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle {
namespace {

using test::GltfBuilder;
using testing::ElementsAre;
using testing::HasSubstr;

GltfFile parse(const std::string& text) {
  Result<GltfFile> result = parse_gltf(test::as_bytes(text), {}, "f");
  EXPECT_TRUE(result.ok()) << to_text(result.diagnostics());
  return result.ok() ? std::move(*result) : GltfFile{};
}

const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

// A file of one mesh with the given primitives on one node.
GltfFile parse_mesh(GltfBuilder builder, const std::string& primitives) {
  builder.section("meshes", R"([{"name": "m", "primitives": )" + primitives + "}]");
  builder.section("nodes", R"([{"mesh": 0}])");
  return parse(builder.gltf());
}

TEST(GltfReader, NodesComeParentsFirstWithUniqueNames) {
  GltfBuilder builder;
  builder.section("nodes", R"([{"name": "leaf"}, {"children": [3, 0]}, {"name": "leaf"},
                               {"name": "leaf", "translation": [1, 2, 3], "children": [2]}, {"name": "leaf_2"}])");
  const GltfFile file = parse(builder.gltf());
  EXPECT_THAT(file.skeleton.names, ElementsAre("node_1", "leaf", "leaf_2", "leaf_3", "leaf_2_2"));
  EXPECT_THAT(file.skeleton.parents, ElementsAre(-1, 0, 1, 0, -1));
  EXPECT_THAT(file.node_bones, ElementsAre(3, 0, 2, 1, 4));
  EXPECT_EQ(glm::vec3(file.skeleton.rest_world[2][3]), glm::vec3(1, 2, 3));
}

TEST(GltfReader, ALongChainIsNoProblem) {
  std::string nodes = "[{}";
  for (int i = 1; i < 20000; ++i) nodes += fmt::format(R"(,{{"name": "same", "children": [{}]}})", i - 1);
  GltfBuilder builder;
  builder.section("nodes", nodes + "]");
  const GltfFile file = parse(builder.gltf());
  ASSERT_EQ(file.skeleton.size(), 20000u);
  EXPECT_EQ(file.node_bones[0], 19999);
}

TEST(GltfReader, MatricesAreDecomposed) {
  GltfBuilder builder;
  // Column by column: x -> 2y, y -> -3x, z -> 4z: a quarter turn about z after scaling by 2, 3, 4.
  builder.section("nodes", R"([{"matrix": [0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1]},
                               {"matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
                               {"matrix": [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]}])");
  const GltfFile file = parse(builder.gltf());
  const Trs& trs = file.skeleton.rest_local[0];
  EXPECT_EQ(trs.translation, glm::vec3(5, 6, 7));
  EXPECT_EQ(trs.scale, glm::vec3(2, 3, 4));
  EXPECT_NEAR(trs.rotation.z, std::numbers::sqrt2 / 2, 1e-6);
  EXPECT_NEAR(trs.rotation.w, std::numbers::sqrt2 / 2, 1e-6);
  EXPECT_EQ(file.skeleton.rest_local[1].scale, glm::vec3(-1, 1, 1));  // a mirror
  EXPECT_EQ(file.skeleton.rest_world[1][0].x, -1.0f);
  EXPECT_EQ(file.skeleton.rest_local[2].scale, glm::vec3(0));
}

TEST(GltfReader, ShearIsLeftOutWithAWarning) {
  GltfBuilder builder;
  builder.section("nodes", R"([{"matrix": [1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}])");
  const Result<GltfFile> result = parse_gltf(test::as_bytes(builder.gltf()), {}, "f");
  ASSERT_TRUE(result.ok());
  EXPECT_THAT(to_text(result.diagnostics()), HasSubstr("/nodes/0/matrix: the matrix shears"));
}

TEST(GltfReader, PrimitivesOfAllTriangleModesAreJoined) {
  GltfBuilder builder;
  builder.vec3(kSquare);
  builder.indices({0, 1, 2, 3});
  builder.indices({0, 1, 3, 2});
  builder.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const GltfFile file = parse_mesh(builder, R"([{"attributes": {"POSITION": 0}, "indices": 1, "mode": 5},
      {"attributes": {"POSITION": 0}, "indices": 2, "mode": 6}, {"attributes": {"POSITION": 3}},
      {"attributes": {"POSITION": 0}, "mode": 1}])");
  ASSERT_EQ(file.meshes.size(), 1u);
  const TriangleMesh& mesh = file.meshes[0].geometry;
  EXPECT_EQ(mesh.positions.size(), 11u);
  EXPECT_THAT(mesh.indices, ElementsAre(0, 1, 2, 2, 1, 3,                              // strip
                                        4, 5, 7, 4, 7, 6,                              // fan
                                        8, 9, 10));                                    // without indices
  for (const glm::vec3& normal : mesh.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));  // computed
}

TEST(GltfReader, StripsDropTheTrianglesThatJoinThem) {
  GltfBuilder builder;
  builder.vec3(kSquare);
  builder.indices({0, 1, 2, 2, 3, 3});
  EXPECT_THAT(
      parse_mesh(builder, R"([{"attributes": {"POSITION": 0}, "indices": 1, "mode": 5}])").meshes[0].geometry.indices,
      ElementsAre(0, 1, 2));
}

TEST(GltfReader, InterleavedViewsAreRead) {
  GltfBuilder builder;
  // Position and normal of each vertex side by side.
  const int view = builder.view(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0}, 24);
  builder.accessor(view, GltfBuilder::kFloat, 3, "VEC3");
  builder.accessor(view, GltfBuilder::kFloat, 3, "VEC3", R"(, "byteOffset": 12)");
  const GltfFile file = parse_mesh(builder, R"([{"attributes": {"POSITION": 0, "NORMAL": 1}}])");
  EXPECT_THAT(file.meshes[0].geometry.positions, ElementsAre(glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
  for (const glm::vec3& normal : file.meshes[0].geometry.normals) EXPECT_EQ(normal, glm::vec3(1, 0, 0));  // made unit
}

TEST(GltfReader, SparseValuesReplaceTheirBase) {
  GltfBuilder builder;
  const int base = builder.view(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int indices = builder.view(std::vector<std::uint8_t>{0, 2});
  const int values = builder.view(std::vector<float>{0, 0, 5, 0, 6, 0});
  const std::string sparse = fmt::format(
      R"(, "sparse": {{"count": 2, "indices": {{"bufferView": {}, "componentType": 5121}}, )"
      R"("values": {{"bufferView": {}}}}})",
      indices, values);
  builder.accessor(base, GltfBuilder::kFloat, 3, "VEC3", sparse);
  builder.accessor(-1, GltfBuilder::kFloat, 3, "VEC3", sparse);  // over zeros
  const GltfFile file = parse_mesh(builder, R"([{"attributes": {"POSITION": 0}}, {"attributes": {"POSITION": 1}}])");
  EXPECT_THAT(file.meshes[0].geometry.positions, ElementsAre(glm::vec3(0, 0, 5), glm::vec3(1, 0, 0), glm::vec3(0, 6, 0),
                                                             glm::vec3(0, 0, 5), glm::vec3(0), glm::vec3(0, 6, 0)));
}

TEST(GltfReader, QuantisedAttributesAreScaled) {
  GltfBuilder builder;
  builder.accessor(builder.view(std::vector<std::int16_t>{0, 0, 0, 0, 300, 0, 0, 0, 0, -300, 0, 0}, 8),
                   GltfBuilder::kShort, 3, "VEC3");
  builder.accessor(builder.view(std::vector<std::int8_t>{0, 0, 127, 0, 0, 0, 127, 0, 0, -128, 0, 0}, 4),
                   GltfBuilder::kByte, 3, "VEC3", R"(, "normalized": true)");
  const GltfFile file = parse_mesh(builder, R"([{"attributes": {"POSITION": 0, "NORMAL": 1}}])");
  EXPECT_THAT(file.meshes[0].geometry.positions,
              ElementsAre(glm::vec3(0), glm::vec3(300, 0, 0), glm::vec3(0, -300, 0)));
  EXPECT_THAT(file.meshes[0].geometry.normals,
              ElementsAre(glm::vec3(0, 0, 1), glm::vec3(0, 0, 1), glm::vec3(0, -1, 0)));
}

// A triangle skinned to `joints` and `weights` sets of four.
GltfFile parse_skinned(const std::vector<std::vector<std::uint8_t>>& joints,
                       const std::vector<std::vector<std::uint16_t>>& weights) {
  GltfBuilder builder;
  builder.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
  std::string attributes = R"("POSITION": 0)";
  for (std::size_t set = 0; set < joints.size(); ++set) {
    const int j = builder.accessor(builder.view(joints[set]), GltfBuilder::kUnsignedByte, 3, "VEC4");
    const int w =
        builder.accessor(builder.view(weights[set]), GltfBuilder::kUnsignedShort, 3, "VEC4", R"(, "normalized": true)");
    attributes += fmt::format(R"(, "JOINTS_{0}": {1}, "WEIGHTS_{0}": {2})", set, j, w);
  }
  builder.section("meshes", R"([{"primitives": [{"attributes": {)" + attributes + "}}]}]");
  builder.section("nodes", R"([{"mesh": 0, "skin": 0}, {}, {}, {}, {}, {}, {}, {}])");
  builder.section("skins", R"([{"joints": [7, 6, 5, 4, 3, 2, 1]}])");
  return parse(builder.gltf());
}

TEST(GltfReader, IntegerWeightsAreNormalised) {
  const GltfFile file =
      parse_skinned({{1, 2, 99, 0, 3, 0, 0, 0, 4, 0, 0, 0}}, {{13107, 52428, 0, 0, 65535, 0, 0, 0, 100, 0, 0, 0}});
  const GltfMesh& mesh = file.meshes[0];
  EXPECT_EQ(mesh.joints[0], glm::u16vec4(2, 1, 0, 0));  // largest first; a joint without weight is no joint
  EXPECT_NEAR(mesh.weights[0].x, 0.8f, 1e-6f);
  EXPECT_NEAR(mesh.weights[0].y, 0.2f, 1e-6f);
  EXPECT_EQ(mesh.weights[2], glm::vec4(1, 0, 0, 0));
  EXPECT_THAT(file.skins[0].bones, ElementsAre(7, 6, 5, 4, 3, 2, 1));
  EXPECT_EQ(file.skins[0].inverse_binds[3], glm::mat4(1.0f));
}

TEST(GltfReader, TheFourLargestOfManyInfluencesAreKept) {
  const GltfFile file =
      parse_skinned({{0, 1, 2, 3, 0, 0, 0, 0, 0, 0, 0, 0}, {4, 5, 6, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
                    {{10, 60, 20, 30, 65535, 0, 0, 0, 0, 0, 0, 0}, {50, 5, 40, 0, 0, 0, 0, 0, 0, 0, 0, 0}});
  const GltfMesh& mesh = file.meshes[0];
  EXPECT_EQ(mesh.joints[0], glm::u16vec4(1, 4, 6, 3));
  EXPECT_NEAR(mesh.weights[0].x, 60.0f / 180.0f, 1e-5f);
  EXPECT_NEAR(mesh.weights[0].w, 30.0f / 180.0f, 1e-5f);
  EXPECT_EQ(mesh.weights[2], glm::vec4(1, 0, 0, 0));  // no weight at all: the first joint
}

TEST(GltfReader, OneMeshMayHangOnManyNodes) {
  GltfBuilder builder;
  builder.vec3(kSquare);
  builder.indices({0, 1, 2});
  builder.section("materials", R"([{"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.5]}}])");
  builder.section("meshes",
                  R"([{"name": "m", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}])");
  builder.section("nodes", R"([{"name": "a", "mesh": 0}, {"name": "b", "mesh": 0}])");
  const GltfFile file = parse(builder.gltf());
  ASSERT_EQ(file.meshes.size(), 2u);
  EXPECT_EQ(file.find_mesh("b"), &file.meshes[1]);
  EXPECT_EQ(file.find_mesh("m"), &file.meshes[0]);
  EXPECT_EQ(file.find_mesh("c"), nullptr);
  EXPECT_EQ(file.meshes[1].bone, 1);
  EXPECT_EQ(file.meshes[1].base_colour, glm::vec4(0.1f, 0.2f, 0.3f, 0.5f));
}

TEST(GltfReader, AnimationsOfAllKinds) {
  GltfBuilder builder;
  builder.scalars({0.5f, 1.5f});
  builder.vec3({0, 0, 0, 1, 2, 3});  // 1
  builder.accessor(builder.view(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 32767, 0}), GltfBuilder::kShort, 2,
                   "VEC4", R"(, "normalized": true)");                   // 2
  builder.vec3({0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5});  // 3: cubic
  builder.scalars({0, 1, 2});                                            // 4: morph weights
  builder.section("nodes", R"([{"name": "a"}])");
  builder.section("animations",
                  R"([{"samplers": [{"input": 0, "output": 1}, {"input": 0, "output": 2, "interpolation": "STEP"},
      {"input": 0, "output": 3, "interpolation": "CUBICSPLINE"}, {"input": 4, "output": 4}],
      "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}},
                   {"sampler": 1, "target": {"node": 0, "path": "rotation"}},
                   {"sampler": 2, "target": {"node": 0, "path": "scale"}},
                   {"sampler": 3, "target": {"node": 0, "path": "weights"}}]},
      {"name": "empty", "samplers": [], "channels": []}])");
  const GltfFile file = parse(builder.gltf());
  ASSERT_EQ(file.clips.size(), 1u);
  const Clip& clip = file.clips[0];
  EXPECT_EQ(clip.name, "animation_0");
  EXPECT_EQ(clip.start, 0.5f);
  EXPECT_EQ(clip.end, 1.5f);
  EXPECT_THAT(clip.times, ElementsAre(0.5f, 1.5f));  // shared by all channels
  ASSERT_EQ(clip.channels.size(), 3u);
  EXPECT_EQ(clip.channels[1].interpolation, ClipInterpolation::kStep);
  EXPECT_EQ(clip.values[clip.channels[1].first_value], glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(clip.channels[2].interpolation, ClipInterpolation::kCubicSpline);
  EXPECT_EQ(clip.values[clip.channels[2].first_value + 4], glm::vec4(4, 4, 4, 0));
  EXPECT_EQ(file.find_clip("animation_0"), &clip);
}

TEST(GltfReader, ImagesAreNotOpened) {
  GltfBuilder builder;
  builder.vec3(kSquare);
  builder.indices({0, 1, 2});
  builder.section("images", R"([{"uri": "absent.png"}, {"bufferView": 99, "mimeType": "image/png"}])");
  builder.section("textures", R"([{"source": 0}])");
  EXPECT_EQ(parse_mesh(builder, R"([{"attributes": {"POSITION": 0}, "indices": 1}])").meshes.size(), 1u);
}

TEST(GltfReader, CesiumManIsRead) {
  FASCICLE_SKIP_WITHOUT_DATA("gltf/CesiumMan.glb");
  const Result<GltfFile> file = read_gltf(test::data_folder() / "gltf/CesiumMan.glb");
  ASSERT_TRUE(file.ok()) << to_text(file.diagnostics());
  ASSERT_EQ(file->skins.size(), 1u);
  EXPECT_EQ(file->skins[0].bones.size(), 19u);
  ASSERT_EQ(file->meshes.size(), 1u);
  EXPECT_EQ(file->meshes[0].geometry.positions.size(), 3273u);
  EXPECT_EQ(file->meshes[0].geometry.indices.size(), 3u * 4672u);
  ASSERT_EQ(file->clips.size(), 1u);
  EXPECT_EQ(file->clips[0].channels.size(), 57u);
  EXPECT_FLOAT_EQ(file->clips[0].end, 2.0f);
  for (const glm::vec4& weight : file->meshes[0].weights)
    ASSERT_NEAR(weight.x + weight.y + weight.z + weight.w, 1.0f, 1e-5f);
}

TEST(GltfReader, RiggedSimpleIsRead) {
  FASCICLE_SKIP_WITHOUT_DATA("gltf/RiggedSimple.glb");
  const Result<GltfFile> file = read_gltf(test::data_folder() / "gltf/RiggedSimple.glb");
  ASSERT_TRUE(file.ok()) << to_text(file.diagnostics());
  EXPECT_EQ(file->skins[0].bones.size(), 4u);
  EXPECT_NE(file->find_mesh("Cylinder"), nullptr);
  EXPECT_NE(file->find_mesh("Cylinder.001"), nullptr);  // by the mesh's own name
}

}  // namespace
}  // namespace fascicle
