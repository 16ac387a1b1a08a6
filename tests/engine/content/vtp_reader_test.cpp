#include "engine/content/vtp_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/test_data.hpp"

namespace fascicle {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A square of one polygon and a triangle hanging on it.
const std::string kSquare = R"(<?xml version="1.0"?>
<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian">
<PolyData>
<Piece NumberOfPoints="5" NumberOfPolys="2" NumberOfStrips="0">
<Points>
<DataArray type="Float32" NumberOfComponents="3" format="ascii">
0 0 0
1 0 0
1 1 0
0 1 0
2 0 1
</DataArray>
</Points>
<Polys>
<DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 3 1 4 2</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">4 7</DataArray>
</Polys>
</Piece>
</PolyData>
</VTKFile>
)";

std::string with(std::string text, const std::string& find, const std::string& replacement) {
  const std::size_t at = text.find(find);
  EXPECT_NE(at, std::string::npos) << find;
  return text.replace(at, find.size(), replacement);
}

struct Broken {
  std::string text;
  std::string message;
};

TEST(VtpReader, BrokenFilesAreNamedWithLineCauseAndRemedy) {
  const std::string arrays = "/VTKFile/PolyData/Piece/Polys/DataArray";
  const std::string points = "/VTKFile/PolyData/Piece/Points/DataArray";
  const Broken cases[] = {
      {"", "f.vtp:1:1: not XML: No document element found; save it as VTK PolyData in XML (.vtp)"},
      {"solid stl", "f.vtp:1:10: not XML: No document element found"},
      {kSquare.substr(0, 300), "f.vtp:15:2: not XML: Error parsing start element tag"},
      {"<html></html>", "f.vtp:1:2: /html: no <VTKFile> element"},
      {with(kSquare, "\"PolyData\"", "\"ImageData\""),
       "f.vtp:2:2: /VTKFile: type is \"ImageData\"; save it as type=\"PolyData\""},
      {"<VTKFile type=\"PolyData\"/>", "f.vtp:1:2: /VTKFile: no <PolyData> element"},
      {"<VTKFile type=\"PolyData\"><PolyData/></VTKFile>", "no <Piece> element"},
      {with(with(kSquare, "<Points>", "<Dots>"), "</Points>", "</Dots>"), "no <Points> with a <DataArray>"},
      {with(kSquare, "format=\"ascii\"", "format=\"hex\""),
       "f.vtp:6:2: " + points + ": format is \"hex\"; save it as ascii, binary or appended"},
      {with(kSquare, "1 1 0", "1 x 0"), "f.vtp:9:3: " + points + ": 'x' is not a number; write a finite number"},
      {with(kSquare, "1 1 0", "1 nan 0"), "f.vtp:9:3: " + points + ": nan is not finite; write a finite number"},
      {with(kSquare, "1 1 0", "1 1e60 0"), "f.vtp:9:3: " + points + ": 1e+60 is out of range; write a finite number"},
      {with(kSquare, "2 0 1", "2 0"), "the number of values is not a multiple of 3"},
      {with(kSquare, "2 0 1\n", ""), "f.vtp:4:2: /VTKFile/PolyData/Piece: NumberOfPoints is \"5\", but 4 are there"},
      {with(kSquare, "NumberOfComponents=\"3\"", "NumberOfComponents=\"2\""), "NumberOfComponents is \"2\""},
      {with(kSquare, "1 4 2<", "1 5 2<"),
       "f.vtp:15:70: " + arrays + "[@Name='connectivity']: 5 is out of range; write a whole number from 0 to 4"},
      {with(kSquare, "1 4 2<", "1 -4 2<"), "-4 is out of range"},
      {with(kSquare, "1 4 2<", "1 99999999999999999999 2<"), "1e+20 is out of range"},
      {with(kSquare, "1 4 2<", "1 3.5 2<"), "3.5 is not a whole number; write a whole number from 0 to 4"},
      {with(kSquare, ">4 7<", ">7 4<"), "f.vtp:16:2: " + arrays + "[@Name='offsets']: offset 1 is 4, after 7"},
      {with(kSquare, ">4 7<", ">4 9<"), "offset 1 is 9, after 4 with 7 entries in connectivity"},
      {with(kSquare, ">4 7<", ">3 6<"), "the last offset is 6, but connectivity has 7 entries"},
      {with(kSquare, "NumberOfPolys=\"2\"", "NumberOfPolys=\"3\""), "NumberOfPolys is \"3\", but 2 are there"},
      {with(kSquare, "Name=\"offsets\"", "Name=\"ends\""), "no DataArray \"offsets\""},
      {with(kSquare, ">0 1 2 3 1 4 2<", "><b/><"), "elements inside an array"},
      {with(with(kSquare, ">0 1 2 3 1 4 2<", ">0 1<"), ">4 7<", ">1 2<"), "no polygons"},
  };
  for (const Broken& broken : cases) {
    const Result<TriangleMesh> result = parse_vtp(broken.text, "f.vtp");
    ASSERT_FALSE(result.ok()) << broken.message;
    EXPECT_THAT(to_text(result.diagnostics()), HasSubstr(broken.message));
  }
}

