// Table-driven: what each kind of broken surface muscle is answered with, and that nothing else is reported.

#include <gmock/gmock.h>

#include "modules/muscle/content/check_content.hpp"
#include "tests/modules/muscle/content/broken_characters.hpp"
#include "tests/modules/muscle/content/scratch_surfaces.hpp"

namespace fascicle::muscle {
namespace {

using test::kLimb;
using test::ScratchFolder;
using test::with;
using testing::HasSubstr;

// Meshes to name in place of the ball.
void write_faulty_meshes(const ScratchFolder& folder) {
  const TriangleMesh ball = test::make_ball();
  TriangleMesh open = ball;
  open.indices.resize(open.indices.size() - 6);
  folder.write("open.obj", test::as_obj(open));
  TriangleMesh crowded = ball;
  crowded.positions.emplace_back(-150.0f, 0.0f, 0.0f);
  crowded.indices.insert(crowded.indices.end(), {ball.indices[0], ball.indices[1], 458});
  folder.write("crowded.obj", test::as_obj(crowded));
  folder.write("two.obj", test::as_obj(test::join(test::make_box({100, 0, 0}, {150, 50, 50}), ball)));
  TriangleMesh flat = ball;
  for (glm::vec3& p : flat.positions) p = glm::vec3(1.0f, 2.0f, 3.0f);
  folder.write("point.obj", test::as_obj(flat));
  folder.write("vast.obj", test::as_obj(test::make_box({-400.0f, -300.0f, -300.0f}, {100.0f, 300.0f, 300.0f})));
  folder.write("vast_inside_out.obj",
               test::as_obj(test::inside_out(test::make_box({-400.0f, -300.0f, -300.0f}, {100.0f, 300.0f, 300.0f}))));
  folder.write("broken.obj", "v 1 2\n");
  folder.write("lines.vtk", "# vtk DataFile Version 3.0\nl\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 0 0\n"
                            "LINES 1 3\n2 0 1\n");
  folder.write("dots.vtk", "# vtk DataFile Version 3.0\nl\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 0 0\n");
}

class BrokenSurfaces : public testing::TestWithParam<test::BrokenCharacter> {};

TEST_P(BrokenSurfaces, AreRefused) {
  const ScratchFolder folder;
  std::string text(kLimb);
  for (const test::BrokenPlace& place : GetParam().places) text = with(std::move(text), place.from, place.to);
  const std::filesystem::path file = test::write_limb(folder, text);
  write_faulty_meshes(folder);
  const Diagnostics found = check_content(file, {.data_folder = folder.path() / "no data here"});
  const std::string all = test::errors_of(found, folder.path());
  ASSERT_EQ(found.errors.size(), GetParam().errors.size()) << all;
  for (std::size_t i = 0; i < found.errors.size(); ++i) {
    EXPECT_THAT(to_string(found.errors[i]), HasSubstr(GetParam().errors[i])) << all;
    EXPECT_FALSE(found.errors[i].remedy.empty());
    EXPECT_GT(found.errors[i].line, 0);
  }
}

std::vector<test::BrokenCharacter> broken_surfaces() {
  return {
      {"UnknownField", {{"\"driver\"", "\"drivr\""}}, {"unknown member 'drivr'; did you mean 'driver'?"}},
      {"NoMesh", {{R"("mesh": { "file": "ball.obj", "unit": "mm" },)", ""}}, {"/surface_muscles/0: 'mesh' is missing"}},
      {"NameOfNoMeshFile",
       {{R"({ "file": "ball.obj", "unit": "mm" })", R"("ball")"}},
       {"/surface_muscles/0/mesh: the mesh 'ball' is named, but the file has no muscle_meshes"}},
      {"MissingFile", {{"ball.obj", "boll.obj"}}, {"the file 'boll.obj' does not exist"}},
      {"NoDataFolder", {{"ball.obj", "data:ball.obj"}}, {"there is no data folder for 'data:ball.obj'"}},
      {"BrokenFile", {{"ball.obj", "broken.obj"}}, {"broken.obj:1"}},
      {"Open",
       {{"ball.obj", "open.obj"}},
       {"/surface_muscles/0/mesh: the mesh is open: 4 edges have one triangle only, round 1 hole; close the holes"}},
      {"Crowded",
       {{"ball.obj", "crowded.obj"}},
       {"the mesh is open: 2 edges have one triangle only, round 1 hole",
        "the mesh is no surface everywhere: 1 edge has more than two triangles; remove inner walls"}},
      {"Degenerate", {{"ball.obj", "point.obj"}}, {"the mesh has no triangle with an area"}},
      {"TwoMuscles",
       {{"ball.obj", "two.obj"}},
       {"the mesh has 2 pieces, and a muscle is one (1: 458 vertices, 4116 cm^3; 2: 8 vertices, 125 cm^3); choose one "
        "with \"piece\": 1"}},
      {"ThirdOfTwoPieces",
       {{R"("mesh": { "file": "ball.obj")", R"("piece": 3, "mesh": { "file": "two.obj")"}},
       {"/surface_muscles/0/piece: the mesh has 2 pieces, there is no piece 3"}},
      {"WithoutUnit",
       {{R"("ball.obj", "unit": "mm")", R"("ball.obj")"}},
       {"/surface_muscles/0/mesh: the muscle would be 346 m long; give \"unit\": \"mm\", with which it would be 0.346 m"}},
      {"UnitTwice",
       {{R"("ball.obj", "unit": "mm")", R"("ball.obj", "unit": "mm", "scale": [0.001, 0.001, 0.001])"}},
       {"the muscle would be 0.000346 m long; give \"unit\": \"m\", with which it would be 0.346 m"}},
      {"UnknownFrame",
       {{R"("fibres")", R"("frame": "trnk", "fibres")"}},
       {"/surface_muscles/0/frame: the skeleton has no bone 'trnk'; did you mean 'trunk'?"}},
      {"UnknownBones", {{R"("bones": ["shin_r"])", R"("bones": ["shn_r"])"}}, {"/surface_muscles/0/bones/0: the skeleton"}},
      {"UnknownBoneOfAttachment",
       {{R"("end": "insertion", "bone": "shin_r")", R"("end": "insertion", "bone": "chin_r")"}},
       {"/surface_muscles/0/attachments/1/bone: the skeleton has no bone 'chin_r'; did you mean 'shin_r'?"}},
      {"NoEnd", {{R"("end": "origin", )", ""}}, {"/surface_muscles/0/attachments/0: 'end' is missing"}},
      {"WrongEnd", {{R"("origin", "bone")", R"("top", "bone")"}}, {"/surface_muscles/0/attachments/0/end: unknown value 'top'"}},
      {"NothingChosen",
       {{R"(, "within_mm": 4)", ""}},
       {"/surface_muscles/0/attachments/1: nothing says which vertices are attached; give one"}},
      {"ChosenTwice",
       {{R"("within_mm": 4)", R"("within_mm": 4, "vertices": [3])"}},
       {"/surface_muscles/0/attachments/1: several fields say which vertices are attached; give one"}},
      {"TooNarrow",
       {{R"("within_mm": 4)", R"("within_mm": 0.5)"}},
       {"/surface_muscles/0/attachments/1: no vertex of the muscle lies within 0.5 mm of 'shin_r', the nearest is 1 mm "
        "away; give a larger distance"}},
      {"DistanceOfZero", {{R"("within_mm": 4)", R"("within_mm": 0)"}}, {"/attachments/1/within_mm: 0 is out of range"}},
      {"BoneWithoutMesh",
       {{R"("end": "insertion", "bone": "shin_r")", R"("end": "insertion", "bone": "shin_l")"}},
       {"/surface_muscles/0/attachments/1: the bone 'shin_l' has no mesh to measure the distance from"}},
      {"PlaneTooFar",
       {{R"("at": 90)", R"("at": 900)"}},
       {"/surface_muscles/0/attachments/0: no vertex of the muscle lies beyond the plane at 900, the furthest is at 100; "
        "\"at\" is in the mesh file's own coordinates and unit"}},
      {"PlaneWithoutDirection",
       {{"[0, 2, 0]", "[0, 0, 0]"}},
       {"/attachments/0/beyond/normal: a plane's normal has no length"}},
      {"PointTooFar",
       {{R"("within_mm": 4)", R"("near": { "position": [0, 0, 0], "radius_mm": 5 })"}},
       {"no vertex of the muscle lies within 5 mm of the point, the nearest is 100 mm away"}},
      {"NoSuchVertex",
       {{R"("within_mm": 4)", R"("vertices": [1000])"}},
       {"/surface_muscles/0/attachments/1: vertex 1000, but the mesh has 458 vertices; count them from 0"}},
      {"VertexThatIsNoNumber", {{R"("within_mm": 4)", R"("vertices": [-1])"}}, {"/attachments/1/vertices/0: -1"}},
      {"VertexOfAnotherPiece",
       {{R"("mesh": { "file": "ball.obj")", R"("piece": 1, "mesh": { "file": "two.obj")"},
        {R"("within_mm": 4)", R"("vertices": [3])"}},
       {"vertex 3 belongs to no triangle of the muscle"}},
      {"InTwoAttachments",
       {{R"("within_mm": 4)", R"("near": { "position": [0, 0.3, 0], "radius_mm": 5 })"}},
       {"/surface_muscles/0/attachments/1: 1 of its 1 vertices belong to attachment 0 already ('trunk'); let the areas"}},
      {"AllAttached",
       {{R"("at": 90)", R"("at": -1000)"}, {R"("within_mm": 4)", R"("vertices": [0])"}},
       {"1 of its 1 vertices belong to attachment 0", "all 458 vertices are attached, and none is left to move"}},
      {"FreeAndAttached",
       {{R"("fibres")", R"("free": true, "fibres")"}},
       {"/surface_muscles/0/free: the muscle is free, and it has attachments"}},
      {"NoSuchDriver",
       {{R"("driver": "calf_r")", R"("driver": "half_r")"}},
       {"/surface_muscles/0/driver: the character has no muscle 'half_r' to drive this one; did you mean 'calf_r'?"}},
      {"FibresFarAway",
       {{"[-150, 0, 90]", "[150, 0, 90]"}, {"[-150, -100, 0]", "[150, -100, 0]"}, {"[-150, 100, 0]", "[150, 100, 0]"}},
       {"/surface_muscles/0/fibres/0: 1 of 1 fibre does not touch the muscle: fibre 0 is 2"}},
      {"FibresWithoutUnit",
       {{R"("fibres": [{ "points")", R"("fibres": [{ "unit": "m", "points")"}},
       {"1 of 1 fibre does not touch the muscle: fibre 0 is 1.747e+05 mm away from it; fibres lie on the mesh or in it: "
        "correct their \"unit\""}},
      {"FibreOfOnePoint",
       {{"[[-150, -100, 0], [-150, 0, 90], [-150, 100, 0]]", "[[-150, -100, 0]]"}},
       {"/surface_muscles/0/fibres/0/points: 1 element"}},
      {"FibresFromNowhere",
       {{R"("points": [[-150, -100, 0], [-150, 0, 90], [-150, 100, 0]])", ""}},
       {"/surface_muscles/0/fibres/0: the fibres have neither 'file' nor 'points'"}},
      {"FibresFileWithoutLines",
       {{R"("points": [[-150, -100, 0], [-150, 0, 90], [-150, 100, 0]])", R"("file": "dots.vtk")"}},
       {"dots.vtk"}},
      {"FibresFileThatIsMissing",
       {{R"("points": [[-150, -100, 0], [-150, 0, 90], [-150, 100, 0]])", R"("file": "line.vtk")"}},
       {"the file 'line.vtk' does not exist"}},
      {"InnerFibresByMagic",
       {{R"("fibres")", R"("inner_fibres": { "method": "magic" }, "fibres")"}},
       {"/surface_muscles/0/inner_fibres/method: unknown value 'magic'"}},
      {"SolvedByMagic",
       {{R"("driver")", R"("solver": "magic", "driver")"}},
       {"/surface_muscles/0/solver: unknown value 'magic'"}},
      {"SolverAndLevels",
       {{R"("driver")", R"("solver": "dynamic", "levels": [{ "solver": "coarse_hull" }], "driver")"}},
       {"/surface_muscles/0/solver: the muscle has both \"solver\" and \"levels\"; leave out one of the two"}},
      {"NoLevel", {{R"("driver")", R"("levels": [], "driver")"}}, {"/surface_muscles/0/levels: 0 elements"}},
      {"LevelsOfNoSolver",
       {{R"("driver")", R"("levels": [{}], "driver")"}},
       {"/surface_muscles/0/levels/0: 'solver' is missing"}},
      {"LevelThatIsAlwaysEnough",
       {{R"("driver")", R"("levels": [{ "solver": "dynamic" }, { "solver": "coarse_hull" }], "driver")"}},
       {"/surface_muscles/0/levels/0: the levels after this one are never used; give its \"above_pixels\""}},
      {"LevelOfNoPixels",
       {{R"("driver")",
         R"("levels": [{ "solver": "dynamic", "above_pixels": 0 }, { "solver": "coarse_hull" }], "driver")"}},
       {"/surface_muscles/0/levels/0/above_pixels: the levels after this one are never used"}},
      {"LevelsThatRise",
       {{R"("driver")", R"("levels": [{ "solver": "dynamic", "above_pixels": 60 },
         { "solver": "coarse_hull", "above_pixels": 60 }, { "solver": "coarse_hull" }], "driver")"}},
       {"/surface_muscles/0/levels/1/above_pixels: 60 pixels are no less than the level before has (60); order the"}},
      {"NoLevelForTheSmallest",
       {{R"("driver")", R"("levels": [{ "solver": "coarse_hull", "above_pixels": 60 }], "driver")"}},
       {"/surface_muscles/0/levels/0/above_pixels: no level is left for a muscle of less than 60 pixels"}},
      {"PixelsBelowZero",
       {{R"("driver")", R"("levels": [{ "solver": "dynamic", "above_pixels": -1 }], "driver")"}},
       {"/surface_muscles/0/levels/0/above_pixels: -1 is out of range"}},
      {"RefinementsOfTheDynamicSolver",
       {{R"("driver")", R"("levels": [{ "solver": "dynamic", "refinements": 2 }], "driver")"}},
       {"/surface_muscles/0/levels/0/refinements: only the coarse hull's result is refined"}},
      {"HullOfThreeVertices",
       {{R"("driver")", R"("solver": "coarse_hull", "hull": { "vertices": 3 }, "driver")"}},
       {"/surface_muscles/0/hull/vertices: 3 is out of range"}},
      {"HullOfTooManyVertices",
       {{R"("driver")", R"("solver": "coarse_hull", "hull": { "vertices": 100000 }, "driver")"}},
       {"/surface_muscles/0/hull/vertices: 100000 is out of range"}},
      {"HullWithAnUnknownField",
       {{R"("driver")", R"("hull": { "iteration": 3 }, "driver")"}},
       {"/surface_muscles/0/hull/iteration: unknown member 'iteration'; did you mean 'iterations'?"}},
      {"HullWithoutALine",
       {{R"("driver": "calf_r")", R"("solver": "coarse_hull")"}},
       {"/surface_muscles/0/solver: the coarse hull goes by the muscle's line, and there is none; give "
        "\"action_line\": [{"}},
      {"HullOfALevelWithoutALine",
       {{R"("driver": "calf_r")",
         R"("levels": [{ "solver": "dynamic", "above_pixels": 9 }, { "solver": "coarse_hull" }])"}},
       {"/surface_muscles/0/levels/1/solver: the coarse hull goes by the muscle's line, and there is none"}},
      {"HullOfAFreeMuscle",
       {{R"("attachments": [
        { "end": "origin", "bone": "trunk", "beyond": { "normal": [0, 2, 0], "at": 90 } },
        { "end": "insertion", "bone": "shin_r", "within_mm": 4 }])", R"("free": true, "solver": "coarse_hull")"}},
       {"/surface_muscles/0/solver: nothing says where the coarse hull is: the muscle is attached to no bone; give it"}},
      {"LineOfOnePoint",
       {{R"("driver")", R"("action_line": [{ "bone": "trunk", "at": [-150, 90, 0] }], "driver")"}},
       {"/surface_muscles/0/action_line: 1 element"}},
      {"LineOfAnUnknownBone",
       {{R"("driver")",
         R"("action_line": [{ "bone": "trunk", "at": [-150, 90, 0] }, { "bone": "chin_r", "at": [-150, -90, 0] }], "driver")"}},
       {"/surface_muscles/0/action_line/1/bone: the skeleton has no bone 'chin_r'; did you mean 'shin_r'?"}},
      {"LineWithoutPlaces",
       {{R"("driver")", R"("action_line": [{ "bone": "trunk" }, { "at": [-150, -90, 0] }], "driver")"}},
       {"/surface_muscles/0/action_line/0: 'at' is missing", "/surface_muscles/0/action_line/1: 'bone' is missing"}},
      {"LineThatIsNotFinite",
       {{R"("driver")",
         R"("action_line": [{ "bone": "trunk", "at": [-150, 1e999, 0] }, { "bone": "trunk", "at": [-150, 0, 0] }], "driver")"}},
       {"/surface_muscles/0/action_line/0/at"}},
      {"LineOfNoLength",
       {{R"("driver")",
         R"("action_line": [{ "bone": "trunk", "at": [-150, 9, 0] }, { "bone": "shin_r", "at": [-150, 9, 0] }], "driver")"}},
       {"/surface_muscles/0/action_line: the line is 0 mm long, and has no direction"}},
      {"LineFarAway",
       {{R"("driver")", R"("action_line": [{ "bone": "trunk", "at": [150, 90, 0], "space": "character" },
         { "bone": "shin_r", "at": [150, 100, 0], "space": "character" }], "driver")"}},
       {"/surface_muscles/0/action_line: the line is 1.749e+05 mm away from the muscle; a point's \"at\" is in the mesh"}},
      {"LineInNoSpace",
       {{R"("driver")", R"("action_line": [{ "bone": "trunk", "at": [-150, 90, 0], "space": "bone" },
         { "bone": "shin_r", "at": [-150, -90, 0] }], "driver")"}},
       {"/surface_muscles/0/action_line/0/space: unknown value 'bone'"}},
      {"SwallowedByABone",
       {{R"("file": "block.obj")", R"("file": "vast.obj")"}, {R"("within_mm": 4)", R"("vertices": [300])"}},
       {"/surface_muscles/0/mesh: surface muscle 'ball_r': the bone 'shin_r' swallows it: at rest all"}},
      {"SwallowedByABoneInsideOut",
       {{R"("file": "block.obj")", R"("file": "vast_inside_out.obj")"}, {R"("within_mm": 4)", R"("vertices": [300])"}},
       {"/surface_muscles/0/mesh: surface muscle 'ball_r': the bone 'shin_r' swallows it: at rest all"}},
      {"SubstepsOfNone", {{R"("substeps": 4)", R"("substeps": 0)"}}, {"/settings/substeps: 0 is out of range"}},
      {"SecondOfItsName",
       {{R"("surface_muscles": [)", R"("surface_muscles": [{ "name": "ball_r", "mesh": { "file": "ball.obj", "unit": "mm" },
          "free": true },)"}},
       {"/surface_muscles/1/name: this is a second surface muscle 'ball_r', the first is at"}},
      {"MirrorWithoutRule",
       {{R"("name": "ball_r",)", R"("name": "ball_r", "mirror": true,)"},
        {R"("mirror": { "axis": "x", "bones": [["_r", "_l"]], "names": [["_r", "_l"]] },)", ""},
        {R"("name": "calf_r", "mirror": true)", R"("name": "calf_r")"}},
       {"/surface_muscles/0/mirror: the file has no mirror rule"}},
      {"MirrorOfNoSide",
       {{R"("name": "ball_r",)", R"("name": "ball", "mirror": true,)"}},
       {"/surface_muscles/0/name: 'ball' holds none of the parts that the mirror rule exchanges"}},
      {"MirrorWithoutDriver",
       {{R"("name": "ball_r",)", R"("name": "ball_r", "mirror": true,)"},
        {R"("name": "calf_r", "mirror": true)", R"("name": "calf_r")"}},
       {"/surface_muscles/0/driver: the mirror image's driver would be 'calf_l', which the character doesn't have"}},
  };
}

INSTANTIATE_TEST_SUITE_P(Table, BrokenSurfaces, testing::ValuesIn(broken_surfaces()),
                         [](const auto& case_info) { return std::string(case_info.param.name); });

TEST(BrokenSurfaces, AreToldAllAtOnce) {
  const ScratchFolder folder;
  std::string text = with(std::string(kLimb), R"("driver": "calf_r")", R"("driver": "half_r")");
  text = with(std::move(text), R"("within_mm": 4)", R"("within_mm": 0.5)");
  text = with(std::move(text), R"("bones": ["shin_r"])", R"("bones": ["shn_r"])");
  const Diagnostics found = check_content(test::write_limb(folder, text));
  EXPECT_EQ(found.errors.size(), 3u) << to_text(found);
}

// A muscle may be wrong in a file whose skeleton is wrong, too.
TEST(BrokenSurfaces, WithoutASkeletonThereIsNothingToCheck) {
  const ScratchFolder folder;
  const Diagnostics found = check_content(test::write_limb(
      folder, with(std::string(kLimb), R"("parent": "ground", "child": "trunk")", R"("parent": "grund", "child": "trunk")")));
  EXPECT_FALSE(found.ok());
  EXPECT_THAT(to_text(found), testing::Not(HasSubstr("surface_muscles")));
}

}  // namespace
}  // namespace fascicle::muscle
