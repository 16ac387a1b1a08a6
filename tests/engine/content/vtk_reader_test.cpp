#include "engine/content/vtk_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/engine/content/mesh_file_cases.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle {
namespace {

using test::Broken;
using test::with;
using testing::ElementsAre;
using testing::HasSubstr;

// A square of one polygon and a triangle hanging on it.
const std::string kSquare = R"(# vtk DataFile Version 3.0
a square
ASCII
DATASET POLYDATA
POINTS 5 float
0 0 0 1 0 0
1 1 0 0 1 0
2 0 1
POLYGONS 2 9
4 0 1 2 3
3 1 4 2
)";

std::string text_of_version_5() {
  std::string text = with(kSquare, "Version 3.0", "Version 5.1");
  return with(text, "POLYGONS 2 9\n4 0 1 2 3\n3 1 4 2\n",
              "POLYGONS 3 7\nOFFSETS vtktypeint64\n0 4 7\nCONNECTIVITY vtktypeint64\n0 1 2 3 1 4 2\n");
}

std::string binary_square() {
  return "# vtk DataFile Version 4.2\n\nBINARY\nDATASET POLYDATA\nPOINTS 5 double\n" +
         test::bytes_of<double>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 1}, std::endian::big) + "\nPOLYGONS 2 9\n" +
         test::bytes_of<std::int32_t>({4, 0, 1, 2, 3, 3, 1, 4, 2}, std::endian::big) + "\n";
}

Result<TriangleMesh> parse(const std::string& text) { return parse_vtk(text, "f.vtk"); }

TEST(VtkReader, BrokenFilesAreNamedWithPlaceCauseAndRemedy) {
  const std::string five = text_of_version_5(), binary = binary_square();
  const Broken cases[] = {
      {"", "f.vtk:1:1: the first line is not '# vtk DataFile Version ...'; save it as a legacy VTK file"},
      {"<VTKFile/>", "f.vtk:1:1: the first line is not"},
      {with(kSquare, "3.0", "6.0"), "f.vtk:1:1: version '6.0'; save it in a version from 1.0 to 5.1"},
      {with(kSquare, "3.0", "x"), "version 'x'"},
      {with(kSquare, "ASCII", "TEXT"), "f.vtk:3:1: 'text' where the encoding should be; write ASCII or BINARY"},
      {with(kSquare, "POLYDATA", "UNSTRUCTURED_GRID"),
       "f.vtk:4:9: 'UNSTRUCTURED_GRID' where DATASET POLYDATA should be; save the surface as PolyData"},
      {kSquare.substr(0, 41), "where DATASET POLYDATA should be"},
      {with(kSquare, "POINTS 5", "POINTS five"), "f.vtk:5:8: 'five' is not a number of points; write a whole number"},
      {with(kSquare, "POINTS 5", "POINTS -5"), "'-5' is not a number of points"},
      {with(kSquare, "POINTS 5 float", "POINTS"), "f.vtk:5:7: no number of points"},
      {with(kSquare, "POINTS 5", "POINTS 1099511627776"),
       "f.vtk:5:8: 1099511627776 points do not fit into the 68 bytes that follow; correct the number"},
      {with(kSquare, "POINTS 5", "POINTS 99999999999999999999"), "is not a number of points"},
      {with(kSquare, "5 float", "5 complex"), "f.vtk:5:10: 'complex' is no type of numbers that is read"},
      {with(kSquare, "1 1 0", "1 x 0"), "f.vtk:7:3: 'x' is not a number; write a number"},
      {with(kSquare, "1 1 0", "1 nan 0"), "f.vtk:7:3: a coordinate is nan; coordinates are finite"},
      {with(kSquare, "1 1 0", "1 1e60 0"), "f.vtk:7:3: a coordinate is 1e+60"},
      {with(kSquare, "2 0 1\n", ""), "f.vtk:8:1: 'POLYGONS' is not a number"},
      {with(kSquare, "2 0 1\n", "2 0 1 9\n"),
       "f.vtk:8:7: '9' is no section of PolyData; expected POINTS, VERTICES, LINES, POLYGONS or TRIANGLE_STRIPS"},
      {with(kSquare, "1 4 2", "1 5 2"), "f.vtk:11:5: number 5 of 5 points; write 0 to 4"},
      {with(kSquare, "1 4 2", "1 -4 2"), "number -4 of 5 points"},
      {with(kSquare, "1 4 2", "1 1.5 2"), "number 1.5 of 5 points"},
      {with(kSquare, "3 1 4 2", "4 1 4 2"), "f.vtk:11:1: number 4 of 4 numbers left in this section"},
      {with(kSquare, "3 1 4 2", "2 1 4 2"), "2 cells leave 1 of 9 numbers over; correct the counts of the section"},
      {with(kSquare, "POLYGONS 2 9", "POLYGONS 3 9"), "2 of 3 cells use up its 9 numbers"},
      {with(kSquare, "POLYGONS 2 9", "POLYGONS 2"), "f.vtk:9:11: no number of numbers"},
      {with(kSquare, "POLYGONS 2 9", "POLYGONS 4000000000 9"),
       "f.vtk:9:10: 4000000000 cells do not fit into the 21 bytes that follow"},
      {with(kSquare, "3 1 4 2\n", "3 1"), "f.vtk:9:12: 9 numbers do not fit into the 14 bytes that follow"},
      {with(kSquare, "4 0 1 2 3\n3 1 4 2\n", "4  0  1  2   3\n3 1"),
       "f.vtk:11:4: the file ends where a number should be; is it complete?"},
      {with(kSquare, "POLYGONS", "POINTS 1 int\n0 0 0\nPOLYGONS"), "f.vtk:9:1: POINTS for the second time; keep one"},
      {kSquare + "POLYGONS 1 4\n3 0 1 2\n", "cells of one kind for the second time"},
      {with(kSquare, "POINTS 5 float\n0 0 0 1 0 0\n1 1 0 0 1 0\n2 0 1\n", ""),
       "f.vtk:6:3: number 0 where there are no points; give the points first"},
      {with(kSquare, "POLYGONS 2 9\n4 0 1 2 3\n3 1 4 2\n", ""), "f.vtk: no triangles; is it a surface mesh?"},
      {with(five, "0 4 7", "0 7 4"), "OFFSETS do not rise from 0 to 7; correct them"},
      {with(five, "0 4 7", "1 4 7"), "OFFSETS do not rise"},
      {with(five, "0 4 7", "0 4 6"), "OFFSETS do not rise"},
      {with(five, "0 4 7", "0 4 8"), "f.vtk:11:5: number 8 of 8 offsets that the section allows"},
      {with(five, "OFFSETS", "OFFS"), "f.vtk:10:1: no offsets; cells of version 5 are OFFSETS, then CONNECTIVITY"},
      {with(five, "CONNECTIVITY", "0 CONNECTIVITY"), "f.vtk:12:1: no connectivity"},
      {with(five, "3 1 4 2", "3 1 9 2"), "f.vtk:13:11: number 9 of 5 points"},
      {with(kSquare, "POINTS", "FIELD d 1\na 4611686018427387904 4 int\n1\nPOINTS"),
       "4 times 4611686018427387904 numbers do not fit into the file"},
      {with(kSquare, "POINTS", "FIELD d 1\na 2 3 string\nPOINTS"), "'string' is no type of numbers that is read"},
      {with(kSquare, "POINTS", "FIELD d 9\na 1 1 int\n7\nPOINTS"), "'float' is not a number of tuples"},
      {with(binary, "double\n", "double\n\x7f\xf8"), "byte 68: a coordinate is nan; coordinates are finite"},
      {binary.substr(0, 120), "byte 61: 5 points do not fit into the 53 bytes that follow"},
      {binary.substr(0, binary.size() - 3), "the file ends where a number should be; is it complete?"},
      {with(binary, "POINTS 5", "POINTS 1099511627776"), "1099511627776 points do not fit into the"},
  };
  test::expect_messages(cases, parse);
}

