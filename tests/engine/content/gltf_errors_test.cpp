// Broken glTF files, each with the message that it must give.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "engine/content/gltf_reader.hpp"
#include "tests/engine/content/gltf_builder.hpp"
#include "tests/engine/content/temporary_folder.hpp"

namespace fascicle {
namespace {

using test::GltfBuilder;
using testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// The arrays of a skinned, animated triangle, to be spoilt one at a time.
struct Triangle {
  std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::vector<std::uint16_t> indices = {0, 1, 2};
  std::vector<std::uint8_t> joints = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
  std::vector<float> weights = {1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0};
  std::vector<float> binds = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                              1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::vector<float> times = {0, 1};
  std::vector<float> rotations = {0, 0, 0, 1, 0, 0, 1, 0};

  GltfBuilder build() const {
    GltfBuilder builder;
    builder.vec3(positions);                                                                        // 0
    builder.indices(indices);                                                                       // 1
    builder.accessor(builder.view(joints), GltfBuilder::kUnsignedByte, joints.size() / 4, "VEC4");  // 2
    builder.vec4(weights);                                                                          // 3
    builder.mat4(binds);                                                                            // 4
    builder.scalars(times);                                                                         // 5
    builder.vec4(rotations);                                                                        // 6
    builder.section(
        "meshes",
        R"([{"name": "tri", "primitives": [{)"
        R"("attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 1}]}])");
    builder.section("nodes",
                    R"([{"name": "root", "children": [1]}, {"name": "tip"}, {"name": "body", "mesh": 0, "skin": 0}])");
    builder.section("skins", R"([{"joints": [0, 1], "inverseBindMatrices": 4}])");
    builder.section(
        "animations",
        R"([{"name": "turn", "samplers": [{"input": 5, "output": 6}], )"
        R"("channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}])");
    return builder;
  }
};

Result<GltfFile> parse(const std::string& text) { return parse_gltf(test::as_bytes(text), {}, "f.gltf"); }

TEST(GltfErrors, TheUnspoiltTriangleIsRead) {
  const Result<GltfFile> file = parse(Triangle().build().gltf());
  ASSERT_TRUE(file.ok()) << to_text(file.diagnostics());
  EXPECT_TRUE(parse(Triangle().build().glb()).ok());
  EXPECT_EQ(file->meshes.size(), 1u);
  EXPECT_EQ(file->clips.size(), 1u);
}

struct Replacement {
  std::string find, with;
  std::string message;
};

