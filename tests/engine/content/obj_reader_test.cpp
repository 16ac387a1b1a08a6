#include "engine/content/obj_reader.hpp"

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

const std::string kSquare = R"(# a square and a triangle
mtllib square.mtl
o square
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 2 0 1
vt 0.5 0.5
vn 0 0 1
usemtl red
s off
f 1 2 3 4
f 2 5 3
)";

Result<TriangleMesh> parse(const std::string& text) { return parse_obj(text, "f.obj"); }

TEST(ObjReader, BrokenFilesAreNamedWithLineCauseAndRemedy) {
  const Broken cases[] = {
      {"", "f.obj: no triangles; is it a surface mesh?"},
      {with(kSquare, "v 1 1 0", "v 1 1"), "f.obj:6:6: a vertex with 2 coordinates; write v X Y Z"},
      {with(kSquare, "v 1 1 0", "v"), "f.obj:6:2: a vertex with 0 coordinates"},
      {with(kSquare, "v 1 1 0", "v 1 y 0"), "f.obj:6:5: 'y' is not a number; write v X Y Z"},
      {with(kSquare, "v 1 1 0", "v 1 nan 0"), "f.obj:6:5: 'nan' is not finite"},
      {with(kSquare, "v 1 1 0", "v 1 1e60 0"), "f.obj:6:5: '1e60' is not finite"},
      {with(kSquare, "f 2 5 3", "f 2 6 3"),
       "f.obj:14:5: '6', but 5 vertices stand before it; vertices count from 1, or backwards from -1"},
      {with(kSquare, "f 2 5 3", "f 2 0 3"), "f.obj:14:5: '0', but 5 vertices stand before it"},
      {with(kSquare, "f 2 5 3", "f 2 -6/1 3"), "f.obj:14:5: '-6', but 5 vertices"},
      {with(kSquare, "f 2 5 3", "f 2 99999999999999999999 3"), "'99999999999999999999', but 5 vertices"},
      {with(kSquare, "f 2 5 3", "f 2 x 3"),
       "f.obj:14:5: 'x' is not the number of a vertex; write V, V/T, V//N or V/T/N"},
      {with(kSquare, "f 2 5 3", "f 2 /1 3"), "f.obj:14:5: '/1' is not the number of a vertex"},
      {with(kSquare, "f 2 5 3", "f 2 1.5 3"), "'1.5' is not the number of a vertex"},
      {with(kSquare, "f 2 5 3", "f 2 5"), "a face with 2 corners; a face has three or more"},
      {with(kSquare, "f 2 5 3", "f"), "a face with 0 corners"},
      {"f 1 2 3\n" + kSquare, "f.obj:1:3: '1', but 0 vertices stand before it"},
  };
  test::expect_messages(cases, parse);
}

TEST(ObjReader, AllErrorsAreTold) {
  const Result<TriangleMesh> mesh = parse(with(with(kSquare, "v 1 1 0", "v x y 0"), "f 2 5 3", "f 9 8 3"));
  EXPECT_EQ(mesh.diagnostics().errors.size(), 4u);
}

TEST(ObjReader, CutFilesAreSurvived) { test::expect_cuts_are_survived(kSquare, parse); }

TEST(ObjReader, PolygonsBecomeFans) {
  const Result<TriangleMesh> mesh = parse_obj(kSquare, "folder/square.obj");
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_EQ(mesh->name, "square");
  EXPECT_EQ(mesh->positions.size(), 5u);
  EXPECT_EQ(mesh->positions[4], glm::vec3(2, 0, 1));
  EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2, 0, 2, 3, 1, 4, 2));
  EXPECT_TRUE(mesh->normals.empty());
  EXPECT_TRUE(mesh.diagnostics().warnings.empty());
}

TEST(ObjReader, CornersCanBeWrittenInManyWays) {
  for (const char* face : {"f 2/1/1 5/1/1 3/1/1", "f 2//1 5//1 3//1", "f 2/1 5/1 3/1", "f -4 -1 -3", "f 2 5 3 # end",
                           "f 2 \\\n 5 3", "f\t2  5\t3  "}) {
    const Result<TriangleMesh> mesh = parse(with(kSquare, "f 2 5 3", face));
    ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
    EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2, 0, 2, 3, 1, 4, 2)) << face;
  }
}

TEST(ObjReader, CurvesAreLeftOutWithAWarning) {
  const Result<TriangleMesh> mesh = parse(kSquare + "cstype bezier\ncurv 0 1 1 2 3\nend\n");
  ASSERT_TRUE(mesh.ok());
  EXPECT_THAT(to_text(mesh.diagnostics()), HasSubstr("f.obj:16:1: curves and curved surfaces are left out"));
}

TEST(ObjReader, SeedsOfTheFuzzer) {
  test::expect_seeds_are_tetrahedra("fuzz_obj_reader", {"tetrahedron.obj", "variants.obj"}, read_obj);
}

}  // namespace
}  // namespace fascicle