TEST(VtpReader, PolygonsBecomeFans) {
  const Result<TriangleMesh> mesh = parse_vtp(kSquare, "folder/square.vtp");
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_EQ(mesh->name, "square");
  EXPECT_EQ(mesh->positions.size(), 5u);
  EXPECT_EQ(mesh->positions[4], glm::vec3(2, 0, 1));
  EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2, 0, 2, 3, 1, 4, 2));
  EXPECT_TRUE(mesh->normals.empty());
}

TEST(VtpReader, StripsTurnEveryOtherTriangle) {
  const std::string text = with(with(kSquare, "<Polys>", "<Strips>"), "</Polys>", "</Strips>");
  const Result<TriangleMesh> mesh =
      parse_vtp(with(with(text, "NumberOfPolys=\"2\"", ""), "NumberOfStrips=\"0\"", "NumberOfStrips=\"2\""), "f.vtp");
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2, 2, 1, 3, 1, 4, 2));
}

TEST(VtpReader, NormalsAreKeptAndMadeUnit) {
  const std::string data =
      "<PointData Normals=\"N\"><DataArray Name=\"N\" NumberOfComponents=\"3\">0 0 2 0 0 1 0 0 1 0 0 1 0 0 "
      "1</DataArray>"
      "</PointData>\n<Points>";
  const Result<TriangleMesh> mesh = parse_vtp(with(kSquare, "<Points>", data), "f.vtp");
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  ASSERT_EQ(mesh->normals.size(), 5u);
  EXPECT_EQ(mesh->normals[0], glm::vec3(0, 0, 1));
  EXPECT_THAT(to_text(parse_vtp(with(kSquare, "<Points>", with(data, "0 0 2 ", "")), "f.vtp").diagnostics()),
              HasSubstr("4 normals for 5 points"));
  EXPECT_THAT(to_text(parse_vtp(with(kSquare, "<Points>", with(data, "0 0 2 ", "0 0 0 ")), "f.vtp").diagnostics()),
              HasSubstr("normal 0 has length 0"));
}

TEST(VtpReader, LinesAreLeftOutWithAWarning) {
  const Result<TriangleMesh> mesh = parse_vtp(
      with(kSquare, "<Polys>", "<Lines><DataArray Name=\"connectivity\">0 1</DataArray></Lines>\n<Polys>"), "f.vtp");
  ASSERT_TRUE(mesh.ok());
  EXPECT_THAT(to_text(mesh.diagnostics()), HasSubstr("warning: f.vtp:14:2: /VTKFile/PolyData/Piece/Lines: ignored"));
}

TEST(VtpReader, AllBonesOfOpenSimAreRead) {
  FASCICLE_SKIP_WITHOUT_DATA("opensim/Geometry");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::data_folder() / "opensim/Geometry")) {
    if (entry.path().extension() != ".vtp") continue;
    ++files;
    const Result<TriangleMesh> mesh = read_vtp(entry.path());
    ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
    EXPECT_EQ(mesh->name, entry.path().stem().string());
    EXPECT_FALSE(mesh->indices.empty());
    EXPECT_EQ(mesh->indices.size() % 3, 0u);
    for (const std::uint32_t index : mesh->indices) ASSERT_LT(index, mesh->positions.size());
    for (const glm::vec3& p : mesh->positions) ASSERT_LT(std::abs(p.x) + std::abs(p.y) + std::abs(p.z), 3.0f);  // m
  }
  EXPECT_EQ(files, 56);
}

}  // namespace
}  // namespace fascicle