TEST(GltfErrors, BrokenDocumentsAreNamedWithPathCauseAndRemedy) {
  const Replacement cases[] = {
      {"{\"asset\"", "{asset", "f.gltf:1:2: 'asset' where a member's name is wanted"},
      {"\"2.0\"", "\"1.0\"", "/asset/version: glTF version '1.0'; export as glTF 2.0"},
      {"{\"version\": \"2.0\"}", "{}", "f.gltf:1:11: /asset: 'version' is missing; add \"version\""},
      {"{\"asset\"", "{\"extensionsRequired\": [\"KHR_draco_mesh_compression\"], \"asset\"",
       "/extensionsRequired/0: the extension KHR_draco_mesh_compression is not supported; export without it"},
      {"octet-stream", "pdf", "/buffers/0/uri: a data URI that starts with 'data:application/pdf'"},
      {"base64,", "base64,*", "/buffers/0/uri: characters in the data URI that are not base64"},
      {"base64,", "base64,AAAA", "/buffers/0: byteLength is 272, but there are 275 bytes; correct byteLength"},
      {"data:application/octet-stream;base64,", "other.bin", "/buffers/0/uri: the buffer is in a file of its own"},
      {"\"buffer\": 0", "\"buffer\": 1",
       "f.gltf:4:14: /bufferViews/0/buffer: 1 is not an index into buffers; there are 1"},
      {"\"byteOffset\": 0, \"byteLength\": 36", "\"byteOffset\": 280, \"byteLength\": 36",
       "/bufferViews/0: bytes 280 to 316 of buffer 0, which has 272"},
      {"\"byteLength\": 36", "\"byteLength\": -36",
       "/bufferViews/0/byteLength: -36 is out of range; write a number between 1 and"},
      {"\"byteLength\": 36", "\"byteLength\": 36, \"byteStride\": 300",
       "/bufferViews/0/byteStride: 300 is out of range"},
      {"\"byteLength\": 36", "\"byteLength\": 36, \"byteStride\": 8",
       "/bufferViews/0: byteStride 8 is smaller than an element of 12 bytes"},
      {"\"bufferView\": 0", "\"bufferView\": 99",
       "f.gltf:12:18: /accessors/0/bufferView: 99 is not an index into bufferViews"},
      {"\"bufferView\": 0", "\"bufferView\": 1.0",
       "/accessors/0/bufferView: 1.0 is not a whole number; write it in digits only"},
      {"\"count\": 3, \"type\": \"VEC3\"", "\"count\": 4, \"type\": \"VEC3\"",
       "f.gltf:12:3: /accessors/0: 4 elements of 12 bytes every 12 from byte 0 reach beyond buffer view 0 of 36 bytes"},
      {"\"count\": 3, \"type\": \"VEC3\"", "\"count\": 3, \"type\": \"VEC3\", \"byteOffset\": 4",
       "reach beyond buffer view 0"},
      {"\"count\": 3, \"type\": \"VEC3\"", "\"count\": 4294967295, \"type\": \"VEC3\"",
       "/accessors/0: more than 33554432 elements in all"},
      {"\"count\": 3, \"type\": \"VEC3\"", "\"count\": 0, \"type\": \"VEC3\"", "/accessors/0/count: 0 is out of range"},
      {"\"type\": \"VEC3\"", "\"type\": \"vec3\"", "/accessors/0/type: unknown value 'vec3'; did you mean 'VEC3'?"},
      {"\"type\": \"VEC3\"", "\"type\": \"VEC2\"",
       "/accessors/0: type is not VEC3, which /meshes/0/primitives/0/attributes/POSITION needs"},
      {"\"componentType\": 5123", "\"componentType\": 5126",
       "/accessors/1: componentType 5126 cannot serve /meshes/0/primitives/0/indices"},
      {"\"componentType\": 5121", "\"componentType\": 5120",
       "/accessors/2: componentType 5120 cannot serve /meshes/0/primitives/0/attributes/JOINTS_0"},
      {"\"componentType\": 5121", "\"componentType\": 99", "/accessors/2/componentType: 99 is out of range"},
      {"\"POSITION\": 0, ", "", "/meshes/0/primitives/0/attributes: no POSITION"},
      {"\"POSITION\": 0", "\"POSITION\": 42",
       "/meshes/0/primitives/0/attributes/POSITION: 42 is not an index into accessors"},
      {", \"WEIGHTS_0\": 3", "", "/meshes/0/primitives/0/attributes: JOINTS_0 without WEIGHTS_0"},
      {", \"JOINTS_0\": 2, \"WEIGHTS_0\": 3", "", "/meshes/0: node 2 skins it, but it lacks JOINTS_0 and WEIGHTS_0"},
      {"\"WEIGHTS_0\": 3", "\"WEIGHTS_0\": 6",
       "/meshes/0/primitives/0/attributes/WEIGHTS_0: 2 elements for 3 positions"},
      {"\"children\": [1]", "\"children\": [7]",
       "/nodes/0/children/0: 7 is not an index into nodes; there are 3, counted from 0"},
      {"\"children\": [1]", "\"children\": [0]", "/nodes/0: the node is, through its children, its own ancestor"},
      {"{\"name\": \"tip\"}", "{\"name\": \"tip\", \"children\": [0]}",
       "/nodes/1: the node is, through its children, its own ancestor"},
      {"{\"name\": \"tip\"}", "{\"name\": \"tip\", \"children\": [1]}",
       "/nodes/1/children/0: node 1 is a child of node 0 already"},
      {"{\"name\": \"tip\"}", "{\"name\": \"tip\", \"rotation\": [0, 0, 0, 3]}",
       "/nodes/1/rotation: a quaternion of length 3"},
      {"{\"name\": \"tip\"}", "{\"name\": \"tip\", \"scale\": [1, 1]}", "/nodes/1/scale: 2 elements; write exactly 3"},
      {"{\"name\": \"tip\"}", "{\"name\": \"tip\", \"translation\": [0, null, 0]}",
       "/nodes/1/translation/1: null where a number is wanted"},
      {"{\"name\": \"tip\"}", "{\"name\": 5}", "/nodes/1/name: the number 5 where a string is wanted"},
      {"{\"name\": \"tip\"}",
       "{\"name\": \"tip\", \"scale\": [1e30, 1, 1], \"children\": [2]}, {\"scale\": [1e30, 1, 1]}",
       "/nodes/2: the transforms down to this node grow beyond all numbers"},
      {"{\"name\": \"tip\"}", "{\"matrix\": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]}",
       "/nodes/1/matrix: the last row is not 0, 0, 0, 1"},
      {"\"joints\": [0, 1]", "\"joints\": [0]",
       "/meshes/0: a vertex follows joint 1, but skin 0 has 1; correct JOINTS_0"},
      {"\"joints\": [0, 1]", "\"joints\": []", "/skins/0/joints: no joints"},
      {"\"joints\": [0, 1]", "\"joints\": [0, 1, 2]",
       "/skins/0/inverseBindMatrices: 2 matrices for 3 joints; store one a joint"},
      {"\"joints\": [0, 1]", "\"joints\": [0, -1]", "/skins/0/joints/1: -1 is out of range"},
      {"\"inverseBindMatrices\": 4", "\"inverseBindMatrices\": 3", "/accessors/3: type is not MAT4"},
      {"\"input\": 5", "\"input\": 6", "/accessors/6: type is not SCALAR, which /animations/0/samplers/0/input needs"},
      {"\"output\": 6", "\"output\": 3", "/animations/0/samplers/0/output: 3 values for 2 keys; store 2"},
      {"\"output\": 6", "\"output\": 6, \"interpolation\": \"CUBICSPLINE\"",
       "/animations/0/samplers/0/output: 2 values for 2 keys; store 6"},
      {"\"output\": 6", "\"output\": 6, \"interpolation\": \"Linear\"",
       "/animations/0/samplers/0/interpolation: unknown value 'Linear'"},
      {"\"sampler\": 0", "\"sampler\": 3",
       "/animations/0/channels/0/sampler: 3 is not an index into samplers; there are 1"},
      {"\"path\": \"rotation\"", "\"path\": \"translation\"", "/accessors/6: type is not VEC3"},
      {"\"node\": 1, ", "\"node\": 9, ", "/animations/0/channels/0/target/node: 9 is not an index into nodes"},
      {"\"path\": \"rotation\"}}",
       "\"path\": \"rotation\"}}, {\"sampler\": 0, \"target\": {\"node\": 1, \"path\": \"rotation\"}}",
       "/animations/0/channels/1/target: the rotation of node 1 is moved by another channel already"},
      {"\"nodes\": [", "\"nodes\": {}, \"x\": [", "/nodes: an object where an array is wanted"},
      {"{\"name\": \"root\"", "7, {\"name\": \"root\"", "/nodes/0: the number 7 where an object is wanted"},
      {"\"primitives\": [", "\"primitives\": 3, \"x\": [",
       "/meshes/0/primitives: the number 3 where an array is wanted"},
  };
  const std::string good = Triangle().build().gltf();
  for (const Replacement& c : cases) {
    const std::size_t at = good.find(c.find);
    ASSERT_NE(at, std::string::npos) << c.find;
    const Result<GltfFile> result = parse(std::string(good).replace(at, c.find.size(), c.with));
    ASSERT_FALSE(result.ok()) << c.message;
    EXPECT_THAT(to_text(result.diagnostics()), HasSubstr(c.message));
  }
}

