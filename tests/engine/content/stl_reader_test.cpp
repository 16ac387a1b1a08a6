#include "engine/content/stl_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/engine/content/mesh_file_cases.hpp"

namespace fascicle {
namespace {

using test::Broken;
using test::with;
using testing::ElementsAre;

const std::string kTwo = R"(solid two triangles
 facet normal 0 0 1
  outer loop
   vertex 0 0 0
   vertex 1 0 0
   vertex 0 1 0
  endloop
 endfacet
 facet normal 0 0 0
  outer loop
   vertex 0 0 1
   vertex 1 0 1
   vertex 0 1 1
  endloop
 endfacet
endsolid two triangles
)";

std::string binary_two(const std::string& begin = "") {
  const auto order = std::endian::little;
  std::string text = begin + std::string(80 - begin.size(), ' ') + test::bytes_of<std::uint32_t>({2}, order);
  for (const float z : {0.0f, 1.0f})
    text += test::bytes_of<float>({0, 0, 1, 0, 0, z, 1, 0, z, 0, 1, z}, order) + std::string(2, '\0');
  return text;
}

Result<TriangleMesh> parse(const std::string& text) { return parse_stl(text, "f.stl"); }

TEST(StlReader, BrokenFilesAreNamedWithPlaceCauseAndRemedy) {
  const std::string binary = binary_two();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Broken cases[] = {
      {"", "f.stl: byte 0: 0 bytes are no .stl; is it complete?"},
      {"binary", "f.stl: byte 6: 6 bytes are no .stl"},
      {"solid", "f.stl:1:6: the file ends where 'facet' or 'endsolid' should be; is it complete?"},
      {"solid a\nendsolid a\n", "f.stl: no triangles; is it a surface mesh?"},
      {with(kTwo, " facet normal 0 0 1", " face"), "f.stl:2:2: 'face' where 'facet' or 'endsolid' should be"},
      {with(kTwo, "outer loop", "loop"), "f.stl:3:3: 'loop' where 'outer' should be; see the lines before it"},
      {with(kTwo, "vertex 1 0 0", "vertex 1 0"), "f.stl:6:4: 'vertex' is not a number; write a number"},
      {with(kTwo, "vertex 1 0 0", "vertex 1 nan 0"), "f.stl:5:13: a coordinate is nan"},
      {with(kTwo, "   vertex 1 0 0\n", ""), "f.stl:6:3: a facet with 2 corners; a facet has three"},
      {with(kTwo, "  endloop\n", ""), "f.stl:7:2: 'endfacet' where 'vertex' or 'endloop' should be"},
      {with(kTwo, "endsolid two triangles\n", ""), "f.stl:16:1: the file ends where 'facet' or 'endsolid' should be"},
      {with(binary, test::bytes_of<std::uint32_t>({2}, std::endian::little),
            test::bytes_of<std::uint32_t>({4000000000u}, std::endian::little)),
       "f.stl: byte 80: 4000000000 triangles take 200000000084 bytes, but the file has 184; is it complete?"},
      {binary + "x", "f.stl: byte 80: 2 triangles take 184 bytes, but the file has 185"},
      {binary.substr(0, 90), "byte 80: 2 triangles take 184 bytes, but the file has 90"},
      {binary.substr(0, 84 + 12) + test::bytes_of<float>({nan}, std::endian::little) + binary.substr(100),
       "f.stl: byte 96: a coordinate is nan; coordinates are finite, and smaller than 1e38"},
  };
  test::expect_messages(cases, parse);
}

TEST(StlReader, CutFilesAreSurvived) {
  test::expect_cuts_are_survived(kTwo, parse);
  test::expect_cuts_are_survived(binary_two(), parse);
}

TEST(StlReader, TrianglesHaveTheirOwnVerticesInBothEncodings) {
  std::string capitals = kTwo;
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const std::string second = "solid b" + kTwo.substr(kTwo.find("\n facet normal 0 0 0"));
  const std::string joined = kTwo.substr(0, kTwo.find(" facet normal 0 0 0")) + "endsolid\n" + second;
  for (const std::string& text : {kTwo, capitals, joined, binary_two(), binary_two("solid whatever")}) {
    const Result<TriangleMesh> mesh = parse_stl(text, "folder/two.stl");
    ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
    EXPECT_EQ(mesh->name, "two");
    EXPECT_THAT(mesh->positions, ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0),
                                             glm::vec3(0, 0, 1), glm::vec3(1, 0, 1), glm::vec3(0, 1, 1)));
    EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2, 3, 4, 5));
  }
}

TEST(StlReader, FilesThatVtkWrote) {
  test::expect_seeds_are_tetrahedra("fuzz_stl_reader", {"ascii.stl", "binary.stl"}, read_stl);
}

}  // namespace
}  // namespace fascicle
