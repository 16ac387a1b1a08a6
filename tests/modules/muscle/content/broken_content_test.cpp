// Table-driven: what each kind of broken content file is answered with, in full, and that nothing else is reported.

#include <gmock/gmock.h>

#include "modules/muscle/content/check_content.hpp"
#include "modules/muscle/content/scene_asset.hpp"
#include "tests/modules/muscle/content/broken_characters.hpp"
#include "tests/modules/muscle/content/scratch_content.hpp"

namespace fascicle::muscle {
namespace {

using test::kBlock;
using test::kLegs;
using test::kScene;
using test::kShapes;
using test::ScratchFolder;
using test::with;
using testing::HasSubstr;

std::string name_file(std::string text, std::string_view file) {
  for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', at)) text.replace(at, 1, file);
  return text;
}

// Each expected error in its place, and no other.
void expect_errors(const Diagnostics& found, const std::vector<std::string>& expected, std::string_view file,
                   const ScratchFolder& folder) {
  const std::string all = test::errors_of(found, folder.path());
  ASSERT_EQ(found.errors.size(), expected.size()) << all;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    Diagnostics one;
    one.errors.push_back(found.errors[i]);
    EXPECT_THAT(test::errors_of(one, folder.path()), HasSubstr(name_file(expected[i], file)));
    EXPECT_FALSE(found.errors[i].remedy.empty());
  }
}

class BrokenCharacters : public testing::TestWithParam<test::BrokenCharacter> {};

TEST_P(BrokenCharacters, AreRefused) {
  const ScratchFolder folder;
  folder.write("shapes.gltf", kShapes);
  folder.write("meshes/notes.txt", "nothing");
  std::string text(kLegs);
  for (const test::BrokenPlace& place : GetParam().places) text = with(std::move(text), place.from, place.to);
  const Diagnostics found = check_content(folder.write("legs.character.json", text), {.data_folder = folder.path()});
  expect_errors(found, GetParam().errors, "legs.character.json", folder);
}

INSTANTIATE_TEST_SUITE_P(Table, BrokenCharacters, testing::ValuesIn(test::broken_characters()),
                         [](const auto& case_info) { return std::string(case_info.param.name); });

TEST(BrokenCharacters, TheTableIsLongEnough) { EXPECT_GE(test::broken_characters().size(), 40u); }

struct BrokenText {
  std::string_view name;
  std::string text;
  std::string error;
};

class BrokenTexts : public testing::TestWithParam<BrokenText> {};

TEST_P(BrokenTexts, AreRefused) {
  const ScratchFolder folder;
  for (const char* file : {"legs.character.json", "legs.scene.json"}) {
    expect_errors(check_content(folder.write(file, GetParam().text)), {GetParam().error}, file, folder);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, BrokenTexts,
    testing::Values(
        BrokenText{"Truncated", std::string(kLegs.substr(0, 400)),
         R"(@:11:9: /skeleton/joints/joints/0: the file ends inside a string; is it cut off? Close it with ")"},
        BrokenText{"NotJson", "<?xml version=\"1.0\"?>\n<legs/>\n",
         "@:1:1: '<' where a value is wanted; write a number, string, array, object, true, false or null"},
        BrokenText{"Empty", "",
         "@:1:1: the file is empty; write a JSON document, such as { }"},
        BrokenText{"OnlyANumber", "42\n",
         "@:1:1: the number 42 where an object is wanted; write an object"},
        BrokenText{"NestedTooDeeply",
                   "{\"version\": 1, \"name\": " + std::string(100, '[') + std::string(100, ']') + "}",
         "@:1:87: /name/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0"
         "/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0: nested deeper than 64 levels; flatten it; is it the right file?"}),
    [](const auto& case_info) { return std::string(case_info.param.name); });

TEST(BrokenFiles, MissingFolderAndNameless) {
  const ScratchFolder folder;
  EXPECT_THAT(test::errors_of(check_content(folder.path() / "no.character.json"), folder.path()),
              HasSubstr("no.character.json: no such file"));
  folder.write("dir.scene.json/inside", "");
  EXPECT_THAT(test::errors_of(check_content(folder.path() / "dir.scene.json"), folder.path()),
              HasSubstr("dir.scene.json: this is a folder"));
  EXPECT_THAT(test::errors_of(check_content(folder.write("thing.json", "{}")), folder.path()),
              HasSubstr("thing.json:1:1: neither a character nor a scene; name the file"));
}

// A scene and its characters, with places changed in one of the files.
struct BrokenScene {
  std::string_view name;
  std::string_view file;  // which file is changed
  std::vector<test::BrokenPlace> places;
  std::vector<std::string> errors;
};

class BrokenScenes : public testing::TestWithParam<BrokenScene> {};

TEST_P(BrokenScenes, AreRefused) {
  const ScratchFolder folder;
  const std::filesystem::path scene = write_pair(folder);
  folder.write("walk.mot", "nonsense");
  std::string text(GetParam().file == "pair.scene.json"        ? kScene
                   : GetParam().file == "block.character.json" ? kBlock
                   : GetParam().file == "shapes.gltf"          ? kShapes
                                                               : kLegs);
  for (const test::BrokenPlace& place : GetParam().places) text = with(std::move(text), place.from, place.to);
  folder.write(GetParam().file, text);
  const Diagnostics found = check_content(scene, {.data_folder = folder.path() / "no data here"});
  expect_errors(found, GetParam().errors, GetParam().file, folder);
}

INSTANTIATE_TEST_SUITE_P(
    Table, BrokenScenes,
    testing::Values(
        BrokenScene{"UnknownField", "pair.scene.json", {{"step_hz", "step"}}, {"@:4:3: /step: unknown member 'step'"}},
        BrokenScene{"NoCharacters",
                    "pair.scene.json",
                    {{"\"characters\"", "\"actors\""}},
                    {"@:1:1: 'characters' is missing", "@:6:3: /actors: unknown member 'actors'"}},
        BrokenScene{"LoopOfAClip",
                    "pair.scene.json",
                    {{"\"speed\": 2", "\"loop\": \"record\", \"speed\": 2"}},
                    {"/characters/1/animation/loop: 'loop' says nothing of a clip, which is always played whole"}},
        BrokenScene{"StepOfNothing",
                    "pair.scene.json",
                    {{"120", "0"}},
                    {"@:4:14: /step_hz: 0 is out of range; write a number between 1 and 10000"}},
        BrokenScene{"HalfAFrame",
                    "pair.scene.json",
                    {{"\"frames\": 10", "\"frames\": 10.5"}},
                    {"@:5:13: /frames: 10.5 is not a whole number"}},
        BrokenScene{"CharacterWithoutFile",
                    "pair.scene.json",
                    {{"\"file\": \"block.character.json\", ", ""}},
                    {"@:8:5: /characters/1: 'file' is missing"}},
        BrokenScene{"CharacterMissing",
                    "pair.scene.json",
                    {{"\"block.character.json\"", "\"blok.character.json\""}},
                    {"@:8:15: /characters/1/file: the file 'blok.character.json' does not exist "
                     "(blok.character.json); did you mean 'block.character.json'?"}},
        BrokenScene{"ClipUnknown",
                    "pair.scene.json",
                    {{"\"nod\"", "\"nods\""}},
                    {"@:8:62: /characters/1/animation/clip: the character 'block' has no clip 'nods'; did you mean "
                     "'nod'?"}},
        BrokenScene{"ClipOfJoints",
                    "pair.scene.json",
                    {{"\"in_place\": true", "\"animation\": { \"clip\": \"walk\" }"}},
                    {"/characters/0/animation/clip: the character 'legs' has no clip 'walk'; a joint skeleton plays"}},
        BrokenScene{"MotionOfGltf",
                    "pair.scene.json",
                    {{"\"clip\": \"nod\"", "\"motion\": \"walk.mot\""}},
                    {"/characters/1/animation/motion: the character 'block' has a glTF skeleton, which a motion "
                     "cannot move; name one of its clips"}},
        BrokenScene{"ClipAndMotion",
                    "pair.scene.json",
                    {{"\"clip\": \"nod\"", "\"clip\": \"nod\", \"motion\": \"walk.mot\""}},
                    {"the animation names both a clip and a motion", "which a motion cannot move"}},
        BrokenScene{"MotionMissing",
                    "pair.scene.json",
                    {{"\"in_place\": true", "\"animation\": { \"motion\": \"walks.mot\" }"}},
                    {"the file 'walks.mot' does not exist (walks.mot); did you mean 'walk.mot'?"}},
        BrokenScene{"PhaseOutside",
                    "pair.scene.json",
                    {{"0.25", "1.25"}},
                    {"/characters/1/animation/phase: 1.25 is out of range; write a number between 0 and 1"}},
        BrokenScene{"CameraInsideItsTarget",
                    "pair.scene.json",
                    {{"\"distance\": 3", "\"distance\": 0"}},
                    {"@:11:48: /camera/distance: 0 is out of range"}},
        BrokenScene{"NeedsData",
                    "pair.scene.json",
                    {{"\"step_hz\"", "\"requires_data\": true, \"step_hz\""}},
                    {"@:4:20: /requires_data: there is no data folder, which this scene needs; set the environment "
                     "variable FASCICLE_DATA"}},
        BrokenScene{"CharacterNeedsData",
                    "block.character.json",
                    {{"\"skeleton\": { \"gltf\": \"shapes.gltf\" }", "\"skeleton\": { \"gltf\": \"data:shapes.gltf\" }"}},
                    {"@:2:56: /skeleton/gltf: there is no data folder for 'data:shapes.gltf'; set"}},
        BrokenScene{"VersionFromTheFuture",
                    "pair.scene.json",
                    {{"\"version\": 1", "\"version\": 3"}},
                    {"@:2:14: /version: the file has version 3, this program reads up to 1"}},
        BrokenScene{"SkinMeshUnknown",
                    "block.character.json",
                    {{"[\"block\"]", "[\"blok\"]"}},
                    {"@:3:47: /skin/meshes/0: 'shapes.gltf' has no mesh 'blok'; did you mean 'block'?"}},
        BrokenScene{"NoSkinnedMesh",
                    "block.character.json",
                    {{", \"meshes\": [\"block\"]", ""}},
                    {"@:3:21: /skin/gltf: 'shapes.gltf' has no skinned mesh; name the meshes"}},
        BrokenScene{"SkeletonIsNoGltf",
                    "block.character.json",
                    {{"\"skeleton\": { \"gltf\": \"shapes.gltf\" }", "\"skeleton\": { \"gltf\": \"walk.mot\" }"}},
                    {"@:2:56: /skeleton/gltf: 'walk.mot' is not a glTF file; name a .glb or .gltf file"}},
        // Two placements of one character: its errors are told once.
        BrokenScene{"ErrorsOfACharacterUsedTwice",
                    "legs.character.json",
                    {{"\"pcsa\": 0.005", "\"pcsa\": 0"}},
                    {"@:45:65: /muscles/1/pcsa: 0 is out of range"}}),
    [](const auto& case_info) { return std::string(case_info.param.name); });

TEST(BrokenScenes, ABrokenGltfIsReportedOnce) {
  const ScratchFolder folder;
  const std::filesystem::path scene = write_pair(folder);
  folder.write("shapes.gltf", with(std::string(kShapes), "\"count\": 12", "\"count\": 1200"));
  const Diagnostics found = check_content(scene);
  std::size_t reports = 0;
  for (const Diagnostic& error : found.errors) reports += error.path == "/accessors/1" ? 1 : 0;
  EXPECT_FALSE(found.ok());
  EXPECT_EQ(reports, 1u) << to_text(found);  // though two characters use it
}

TEST(BrokenScenes, LackOfDataIsToldApart) {
  const ScratchFolder folder;
  const LoadOptions no_data{.data_folder = folder.path() / "none"};
  const auto needs = folder.write("needs.scene.json", with(std::string(kScene), "\"step_hz\"",
                                                           "\"requires_data\": true, \"step_hz\""));
  EXPECT_TRUE(lacks_data(load_scene(needs, no_data).diagnostics()));
  const auto other = folder.write("other.scene.json", kScene);  // its characters are missing
  EXPECT_FALSE(lacks_data(load_scene(other, no_data).diagnostics()));
}

TEST(BrokenChains, ACycleIsPrintedWhole) {
  const ScratchFolder folder;
  folder.write("shapes.gltf", kShapes);
  for (const auto& [file, next] : {std::pair{"a", "b"}, {"b", "c"}, {"c", "b"}}) {
    folder.write(std::string(file) + ".character.json",
                 with(std::string(kLegs), "\"attachment_space\"",
                      "\"muscles_from\": \"" + std::string(next) + ".character.json\", \"attachment_space\""));
  }
  const Diagnostics found = check_content(folder.path() / "a.character.json");
  EXPECT_THAT(test::errors_of(found, folder.path()),
              HasSubstr("c.character.json:23:19: /muscles_from: muscles_from runs in a circle: b.character.json -> "
                        "c.character.json -> b.character.json; let one of these files hold its muscles itself"));
}

TEST(BrokenFiles, AllErrorsComeInOneGo) {
  const ScratchFolder folder;
  folder.write("shapes.gltf", kShapes);
  std::string text = with(std::string(kLegs), "\"axis\": \"x\"", "\"axis\": \"w\"");
  text = with(text, "\"bone\": \"pelvis\"", "\"bone\": \"pelvs\"");
  text = with(text, "{ \"bone\": \"femur_r\", \"position\": [0.03, -0.1, 0.01] }",
              "{ \"bone\": \"femr_r\", \"position\": [0.03, -0.1] }");
  text = with(text, "1365", "-1");
  text = with(text, "\"mesh\": \"vastus_r\"", "\"mesh\": \"vastus\"");
  text = with(text, "\"bone\": \"foot_r\"", "\"bone\": \"tow_r\", \"toe\": 1");
  text = with(text, "\"pcsa\": 0.005", "\"pcsa\": \"much\"");
  const Diagnostics found = check_content(folder.write("legs.character.json", text));
  std::vector<std::string> places;
  for (const Diagnostic& error : found.errors) places.push_back(error.path);
  EXPECT_THAT(places, testing::UnorderedElementsAre("/mirror/axis", "/bone_meshes/0/bone", "/muscles/0/origin/bone",
                                                    "/muscles/0/origin/position", "/muscles/0/max_isometric_force",
                                                    "/muscles/0/mesh", "/muscles/1/insertion/bone",
                                                    "/muscles/1/insertion/toe", "/muscles/1/pcsa"));
}

}  // namespace
}  // namespace fascicle::muscle