struct Spoilt {
  void (*spoil)(Triangle&);
  std::string message;
};

TEST(GltfErrors, BrokenNumbersAreNamed) {
  const Spoilt cases[] = {
      {[](Triangle& t) { t.positions[4] = kNan; }, "/accessors/0: element 1 holds nan; write finite numbers"},
      {[](Triangle& t) { t.indices[2] = 3; }, "/accessors/1: index 2 is 3, but /meshes/0/primitives/0 has 3 vertices"},
      {[](Triangle& t) { t.indices.push_back(0); }, "/meshes/0/primitives/0: 4 corners make no whole triangles"},
      {[](Triangle& t) { t.joints[4] = 200; }, "/meshes/0: a vertex follows joint 200, but skin 0 has 2"},
      {[](Triangle& t) { t.weights[1] = -0.5f; },
       "/meshes/0/primitives/0/attributes/WEIGHTS_0: vertex 0 has the weight -0.5"},
      {[](Triangle& t) { t.binds[3] = std::numeric_limits<float>::infinity(); }, "/accessors/4: element 0 holds inf"},
      {[](Triangle& t) {
         t.times = {1, 1};
       },
       "/accessors/5: time 1 is 1 s, after 1 s; times of keys are not negative and rise"},
      {[](Triangle& t) {
         t.times = {-1, 1};
       },
       "/accessors/5: time 0 is -1 s"},
      {[](Triangle& t) { t.rotations[3] = 0; }, "/accessors/6: element 0 is a quaternion of length 0"},
  };
  for (const Spoilt& c : cases) {
    Triangle triangle;
    c.spoil(triangle);
    for (const std::string& text : {triangle.build().gltf(), triangle.build().glb()}) {
      const Result<GltfFile> result = parse(text);
      ASSERT_FALSE(result.ok()) << c.message;
      EXPECT_THAT(to_text(result.diagnostics()), HasSubstr(c.message));
    }
  }
}

