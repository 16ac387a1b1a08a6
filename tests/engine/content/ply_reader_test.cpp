#include "engine/content/ply_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/engine/content/mesh_file_cases.hpp"

namespace fascicle {
namespace {

using test::Broken;
using test::with;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kSquare = R"(ply
format ascii 1.0
comment a square and a triangle
element vertex 5
property float x
property float y
property float z
property uchar red
element face 2
property list uchar int vertex_indices
end_header
0 0 0 255
1 0 0 255
1 1 0 255
0 1 0 255
2 0 1 255
4 0 1 2 3
3 1 4 2
)";

// The same with an element and a list that nobody knows.
std::string binary_square(std::endian order) {
  std::string text = "ply\nformat binary_" + std::string(order == std::endian::big ? "big" : "little") +
                     "_endian 1.0\nelement edge 1\nproperty int a\nelement vertex 5\nproperty double x\n"
                     "property list uchar float tags\nproperty double y\nproperty double z\nelement face 2\n"
                     "property list int uint vertex_index\nend_header\n";
  text += test::bytes_of<std::int32_t>({42}, order);
  const double points[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 1}};
  for (const auto& p : points) {
    text += test::bytes_of<double>({p[0]}, order) + test::bytes_of<std::uint8_t>({2}, order) +
            test::bytes_of<float>({1, 2}, order) + test::bytes_of<double>({p[1], p[2]}, order);
  }
  return text + test::bytes_of<std::int32_t>({4, 0, 1, 2, 3, 3, 1, 4, 2}, order);
}

// A list that is skipped, of single bytes.
const std::string kOneByteShort =
    "ply\nformat binary_little_endian 1.0\nelement a 1\nproperty list uchar uchar tags\nelement face 1\n"
    "property list uchar uchar vertex_index\nend_header\nTAGS";

Result<TriangleMesh> parse(const std::string& text) { return parse_ply(text, "f.ply"); }

