#include "engine/content/vtp_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
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
  test::expect_messages(cases, [](const std::string& text) { return parse_vtp(text, "f.vtp"); });
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

// The corner of a cube with its arrays behind the XML: where they begin is filled in.
std::string appended_corner(const std::string& points, const std::string& connectivity, const std::string& offsets) {
  std::string text = R"(<VTKFile type="PolyData" byte_order="BigEndian" header_type="UInt64"><PolyData><Piece>
<Points><DataArray type="Float64" NumberOfComponents="3" format="appended" offset="0"/></Points>
<Polys><DataArray type="UInt8" Name="connectivity" format="appended" offset="%1"/>
<DataArray type="Int16" Name="offsets" format="appended" offset="%2"/></Polys>
</Piece></PolyData>
<AppendedData encoding="raw">
  _)";
  text = with(text, "%1", std::to_string(points.size()));
  text = with(text, "%2", std::to_string(points.size() + connectivity.size()));
  return text + points + connectivity + offsets + "\n</AppendedData></VTKFile>\n";
}

template <class T>
std::string sized(std::initializer_list<T> numbers) {
  return test::bytes_of<std::uint64_t>({numbers.size() * sizeof(T)}, std::endian::big) +
         test::bytes_of<T>(numbers, std::endian::big);
}

TEST(VtpReader, AppendedArraysAreRead) {
  const std::string points = sized<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  const std::string connectivity = sized<std::uint8_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
  const std::string offsets = sized<std::int16_t>({3, 6, 9, 12});
  const std::string good = appended_corner(points, connectivity, offsets);
  const Result<TriangleMesh> mesh = parse_vtp(good, "f.vtp");
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  EXPECT_EQ(mesh->positions[3], glm::vec3(0, 0, 1));
  EXPECT_THAT(mesh->indices, ElementsAre(0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3));

  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string base = "/VTKFile/PolyData/Piece/";
  const Broken cases[] = {
      {with(good, "\"0\"/", "\"1000\"/"), "f.vtp:2:10: " + base + "Points/DataArray: offset \"1000\" into"},
      {with(good, "\"0\"/", "\"-1\"/"), "offset \"-1\" into"},
      {with(good, " offset=\"0\"/", "/"), "offset \"\" into"},
      {with(good, "Float64", "Float16"), "f.vtp:2:10: " + base + "Points/DataArray: type is \"Float16\""},
      {with(good, "UInt64", "UInt32"), "/VTKFile/PolyData: no polygons"},
      {with(good, "type=\"PolyData\"", "type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\""),
       "f.vtp:1:2: /VTKFile: compressor is \"vtkLZ4DataCompressor\"; save it compressed with zlib, or not at all"},
      {with(good, "type=\"PolyData\"", "type=\"PolyData\" compressor=\"vtkZLibDataCompressor\""),
       "its header tells of"},
      {appended_corner(sized<double>({0, 0, 0, 1, nan, 0}), connectivity, offsets),
       "Points/DataArray: value 4: nan is not finite; write a finite number"},
      {appended_corner(points, sized<std::uint8_t>({0, 2, 4}), offsets),
       "f.vtp:3:9: " + base + "Polys/DataArray[@Name='connectivity']: value 2: 4 is out of range"},
      {appended_corner(points, connectivity, sized<std::int16_t>({3, -1})), "value 1: -1 is out of range"},
  };
  test::expect_messages(cases, [](const std::string& text) { return parse_vtp(text, "f.vtp"); });
  test::expect_cuts_are_survived(good, [](const std::string& text) { return parse_vtp(text, "f.vtp"); });
}

TEST(VtpReader, ArraysThatNameTheSameBytesOverAndOverEnd) {
  // 100 pieces, each with the same 100 kB of points.
  std::string text = "<VTKFile type=\"PolyData\"><PolyData>";
  for (int i = 0; i < 100; ++i) {
    text +=
        "<Piece><Points><DataArray type=\"Int8\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/>"
        "</Points></Piece>";
  }
  text += "</PolyData><AppendedData encoding=\"raw\">_" + test::bytes_of<std::uint32_t>({100002}, std::endian::little);
  text += std::string(100002, '\1') + "</AppendedData></VTKFile>";
  EXPECT_THAT(to_text(parse_vtp(text, "f.vtp").diagnostics()),
              HasSubstr("arrays over 64 times as large as the file; split the mesh"));
}

TEST(VtpReader, FilesThatVtkWrote) {
  test::expect_seeds_are_tetrahedra(
      "fuzz_vtp_reader",
      {"inline_plain.vtp", "inline_zlib.vtp", "appended_base64.vtp", "appended_raw.vtp", "appended_raw_zlib.vtp"},
      read_vtp);
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
