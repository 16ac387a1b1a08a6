// Table-driven: what each kind of broken collision file is answered with, in full, and that nothing else is reported.

#include <gmock/gmock.h>

#include "modules/muscle/content/check_content.hpp"
#include "tests/modules/muscle/content/scratch_collision.hpp"

namespace fascicle::muscle {
namespace {

using test::kTags;
using test::ScratchFolder;
using test::with;
using testing::HasSubstr;

struct Place {
  std::string_view from, to;
};

// In the expected texts, @ stands for the collision file's name.
struct Broken {
  std::string_view name;
  std::vector<Place> places;
  std::vector<std::string> errors;
  std::vector<std::string> warnings = {};
};

std::string one_of(const Diagnostic& fault, const ScratchFolder& folder) {
  Diagnostics one;
  one.errors.push_back(fault);
  return test::errors_of(one, folder.path());
}

std::string expected_text(std::string text) {
  if (text.starts_with('@')) text.replace(0, 1, "legs.collision.json");
  return text;
}

class BrokenCollision : public testing::TestWithParam<Broken> {};

TEST_P(BrokenCollision, IsRefused) {
  const ScratchFolder folder;
  std::string text(kTags);
  for (const Place& place : GetParam().places) text = with(std::move(text), place.from, place.to);
  const Diagnostics found = check_content(test::write_legs(folder, text), {.bone_fields = false});
  ASSERT_EQ(found.errors.size(), GetParam().errors.size()) << to_text(found);
  for (std::size_t i = 0; i < found.errors.size(); ++i) {
    EXPECT_THAT(one_of(found.errors[i], folder), HasSubstr(expected_text(GetParam().errors[i])));
    EXPECT_FALSE(found.errors[i].remedy.empty());
  }
  std::vector<Diagnostic> warnings;
  for (const Diagnostic& warning : found.warnings) {
    if (warning.file.ends_with("legs.collision.json")) warnings.push_back(warning);
  }
  ASSERT_EQ(warnings.size(), GetParam().warnings.size()) << to_text(found);
  for (std::size_t i = 0; i < warnings.size(); ++i) {
    EXPECT_THAT(one_of(warnings[i], folder), HasSubstr(expected_text(GetParam().warnings[i])));
  }
}

const std::vector<Broken>& table() {
  static const std::vector<Broken> all{
      {"Truncated", {{"  ],\n  \"ignore\": [\n    { \"muscle\": \"soleus_r\", \"bone\": \"pelvis\" }\n  ]\n}\n", ""}},
       {"@:11:1: /stay_out: the file ends inside the array that starts at 9:15"}},
      {"NoVersion", {{"  \"version\": 1,\n", ""}}, {"@:1:1: the field 'version' is missing; add \"version\": 1"}},
      {"VersionFromTheFuture", {{"\"version\": 1", "\"version\": 2"}},
       {"@:3:14: /version: the file has version 2, this program reads up to 1"}},
      {"UnknownField", {{"\"ignore\"", "\"ignored\""}},
       {"@:12:3: /ignored: unknown member 'ignored'; did you mean 'ignore'?"}},
      {"UnknownSetting", {{"\"substeps\"", "\"sub_steps\""}},
       {"@:4:17: /settings/sub_steps: unknown member 'sub_steps'; did you mean 'substeps'?"}},
      {"NoSubsteps", {{"\"substeps\": 3", "\"substeps\": 0"}},
       {"@:4:29: /settings/substeps: 0 is out of range; write a whole number between 1 and 32"}},
      {"HalfASubstep", {{"\"substeps\": 3", "\"substeps\": 2.5"}}, {"/settings/substeps: 2.5 is not a whole number"}},
      {"NegativeTime", {{"80", "-80"}},
       {"@:4:49: /settings/shape_time_ms: -80 is out of range; write a number between 0 and 10000"}},
      {"UnknownMode", {{"\"shape_time_ms\": 80", "\"mode\": \"reducd\""}}, {"@:4:40: /settings/mode: "}},
      {"WrongTypes",
       {{"\"substeps\": 3", "\"enabled\": \"yes\""}, {"\"at\": 0.5", "\"at\": \"half\""},
        {"\"bones\": [\"pelvis\"]", "\"bones\": \"pelvis\""}},
       {"/settings/enabled: the string \"yes\" where true or false is wanted",
        "/transversals/0/first/at: the string \"half\" where a number is wanted",
        "/stay_out/0/bones: the string \"pelvis\" where an array is wanted"}},
      {"UnknownMuscle", {{"\"muscle\": \"soleus_r\", \"at\"", "\"muscle\": \"solius_r\", \"at\""}},
       {"@:6:89: /transversals/0/second/muscle: the character has no muscle 'solius_r'; did you mean 'soleus_r'?"}},
      {"UnknownMuscles",
       {{"{ \"muscle\": \"vastus_r\", \"from\"", "{ \"muscle\": \"vastus\", \"from\""},
        {"{ \"muscle\": \"soleus_r\", \"bone\"", "{ \"muscle\": \"gracilis_r\", \"bone\""}},
       {"@:13:17: /ignore/0/muscle: the character has no muscle 'gracilis_r'; known muscles: soleus_r, vastus_l",
        "@:10:17: /stay_out/0/muscle: the character has no muscle 'vastus'; did you mean 'vastus_"}},
      {"UnknownBone", {{"\"second\": { \"bone\": \"pelvis\" }", "\"second\": { \"bone\": \"pelvs\" }"}},
       {"@:7:86: /transversals/1/second/bone: the skeleton has no bone 'pelvs'; did you mean 'pelvis'?"}},
      {"BonesWithoutMesh", {{"\"bones\": [\"pelvis\"]", "\"bones\": [\"femur_r\", \"pelvis\"]"}},
       {"@:10:63: /stay_out/0/bones/0: the bone 'femur_r' has no mesh, so nothing can touch it; give it one in "
        "\"bone_meshes\" of the character file, or name another; known bones with a mesh: pelvis"}},
      {"AnEndOfTheMuscle", {{"\"at\": 0.5", "\"at\": 0"}, {"\"at\": 0.4", "\"at\": 1"}},
       {"@:6:46: /transversals/0/first/at: 0 is an end of the muscle, whose section is attached to bone and cannot "
        "move; give a fraction of the muscle's length, from 0.001 (by the origin) to 0.999",
        "/transversals/0/second/at: 1 is an end of the muscle"}},
      {"BeyondTheMuscle", {{"\"at\": 0.5", "\"at\": 1.5"}, {"\"at\": 0.4", "\"at\": -0.1"}},
       {"/transversals/0/first/at: 1.5 is out of range; give a fraction", "/transversals/0/second/at: -0.1 is out of"}},
      {"AngleInDegrees", {{"\"angle\": 1.5", "\"angle\": 90"}},
       {"@:6:60: /transversals/0/first/angle: the angle 90 is out of range; give radians from 0 to 2 pi = 6.2832; 90 "
        "degrees are 1.571 rad"}},
      {"AngleNegative", {{"\"angle\": 1.5", "\"angle\": -1"}},
       {"the angle -1 is out of range; give radians from 0 to 2 pi = 6.2832; -1 is 5.283 after whole turns"}},
      {"AngleNotFinite", {{"\"angle\": 1.5", "\"angle\": 1e999"}}, {"@:6:60: /transversals/0/first/angle: "}},
      {"WithItself", {{"\"muscle\": \"soleus_r\", \"at\"", "\"muscle\": \"vastus_r\", \"at\""}},
       {"@:6:5: /transversals/0: both ends are on 'vastus_r'; a constraint joins two muscles, or a muscle and a bone"}},
      {"BoneThatYields", {{"{ \"bone\": \"pelvis\" } }\n", "{ \"bone\": \"pelvis\" }, \"yields\": \"second\" }\n"}},
       {"@:7:108: /transversals/1/yields: the second end is a bone, which never yields; write \"first\", or leave"}},
      {"BoneThatYieldsToo", {{"{ \"bone\": \"pelvis\" } }\n", "{ \"bone\": \"pelvis\" }, \"yields\": \"both\" }\n"}},
       {"/transversals/1/yields: the second end is a bone, which never yields"}},
      {"BoneAndPlace", {{"\"second\": { \"bone\": \"pelvis\" }", "\"second\": { \"bone\": \"pelvis\", \"at\": 0.5 }"}},
       {"@:7:76: /transversals/1/second: the second end has both a bone and a place on a muscle"}},
      {"NoSecondEnd", {{"\"second\": { \"bone\": \"pelvis\" }", "\"second\": { }"}},
       {"@:7:76: /transversals/1/second: the second end names neither a muscle nor a bone"}},
      {"NothingAtAll",
       {{"    { \"muscle\": \"vastus_r\", \"from\": 0.2, \"to\": 0.8, \"bones\": [\"pelvis\"] }\n", "    { }\n"}},
       {"@:10:5: /stay_out/0: 'muscle' is missing", "@:10:5: /stay_out/0: 'bones' is missing"}},
      {"NoStretch", {{"\"from\": 0.2", "\"from\": 0.8"}},
       {"@:10:37: /stay_out/0/from: no section lies from 0.8 to 0.8; let \"from\" be less than \"to\""}},
      {"NoBones", {{"[\"pelvis\"]", "[]"}}, {"@:10:62: /stay_out/0/bones: 0 elements; write at least 1"}},
      {"BoneNamedTwice", {{"[\"pelvis\"]", "[\"pelvis\", \"pelvis\"]"}}, {},
       {"@:10:73: /stay_out/0/bones/1: the bone 'pelvis' is named twice"}},
      {"TaggedTwice",
       {{"\"second\": { \"bone\": \"pelvis\" } }\n",
         "\"second\": { \"bone\": \"pelvis\" } },\n    { \"first\": { \"muscle\": \"vastus_r\", \"at\": 0.2501, "
         "\"angle\": 3 }, \"second\": { \"bone\": \"pelvis\" }, \"mirror\": false }\n"}},
       {}, {"@:8:5: /transversals/2: these places are tagged already, at "}},
      {"ContradictoryYields",
       {{"\"angle\": 4.5 } },\n",
         "\"angle\": 4.5 }, \"yields\": \"first\" },\n    { \"first\": { \"muscle\": \"soleus_r\", \"at\": 0.4, "
         "\"angle\": 4.5 }, \"second\": { \"muscle\": \"vastus_r\", \"at\": 0.5, \"angle\": 1.5 }, \"yields\": "
         "\"first\" },\n"}},
       {"@:7:5: /transversals/1: these places are tagged already, at "}},
      {"MirrorImageTwice",
       {{"\"bone\": \"pelvis\" } }\n",
         "\"bone\": \"pelvis\" } },\n    { \"first\": { \"muscle\": \"vastus_l\", \"at\": 0.25, \"angle\": 3.283185 }, "
         "\"second\": { \"bone\": \"pelvis\" } }\n"}},
       {}, {"@:8:5: /transversals/2: these places are tagged already", "the mirror image of these places is tagged"}},
      {"MirrorWithoutOtherSide",
       {{"\"angle\": 4.5 } }", "\"angle\": 4.5 }, \"mirror\": true }"}},
       {"@:6:138: /transversals/0/mirror: the other side lacks one of these muscles or bones"}},
      {"TaggedAndIgnored", {{"\"soleus_r\", \"bone\": \"pelvis\"", "\"vastus_r\", \"other\": \"soleus_r\""}},
       {"@:6:5: /transversals/0: the pair 'vastus_r' and 'soleus_r' is ignored, at "}},
      {"BonesTaggedAndIgnored", {{"\"soleus_r\", \"bone\": \"pelvis\"", "\"vastus_r\", \"bone\": \"pelvis\""}},
       {"@:7:5: /transversals/1: the pair 'vastus_r' and 'pelvis' is ignored, at ",
        "@:10:63: /stay_out/0/bones/0: the pair 'vastus_r' and 'pelvis' is ignored, at "}},
      {"AutomaticButIgnored",
       {{"\"soleus_r\", \"bone\": \"pelvis\"", "\"soleus_r\", \"other\": \"vastus_r\""},
        {"\"angle\": 4.5 } }", "\"angle\": 4.5 }, \"automatic\": true }"}},
       {}, {"@:6:5: /transversals/0: the pair 'vastus_r' and 'soleus_r' is ignored"}},
      {"IgnoredTwice",
       {{"\"bone\": \"pelvis\" }\n  ]",
         "\"bone\": \"pelvis\" },\n    { \"muscle\": \"soleus_r\", \"bone\": \"pelvis\" }\n  ]"}},
       {}, {"@:14:5: /ignore/1: the pair 'soleus_r' and 'pelvis' is ignored already, at "}},
      {"IgnoredWithItself", {{"\"soleus_r\", \"bone\": \"pelvis\"", "\"soleus_r\", \"other\": \"soleus_r\""}},
       {"@:13:5: /ignore/0: 'soleus_r' is paired with itself"}},
      {"IgnoredWithNothing", {{"\"soleus_r\", \"bone\": \"pelvis\"", "\"soleus_r\""}},
       {"@:13:5: /ignore/0: the pair lacks its second part"}},
      {"ManyAtOnce",
       {{"\"at\": 0.5", "\"at\": 2"}, {"\"second\": { \"bone\": \"pelvis\" }", "\"second\": { \"bone\": \"skull\" }"},
        {"\"to\": 0.8", "\"to\": 0.1"}, {"\"soleus_r\", \"bone\"", "\"soleus\", \"bone\""}},
       {"/transversals/0/first/at", "/stay_out/0/from", "/ignore/0/muscle", "/transversals/1/second/bone"}},
  };
  return all;
}

INSTANTIATE_TEST_SUITE_P(Table, BrokenCollision, testing::ValuesIn(table()),
                         [](const auto& case_info) { return std::string(case_info.param.name); });

TEST(BrokenCollisionFile, NotJsonMissingOrAFolder) {
  const ScratchFolder folder;
  const auto file = test::write_legs(folder, "<tags/>");
  const auto check = [&] { return test::errors_of(check_content(file, {.bone_fields = false}), folder.path()); };
  EXPECT_THAT(check(), HasSubstr("legs.collision.json:1:1: '<' where a value is wanted"));
  std::filesystem::remove(folder.path() / "legs.collision.json");
  EXPECT_THAT(check(), HasSubstr("/collision: the file 'legs.collision.json' does not exist"));
  std::filesystem::create_directory(folder.path() / "legs.collision.json");
  EXPECT_THAT(check(), HasSubstr("/collision: 'legs.collision.json' is a folder"));
}

TEST(BrokenCollisionFile, ByItselfItsFieldsAreChecked) {
  const ScratchFolder folder;
  const auto file = folder.write("a.collision.json", with(std::string(kTags), "\"at\": 0.5", "\"at\": 5"));
  EXPECT_THAT(test::errors_of(check_content(file), folder.path()),
              HasSubstr("a.collision.json:6:46: /transversals/0/first/at: 5 is out of range"));
  EXPECT_TRUE(check_content(folder.write("a.collision.json", kTags)).ok());
}

TEST(BrokenCollisionFile, NamesOfBrokenMusclesAreKnown) {
  const ScratchFolder folder;
  const auto file = test::write_legs(folder);
  folder.write("legs.character.json", with(test::legs_with_collision(), "0.005", "-1"));  // the soleus
  const Diagnostics found = check_content(file, {.bone_fields = false});
  ASSERT_EQ(found.errors.size(), 1u) << to_text(found);
  EXPECT_THAT(found.errors[0].path, HasSubstr("/pcsa"));
}

TEST(BrokenCollisionFile, AMeshOfAnUnknownBoneMayBeTheOneThatIsMissing) {
  const ScratchFolder folder;
  const auto file = test::write_legs(folder);
  const std::string_view kMesh = R"("bone_meshes": [{ "bone": "pelvis")";
  folder.write("legs.character.json", with(test::legs_with_collision(), kMesh, R"("bone_meshes": [{ "bone": "pelvs")"));
  const Diagnostics found = check_content(file, {.bone_fields = false});
  ASSERT_EQ(found.errors.size(), 1u) << to_text(found);
  EXPECT_THAT(found.errors[0].path, HasSubstr("/bone_meshes/0/bone"));
}

TEST(BrokenCollisionFile, MirrorNeedsARule) {
  const ScratchFolder folder;
  const auto file = test::write_legs(folder, with(std::string(kTags), "\"bone\": \"pelvis\" } }\n",
                                                  "\"bone\": \"pelvis\" }, \"mirror\": true }\n"));
  std::string text = test::legs_with_collision();
  constexpr std::string_view kRule =
      R"(  "mirror": { "axis": "x", "bones": [["_r", "_l"]], "names": [["_r", "_l"]] },)";
  text = with(text, kRule, "");
  folder.write("legs.character.json", with(text, "\"vastus_r\", \"mirror\": true", "\"vastus_r\""));
  const Diagnostics found = check_content(file, {.bone_fields = false});
  ASSERT_EQ(found.errors.size(), 1u) << to_text(found);
  EXPECT_THAT(found.errors[0].cause, HasSubstr("the character has no mirror rule"));
}

}  // namespace
}  // namespace fascicle::muscle
