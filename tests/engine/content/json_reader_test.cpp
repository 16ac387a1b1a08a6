#include "engine/content/json_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "engine/content/limit_errors.hpp"
#include "tests/engine/content/temporary_folder.hpp"

namespace fascicle {
namespace {

using testing::ElementsAre;

JsonDocument parse(std::string text) {
  Result<JsonDocument> result = parse_json(std::move(text), "f");
  EXPECT_TRUE(result.ok()) << to_text(result.diagnostics());
  return std::move(*result);
}

std::vector<std::string> messages(const Diagnostics& diagnostics) {
  std::vector<std::string> list;
  for (const Diagnostic& error : diagnostics.errors) list.push_back(to_string(error));
  return list;
}

// What reading the document's root as a T says.
template <class T, class... Range>
std::vector<std::string> read_errors(std::string text, Range... range) {
  const JsonDocument document = parse(std::move(text));
  Diagnostics diagnostics;
  T value{};
  EXPECT_FALSE(document.root().read(value, diagnostics, range...));
  return messages(diagnostics);
}

TEST(JsonNode, WrongKindsAreNamed) {
  EXPECT_THAT(read_errors<double>("\"abc\""),
              ElementsAre("f:1:1: the string \"abc\" where a number is wanted; write a number"));
  EXPECT_THAT(read_errors<double>("null"), ElementsAre("f:1:1: null where a number is wanted; write a number"));
  EXPECT_THAT(read_errors<std::string>("{}"), ElementsAre("f:1:1: an object where a string is wanted; write a string"));
  EXPECT_THAT(read_errors<bool>("1.5"),
              ElementsAre("f:1:1: the number 1.5 where true or false is wanted; write true or false"));
  EXPECT_THAT(read_errors<std::vector<float>>("true"),
              ElementsAre("f:1:1: true where an array is wanted; write an array"));
}

TEST(JsonNode, LongValuesAreCutInMessages) {
  const auto errors = read_errors<double>("\"" + std::string(500, 'x') + "\"");
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_LT(errors[0].size(), 150u);
}

TEST(JsonNode, RangesAreNamed) {
  EXPECT_THAT(read_errors<float>("-1", at_least(0)),
              ElementsAre("f:1:1: -1 is out of range; write a number at least 0"));
  EXPECT_THAT(read_errors<float>("0", above(0)), ElementsAre("f:1:1: 0 is out of range; write a number above 0"));
  EXPECT_THAT(read_errors<double>("1.5", between(0, 1)),
              ElementsAre("f:1:1: 1.5 is out of range; write a number between 0 and 1"));
  EXPECT_THAT(read_errors<float>("1e39"), ElementsAre("f:1:1: 1e+39 is too large; write a number below 3.4e38"));
  EXPECT_THAT(read_errors<float>("1e-60", above(0)),
              ElementsAre("f:1:1: 1e-60 is too close to 0 for single precision; write a larger number"));
}

TEST(JsonNode, IntegersRefuseFractionsAndOverflow) {
  EXPECT_THAT(read_errors<std::uint32_t>("1.5"),
              ElementsAre("f:1:1: 1.5 is not a whole number; write a whole number between 0 and 4294967295"));
  EXPECT_THAT(read_errors<std::uint32_t>("-1"),
              ElementsAre("f:1:1: -1 is out of range; write a whole number between 0 and 4294967295"));
  EXPECT_THAT(
      read_errors<std::int32_t>("2147483648"),
      ElementsAre("f:1:1: 2147483648 is out of range; write a whole number between -2147483648 and 2147483647"));
  EXPECT_THAT(read_errors<std::uint32_t>("5", at_least(6)),
              ElementsAre("f:1:1: 5 is out of range; write a whole number between 6 and 4294967295"));
  EXPECT_THAT(read_errors<std::int32_t>("1e300"),
              ElementsAre("f:1:1: 1e+300 is out of range; write a whole number between -2147483648 and 2147483647"));
}

TEST(JsonNode, VectorsAndQuaternionsAreChecked) {
  EXPECT_THAT(read_errors<glm::vec3>("[1, 2]"), ElementsAre("f:1:1: 2 elements; write exactly 3"));
  EXPECT_THAT(read_errors<glm::vec3>("[1, \"a\", null]"),
              ElementsAre("f:1:5: /1: the string \"a\" where a number is wanted; write a number",
                          "f:1:10: /2: null where a number is wanted; write a number"));
  EXPECT_THAT(read_errors<glm::quat>("[0, 0, 0, 2]"),
              ElementsAre("f:1:1: a quaternion of length 2; write a unit quaternion [x, y, z, w]; "
                          "[0, 0, 0, 1] turns nothing"));
}

TEST(JsonNode, AMillionErrorsOnOneLineEndSoon) {
  std::string text = "[true";
  for (int i = 0; i < 1000000; ++i) text += ",true";
  const JsonDocument document = parse(text + "]");
  Diagnostics diagnostics;
  std::vector<float> numbers;
  EXPECT_FALSE(document.root().read(numbers, diagnostics));
  ASSERT_EQ(diagnostics.errors.size(), 201u);
  EXPECT_EQ(to_string(diagnostics.errors.back()), "f: 999801 more are left out; mend those above, then check again");
  EXPECT_EQ(count_with_left_out(diagnostics.errors), 1000001u);
  for (int i = 0; i < 250; ++i) document.root().warning(diagnostics, "odd", "");
  EXPECT_EQ(diagnostics.warnings.size(), 201u);
  EXPECT_EQ(count_with_left_out(diagnostics.warnings), 250u);
}

TEST(JsonNode, ValuesAreRead) {
  const JsonDocument document = parse(R"({"d": 0.1, "i": -3, "u": 4294967295, "b": true, "s": "t", "v": [1, 2, 3],
                                          "q": [0, 0, 0.6, 0.8], "o": 7, "l": [1, 2]})");
  Diagnostics diagnostics;
  JsonObject object(document.root(), diagnostics);
  double d = 0;
  std::int32_t i = 0;
  std::uint32_t u = 0;
  bool b = false;
  std::string s;
  glm::vec3 v(0);
  glm::quat q(1, 0, 0, 0);
  std::optional<float> o;
  std::vector<float> l;
  EXPECT_TRUE(object.require("d", d) && object.require("i", i) && object.require("u", u) && object.require("b", b));
  EXPECT_TRUE(object.require("s", s) && object.require("v", v) && object.require("q", q));
  EXPECT_TRUE(object.optional("o", o, above(0)) && object.optional("l", l, at_least(0)));
  object.finish();
  EXPECT_TRUE(diagnostics.ok()) << to_text(diagnostics);
  EXPECT_EQ(d, 0.1);
  EXPECT_EQ(i, -3);
  EXPECT_EQ(u, 4294967295u);
  EXPECT_TRUE(b);
  EXPECT_EQ(s, "t");
  EXPECT_EQ(v, glm::vec3(1, 2, 3));
  EXPECT_FLOAT_EQ(q.z, 0.6f);
  EXPECT_FLOAT_EQ(q.w, 0.8f);
  EXPECT_EQ(o, 7.0f);
  EXPECT_THAT(l, ElementsAre(1.0f, 2.0f));
}

TEST(JsonNode, WalksMembersAndElementsInOrder) {
  const JsonDocument document = parse("{\n \"z\": [10, 20],\n \"a/b~\": {}\n}");
  std::vector<std::string> keys;
  for (const JsonNode member : document.root()) keys.emplace_back(member.key());
  EXPECT_THAT(keys, ElementsAre("z", "a/b~"));
  const JsonNode second = document.root().member("z").element(1);
  EXPECT_EQ(second.path(), "/z/1");
  EXPECT_EQ(second.line(), 2);
  EXPECT_EQ(second.column(), 12);
  EXPECT_EQ(second.text(), "20");
  EXPECT_EQ(document.root().member("a/b~").path(), "/a~1b~0");
  EXPECT_EQ(document.root().size(), 2u);
  EXPECT_FALSE(document.root().member("none").exists());
  EXPECT_FALSE(document.root().member("z").element(2).exists());
  EXPECT_EQ(document.nearest("/z/1"), second);
  EXPECT_EQ(document.nearest("/z/9"), document.root().member("z"));
  EXPECT_EQ(document.nearest("/none/1"), document.root());
}

TEST(JsonNode, MissingNodesAreQuiet) {
  const JsonNode missing;
  Diagnostics diagnostics;
  double number = 5;
  EXPECT_FALSE(missing.read(number, diagnostics));
  EXPECT_EQ(number, 5);
  EXPECT_FALSE(missing.require_object(diagnostics));
  EXPECT_EQ(missing.size(), 0u);
  EXPECT_EQ(missing.kind(), JsonKind::kMissing);
  EXPECT_TRUE(missing.begin() == missing.end());
  EXPECT_TRUE(diagnostics.ok());
}

TEST(JsonObject, ReportsEverythingInOneGo) {
  const JsonDocument document = parse("{\n  \"nmae\": \"x\",\n  \"radius\": -1,\n  \"level\": 2\n}");
  Diagnostics diagnostics;
  JsonObject object(document.root(), diagnostics);
  std::string name = "kept";
  float radius = 3, mass = 4;
  EXPECT_FALSE(object.require("name", name));
  EXPECT_FALSE(object.require("radius", radius, above(0)));
  EXPECT_FALSE(object.optional("mass", mass));
  object.finish();
  EXPECT_THAT(messages(diagnostics),
              ElementsAre("f:1:1: 'name' is missing; add \"name\"",
                          "f:3:13: /radius: -1 is out of range; write a number above 0",
                          "f:2:3: /nmae: unknown member 'nmae'; did you mean 'name'?",
                          "f:4:3: /level: unknown member 'level'; known members: name, radius, mass"));
  EXPECT_EQ(name, "kept");
  EXPECT_EQ(radius, 3.0f);
  EXPECT_EQ(mass, 4.0f);
}

TEST(JsonObject, OfAnotherKindSaysSoOnce) {
  const JsonDocument document = parse("[1]");
  Diagnostics diagnostics;
  JsonObject object(document.root(), diagnostics);
  float number = 0;
  EXPECT_FALSE(object.require("name", number));
  object.finish();
  EXPECT_FALSE(object.valid());
  EXPECT_THAT(messages(diagnostics), ElementsAre("f:1:1: an array where an object is wanted; write an object"));
}

TEST(JsonObject, ChoicesAndArrays) {
  const JsonDocument document = parse(R"({"axis": "X", "list": [1], "none": "q"})");
  Diagnostics diagnostics;
  JsonObject object(document.root(), diagnostics);
  std::size_t axis = 9;
  EXPECT_FALSE(object.require_choice("axis", axis, {"x", "y", "z"}));
  EXPECT_FALSE(object.require_array("list", 2).exists());
  EXPECT_FALSE(object.optional_array("absent").exists());
  EXPECT_FALSE(object.optional_choice("none", axis, {"left", "right"}));
  EXPECT_THAT(messages(diagnostics), ElementsAre("f:1:10: /axis: unknown value 'X'; did you mean 'x'?",
                                                 "f:1:23: /list: 1 element; write at least 2",
                                                 "f:1:36: /none: unknown value 'q'; known values: left, right"));
  EXPECT_EQ(axis, 9u);
}

TEST(JsonDocument, NodesSurviveAMove) {
  JsonDocument first = parse("{\"a\": 1}");
  const JsonNode node = first.root().member("a");
  const JsonDocument second = std::move(first);
  EXPECT_EQ(node.text(), "1");
  EXPECT_EQ(second.root().member("a"), node);
}

TEST(ReadJsonFile, ReadsAFileAndReportsAMissingOne) {
  const test::TemporaryFolder folder;
  test::write_in_place(folder / "a.json", "{\"a\": [}");
  const Result<JsonDocument> result = read_json_file(folder / "a.json");
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(to_string(result.diagnostics().errors[0]),
            (folder / "a.json").string() +
                ":1:8: /a: '}' where a value is wanted; write a number, string, array, object, true, false or null");
  EXPECT_FALSE(read_json_file(folder / "none.json").ok());
}

}  // namespace
}  // namespace fascicle