TEST(VtkReader, AllErrorsOfAnArrayAreTold) {
  const Result<TriangleMesh> mesh = parse(with(with(kSquare, "1 1 0", "x nan 0"), "2 0 1", "y z 1"));
  EXPECT_EQ(mesh.diagnostics().errors.size(), 4u);
  std::string many = "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 1000 float\n";
  for (int i = 0; i < 3000; ++i) many += "x ";
  EXPECT_THAT(parse(many).diagnostics().errors.size(), testing::AllOf(testing::Gt(19u), testing::Lt(22u)));
}

TEST(VtkReader, CutFilesAreSurvived) {
  for (const std::string& text : {kSquare, text_of_version_5(), binary_square()})
    test::expect_cuts_are_survived(text, parse);
}

TEST(VtkReader, PolygonsBecomeFansInAllEncodings) {
  for (const std::string& text : {kSquare, text_of_version_5(), binary_square(), with(kSquare, "ASCII", "ascii"),
                                  with(kSquare, "5 float", "5 DOUBLE"), with(kSquare, "a square", "")}) {
    const Result<TriangleMesh> mesh = parse_vtk(text, "folder/square.vtk");
    ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
    EXPECT_EQ(mesh->name, "square");
    EXPECT_THAT(mesh->positions, ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0),
                                             glm::vec3(0, 1, 0), glm::vec3(2, 0, 1)));
    EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2, 0, 2, 3, 1, 4, 2));
    EXPECT_TRUE(mesh.diagnostics().warnings.empty());
  }
}

TEST(VtkReader, LineEndsMayBeOfAnySystem) {
  std::string returns;
  for (const char c : kSquare) returns += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const Result<TriangleMesh> mesh = parse(returns);
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_EQ(mesh->indices.size(), 9u);
}

TEST(VtkReader, StripsTurnEveryOtherTriangle) {
  const Result<TriangleMesh> mesh = parse(with(kSquare, "POLYGONS", "TRIANGLE_STRIPS"));
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2, 2, 1, 3, 1, 4, 2));
}