TEST(GltfErrors, BrokenContainersAreNamed) {
  const std::string glb = Triangle().build().glb();
  const auto with = [&](std::size_t at, std::string part) { return std::string(glb).replace(at, part.size(), part); };
  const std::pair<std::string, std::string> cases[] = {
      {"", "f.gltf:1:1: the file is empty"},
      {"glTF", "a .glb of 4 bytes has no room for its header"},
      {with(4, GltfBuilder::u32(1)), "f.gltf: glb version 1; export as glTF 2.0"},
      {glb.substr(0, glb.size() - 4),
       fmt::format("the header promises {} bytes, the file has {}", glb.size(), glb.size() - 4)},
      {with(12, GltfBuilder::u32(1u << 30)), "a chunk of 1073741824 bytes at byte 12 reaches beyond the file's"},
      {with(16, "XXXX"), "the first chunk is not JSON"},
      {with(20, "?"), "f.gltf: '?' where a value is wanted"},
      {"\x7f"
       "ELF rubbish",
       "f.gltf:1:1: '\x7f' where a value is wanted"},
      {GltfBuilder::pack(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":100}]})", "abcd"),
       "f.gltf: /buffers/0: byteLength is 100, but the BIN chunk has 4 bytes"},
      {R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":100}]})", "f.gltf:1:39: /buffers/0: no uri"},
  };
  for (const auto& [text, message] : cases) {
    const Result<GltfFile> result = parse(text);
    ASSERT_FALSE(result.ok()) << message;
    EXPECT_THAT(to_text(result.diagnostics()), HasSubstr(message));
  }
}

TEST(GltfErrors, SparseAccessorsAreChecked) {
  const auto build = [](std::uint16_t index, std::size_t count, int type) {
    GltfBuilder builder;
    const int base = builder.view(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int indices = builder.view(std::vector<std::uint16_t>{index});
    const int values = builder.view(std::vector<float>{5, 6, 7});
    builder.accessor(
        base, GltfBuilder::kFloat, 3, "VEC3",
        fmt::format(
            R"(, "sparse": {{"count": {}, "indices": {{"bufferView": {}, "componentType": {}}}, )"
             R"("values": {{"bufferView": {}}}}})",
            count, indices, type, values));
    builder.section("meshes", R"([{"primitives": [{"attributes": {"POSITION": 0}}]}])");
    builder.section("nodes", R"([{"mesh": 0}])");
    return builder.gltf();
  };
  EXPECT_TRUE(parse(build(1, 1, GltfBuilder::kUnsignedShort)).ok());
  EXPECT_THAT(to_text(parse(build(3, 1, GltfBuilder::kUnsignedShort)).diagnostics()),
              HasSubstr("/accessors/0/sparse/indices: index 0 is 3, but the accessor has 3 elements"));
  EXPECT_THAT(
      to_text(parse(build(1, 2, GltfBuilder::kUnsignedShort)).diagnostics()),
      HasSubstr("/accessors/0/sparse/indices: 2 elements of 2 bytes every 2 from byte 0 reach beyond buffer view 1"));
  EXPECT_THAT(to_text(parse(build(1, 9, GltfBuilder::kUnsignedShort)).diagnostics()),
              HasSubstr("/accessors/0/sparse: count 9 is above the accessor's 3"));
  EXPECT_THAT(to_text(parse(build(1, 1, GltfBuilder::kFloat)).diagnostics()),
              HasSubstr("/accessors/0/sparse/indices: componentType 5126"));
}

TEST(GltfErrors, ManyFaultsAreFoundInOneGo) {
  std::string text = Triangle().build().gltf();
  for (const auto& [find, with] : {std::pair<std::string, std::string>{"\"buffer\": 0", "\"buffer\": 5"},
                                   {"\"type\": \"VEC3\"", "\"type\": \"VEC5\""},
                                   {"\"children\": [1]", "\"children\": [9]"}}) {
    text.replace(text.find(find), find.size(), with);
  }
  EXPECT_EQ(parse(text).diagnostics().errors.size(), 3u);
}

TEST(GltfErrors, BuffersInFilesAreChecked) {
  const test::TemporaryFolder folder;
  const GltfBuilder builder = Triangle().build();
  test::write_in_place(folder / "a.gltf", builder.gltf_with_uri("my%20data.bin"));
  EXPECT_THAT(to_text(read_gltf(folder / "a.gltf").diagnostics()),
              HasSubstr("/buffers/0/uri: no file " + (folder / "my data.bin").string()));
  test::write_in_place(folder / "my data.bin", builder.bytes().substr(1));
  EXPECT_THAT(to_text(read_gltf(folder / "a.gltf").diagnostics()),
              HasSubstr("/buffers/0: byteLength is 272, but there are 271 bytes"));
  test::write_in_place(folder / "my data.bin", builder.bytes());
  const Result<GltfFile> file = read_gltf(folder / "a.gltf");
  EXPECT_TRUE(file.ok()) << to_text(file.diagnostics());
  EXPECT_THAT(to_text(read_gltf(folder / "none.glb").diagnostics()), HasSubstr("no such file"));
}

}  // namespace
}  // namespace fascicle