TEST(PlyReader, BrokenFilesAreNamedWithPlaceCauseAndRemedy) {
  const std::string binary = binary_square(std::endian::little);
  const Broken cases[] = {
      {"", "f.ply:1:1: the file does not begin with 'ply'; save it as .ply"},
      {"plywood", "f.ply:1:1: the file does not begin with 'ply'"},
      {"ply\n", "f.ply:2:1: the file ends where 'end_header' should be; is it complete?"},
      {with(kSquare, "format ascii 1.0\n", ""), "no format; add 'format ascii 1.0' after the first line"},
      {with(kSquare, "ascii", "utf8"),
       "f.ply:2:8: format 'utf8'; use ascii, binary_little_endian or binary_big_endian"},
      {with(kSquare, "comment", "remark"), "f.ply:3:1: 'remark' in the header; expected format, element or property"},
      {with(kSquare, "element vertex 5", "element vertex"), "f.ply:4:15: no number of elements"},
      {with(kSquare, "element vertex 5", "element vertex -5"), "f.ply:4:16: '-5' is not a number of elements"},
      {with(kSquare, "element face 2", "element vertex 2"),
       "f.ply:9:16: element 'vertex' for the second time; keep one"},
      {with(kSquare, "element vertex 5\n", ""), "f.ply:4:1: a property before any element"},
      {with(kSquare, "float x", "quad x"), "f.ply:5:10: 'quad' is no type of numbers; write float, int or uchar"},
      {with(kSquare, "float x", "float u"),
       "f.ply:4:17: vertices without x, y and z; add 'property float x' and so on"},
      {with(kSquare, "list uchar", "list float"), "f.ply:10:15: 'float' is no type of a list's length"},
      {with(kSquare, "property list uchar int vertex_indices", "property int vertex_indices"),
       "'vertex_indices' is no list; declare it as a list"},
      {with(kSquare, "vertex 5", "vertex 1099511627776"),
       "1099511627776 elements 'vertex' do not fit into the 68 bytes that follow; correct the number"},
      {with(kSquare, "face 2", "face 3"), "f.ply:19:1: the file ends where a number should be; is it complete?"},
      {with(kSquare, "1 1 0 255", "1 y 0 255"), "f.ply:14:3: 'y' is not a number; write a number"},
      {with(kSquare, "1 1 0 255", "1 inf 0 255"), "f.ply:14:3: a coordinate is inf"},
      {with(kSquare, "3 1 4 2", "3 1 5 2"), "f.ply:18:5: number 5 of 5 vertices; write 0 to 4"},
      {with(kSquare, "3 1 4 2", "3 1 -1 2"), "f.ply:18:5: number -1 of 5 vertices"},
      {with(kSquare, "3 1 4 2", "-3 1 4 2"), "f.ply:18:1: -3 as the length of a list; write a whole number"},
      {with(kSquare, "3 1 4 2", "300 1 4 2"),
       "f.ply:18:1: 300 numbers of a list do not fit into the 7 bytes that follow"},
      {with(kSquare, "vertex_indices", "corners"), "f.ply: no triangles; is it a surface mesh?"},
      {with(kSquare, "element face 2", "element facet 2"), "f.ply: no triangles"},
      {with(binary, "vertex 5", "vertex 1099511627776"), "1099511627776 elements 'vertex' do not fit into the"},
      {binary.substr(0, binary.size() - 2), "byte 419: 3 numbers of a list do not fit into the 10 bytes that follow"},
      {with(kOneByteShort, "TAGS", "\3ab"), "byte 144: 3 numbers of a list do not fit into the 2 bytes that follow"},
      {binary.substr(0, binary.size() - 4) + test::bytes_of<std::uint32_t>({7}, std::endian::little),
       "byte 431: number 7 of 5 vertices; write 0 to 4"},
      {binary.substr(0, binary.size() - 16) + test::bytes_of<std::int32_t>({-1, 1, 4, 2}, std::endian::little),
       "-1 as the length of a list"},
  };
  test::expect_messages(cases, parse);
}

TEST(PlyReader, CutFilesAreSurvived) {
  for (const std::string& text : {kSquare, binary_square(std::endian::little), binary_square(std::endian::big)})
    test::expect_cuts_are_survived(text, parse);
}

TEST(PlyReader, PolygonsBecomeFansInAllEncodings) {
  for (const std::string& text : {kSquare, binary_square(std::endian::little), binary_square(std::endian::big),
                                  with(kSquare, "property float x", "property float64 x")}) {
    const Result<TriangleMesh> mesh = parse_ply(text, "folder/square.ply");
    ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
    EXPECT_EQ(mesh->name, "square");
    EXPECT_THAT(mesh->positions, ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0),
                                             glm::vec3(0, 1, 0), glm::vec3(2, 0, 1)));
    EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2, 0, 2, 3, 1, 4, 2));
  }
}

TEST(PlyReader, FacesBeforeVerticesAreRefused) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
      "3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_THAT(to_text(parse(text).diagnostics()),
              HasSubstr("f.ply:10:3: number 0 where there are no vertices; give the vertices first"));
}

TEST(PlyReader, StripsAreCutAtMinusOne) {
  std::string text = with(kSquare, "element face 2\nproperty list uchar int vertex_indices",
                          "element tristrips 1\nproperty list int int vertex_indices");
  const Result<TriangleMesh> mesh = parse(with(text, "4 0 1 2 3\n3 1 4 2\n", "8 0 1 2 3 -1 1 4 2\n"));
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2, 2, 1, 3, 1, 4, 2));
}

TEST(PlyReader, FilesThatVtkWrote) {
  test::expect_seeds_are_tetrahedra("fuzz_ply_reader", {"ascii.ply", "little.ply", "big.ply"}, read_ply);
}

}  // namespace
}  // namespace fascicle