TEST(VtkReader, WhatIsSaidAboutPointsAndCellsIsSkipped) {
  const std::string text =
      with(kSquare, "POLYGONS",
           "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1 \n\nPOLYGONS") +
      "METADATA\nCOMPONENT_NAMES\nX\n\nCELL_DATA 2\nSCALARS s float\nnonsense";
  const Result<TriangleMesh> mesh =
      parse(with(text, "POINTS",
                 "FIELD FieldData 2\na%20b 2 1 double\n1 2\nMETADATA\nCOMPONENT_NAMES\nX\n\nc 1 1 int\n3\nPOINTS"));
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_EQ(mesh->indices.size(), 9u);
}

TEST(VtkReader, LinesAndPointsAreLeftOutWithAWarning) {
  const Result<TriangleMesh> mesh = parse(kSquare + "LINES 1 3\n2 0 1\nVERTICES 1 2\n1 0\n");
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_EQ(mesh->indices.size(), 9u);
  EXPECT_THAT(to_text(mesh.diagnostics()), HasSubstr("LINES are left out"));
  EXPECT_THAT(to_text(mesh.diagnostics()), HasSubstr("VERTICES are left out"));
}

TEST(VtkReader, FilesThatVtkWrote) {
  test::expect_seeds_are_tetrahedra(
      "fuzz_vtk_reader",
      {"plain_42_ascii.vtk", "plain_42_binary.vtk", "plain_51_ascii.vtk", "plain_51_binary.vtk", "rich_42_ascii.vtk",
       "rich_42_binary.vtk", "rich_51_ascii.vtk", "rich_51_binary.vtk"},
      read_vtk);
}

TEST(Polylines, FilesWithoutAreRefused) {
  EXPECT_THAT(to_text(parse_polylines(kSquare, "f.vtk").diagnostics()), HasSubstr("no LINES; is it a file of lines?"));
  EXPECT_THAT(to_text(parse_polylines("x", "f.vtk").diagnostics()), HasSubstr("f.vtk:1:1: the first line is not"));
  EXPECT_THAT(to_text(read_polylines("none.vtk").diagnostics()), HasSubstr("none.vtk: no such file"));
  EXPECT_THAT(to_text(parse_polylines(kSquare + "LINES 1 3\n2 0 5\n", "f.vtk").diagnostics()),
              HasSubstr("f.vtk:13:5: number 5 of 5 points"));
}

TEST(Polylines, AreReadLineByLine) {
  const Result<PolylineSet> lines = parse_polylines(kSquare + "LINES 3 8\n2 0 1\n0\n3 4 3 2\n", "f.vtk");
  ASSERT_TRUE(lines.ok()) << to_text(lines.diagnostics());
  EXPECT_EQ(lines->positions.size(), 5u);
  ASSERT_EQ(lines->ends.size(), 3u);
  EXPECT_THAT(lines->line(0), ElementsAre(0, 1));
  EXPECT_TRUE(lines->line(1).empty());
  EXPECT_THAT(lines->line(2), ElementsAre(4, 3, 2));
  EXPECT_THAT(to_text(lines.diagnostics()), HasSubstr("polygons are left out"));
}

TEST(Polylines, OfVersion5) {
  const auto file = std::filesystem::path(FASCICLE_SOURCE_DIR) / "tests/fuzz/corpus/fuzz_vtk_reader/rich_51_binary.vtk";
  const Result<PolylineSet> lines = read_polylines(file);
  ASSERT_TRUE(lines.ok()) << to_text(lines.diagnostics());
  EXPECT_THAT(lines->line(0), ElementsAre(0, 1, 2));
  EXPECT_THAT(lines->line(1), ElementsAre(3, 1));
}

TEST(VtkReaderData, AnatomicalMeshesAreRead) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd");
  struct Known {
    const char* file;
    std::size_t vertices, triangles;
  };
  for (const Known& known :
       {Known{"gluteus_maximus", 9878, 19752}, Known{"iliacus", 6931, 13858}, Known{"box", 2648, 5292},
        Known{"femur", 21230, 42456}, Known{"plate_top", 8, 12}, Known{"plate_bottom", 8, 12}}) {
    const Result<TriangleMesh> mesh = read_vtk(test::data_folder() / "pbd" / (std::string(known.file) + ".vtk"));
    ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
    EXPECT_EQ(mesh->name, known.file);
    EXPECT_EQ(mesh->positions.size(), known.vertices);
    EXPECT_EQ(mesh->indices.size(), 3 * known.triangles);
  }
  const Result<PolylineSet> fibres = read_polylines(test::data_folder() / "pbd/gluteus_maximus_fibres.vtk");
  ASSERT_TRUE(fibres.ok()) << to_text(fibres.diagnostics());
  EXPECT_EQ(fibres->positions.size(), 30u);
  ASSERT_EQ(fibres->ends.size(), 25u);
  for (std::size_t l = 0; l < 25; ++l) EXPECT_EQ(fibres->line(l).size(), 2u);
  for (const glm::vec3& p : fibres->positions) EXPECT_LT(std::abs(p.x) + std::abs(p.y) + std::abs(p.z), 2000.0f);  // mm
}

}  // namespace
}  // namespace fascicle
