// Texts that are no JSON, each with the whole message that it must give; then what JSON allows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/content/json_reader.hpp"

namespace fascicle {
namespace {

using namespace std::literals;

struct Broken {
  std::string text;
  std::string message;
};

TEST(JsonSyntax, BrokenTextsAreNamedWithPlaceCauseAndRemedy) {
  const Broken cases[] = {
      {"", "f:1:1: the file is empty; write a JSON document, such as { }"},
      {" \n\t ", "f:1:1: the file is empty; write a JSON document, such as { }"},
      {"\xef\xbb\xbf{}", "f:1:1: the file starts with a byte order mark; save it as UTF-8 without BOM"},
      {"{\"a\": \"\xff\"}", "f:1:8: byte 0xff is not UTF-8; save the file as UTF-8; is it a text file?"},
      {"\"\xc0\xaf\"", "f:1:2: byte 0xc0 is not UTF-8; save the file as UTF-8; is it a text file?"},
      {"\"\xed\xa0\x80\"", "f:1:2: byte 0xed is not UTF-8; save the file as UTF-8; is it a text file?"},
      {"\"\xf5\x80\x80\x80\"", "f:1:2: byte 0xf5 is not UTF-8; save the file as UTF-8; is it a text file?"},
      {"glTF\x02"s, "f:1:1: 'glTF' where a value is wanted; strings stand in double quotes"},
      {"{", "f:1:2: the file ends inside the object that starts at 1:1; is it cut off? Close it with '}'"},
      {"{\n  \"a\": [1,",
       "f:2:11: /a: the file ends inside the array that starts at 2:8; is it cut off? Close it with ']'"},
      {"{\"a\"", "f:1:5: the file ends inside the object that starts at 1:1; is it cut off? Close it with '}'"},
      {"{\"a\":", "f:1:6: the file ends inside the object that starts at 1:1; is it cut off? Close it with '}'"},
      {"{\"a\": \"b", "f:1:7: the file ends inside a string; is it cut off? Close it with \""},
      {"{\"a\": 1,}", "f:1:9: a comma stands before '}'; remove the comma"},
      {"[1,]", "f:1:4: a comma stands before ']'; remove the comma"},
      {"[1 2]", "f:1:4: '2' where ',' or ']' is wanted; is a comma missing before it?"},
      {"{\"a\": 1 \"b\": 2}", "f:1:9: '\"' where ',' or '}' is wanted; is a comma missing before it?"},
      {"{\"a\" 1}", "f:1:6: '1' after the name \"a\"; write ':' and the value"},
      {"{a: 1}", "f:1:2: 'a' where a member's name is wanted; write the name in double quotes"},
      {"{'a': 1}", "f:1:2: ''' where a member's name is wanted; write the name in double quotes"},
      {"['a']", "f:1:2: a string in single quotes; use double quotes"},
      {"{} {}", "f:1:4: '{' after the end of the document; remove it; a file holds one JSON value"},
      {"// note\n{}", "f:1:1: a comment; JSON has no comments: remove it"},
      {"{\n// note\n}", "f:2:1: a comment; JSON has no comments: remove it"},
      {"[1 /* note */]", "f:1:4: a comment; JSON has no comments: remove it"},
      {"[NaN]", "f:1:2: NaN is not a number in JSON; write a finite number"},
      {"{\"a\": Infinity}", "f:1:7: Infinity is not a number in JSON; write a finite number"},
      {"[-Infinity]", "f:1:2: '-Infinity' is not a number; write a finite number, such as -0.5"},
      {"[01]", "f:1:2: '01' has a leading zero; remove the zero"},
      {"[1.]", "f:1:2: '1.' has no digits after the point; write it as in 1.0"},
      {"[.5]", "f:1:2: a number starts with '.'; write it as in 0.5 or 1e-3"},
      {"[+1]", "f:1:2: a number starts with '+'; write it as in 0.5 or 1e-3"},
      {"[1e]", "f:1:2: '1e' has no digits in its exponent; write it as in 1e-3"},
      {"[0x10]", "f:1:2: '0x10' is not a number; write a finite number"},
      {"[1.2.3]", "f:1:2: '1.2.3' is not a number; write a finite number"},
      {"[true, False]", "f:1:8: 'False' where a value is wanted; strings stand in double quotes"},
      {"[\"a\nb\"]", "f:1:2: a string without its closing quote on the line; close it with \", or write \\n"},
      {"[\"a\x01\"]", "f:1:4: control character 1 in a string; write it as \\u0001"},
      {"[\"\\x\"]", "f:1:3: an unknown escape in a string; write a backslash as \\\\"},
      {"[\"\\u12\"]",
       "f:1:3: a \\u escape that is no character; write four hexadecimal digits, or the character itself"},
      {"[\"\\ud800\"]",
       "f:1:3: a \\u escape that is no character; write four hexadecimal digits, or the character itself"},
      {"[\"\\u0000\"]", "f:1:3: character 0 in a string; remove it"},
      {"{\"a\": 1e999}", "f:1:7: /a: 1e999 is too large for a number; write a number below 1e308"},
      {"{\"a\": 1,\n \"b\": 2, \"a\": 3}", "f:2:10: /a: 'a' stands twice, first at 1:2; remove one of them"},
      {std::string(65, '['), "f:1:65: " +
                                 [] {
                                   std::string p;
                                   for (int i = 0; i < 63; ++i) p += "/0";
                                   return p;
                                 }() +
                                 ": nested deeper than 64 levels; flatten it; is it the right file?"},
  };
  for (const Broken& broken : cases) {
    const Result<JsonDocument> result = parse_json(broken.text, "f");
    ASSERT_FALSE(result.ok()) << broken.text;
    EXPECT_EQ(to_string(result.diagnostics().errors[0]), broken.message) << broken.text;
  }
}

TEST(JsonSyntax, AllDuplicatesAndHugeNumbersAreFoundInOneGo) {
  const Result<JsonDocument> result = parse_json(R"({"a": 1e400, "b": {"c": 0, "c": 1, "c": 2}, "a": -1e400})", "f");
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.diagnostics().errors.size(), 5u);
}

TEST(JsonSyntax, ErrorsBeyondTheLimitAreCounted) {
  std::string text = R"({"b": 1e400)";
  for (int i = 0; i < 150; ++i) text += R"(, "a": 1e400)";
  const Result<JsonDocument> result = parse_json(text + "}", "f");
  ASSERT_FALSE(result.ok());
  ASSERT_EQ(result.diagnostics().errors.size(), 101u);  // of 151 numbers and 149 duplicates
  EXPECT_EQ(to_string(result.diagnostics().errors.back()),
            "f: 200 more are left out; mend those above, then check again");
}

TEST(JsonSyntax, DepthIsCountedNotSummed) {
  std::string text = "[";
  for (int i = 0; i < 200; ++i) text += std::string(i > 0 ? "," : "") + "[[]]";
  EXPECT_TRUE(parse_json(text + "]", "f").ok());
  EXPECT_TRUE(parse_json(std::string(64, '[') + std::string(64, ']'), "f").ok());
}

TEST(JsonSyntax, NumbersKeepTheirValue) {
  const Result<JsonDocument> result =
      parse_json("[0, -0, 1.5, -2e3, 1E+2, 1e-400, 0e999, 0.1, 12345678901234567890]", "f");
  ASSERT_TRUE(result.ok()) << to_text(result.diagnostics());
  std::vector<double> numbers;
  Diagnostics diagnostics;
  ASSERT_TRUE(result->root().read(numbers, diagnostics));
  EXPECT_EQ(numbers, (std::vector<double>{0, 0, 1.5, -2000, 100, 0, 0, 0.1, 12345678901234567890.0}));
}

TEST(JsonSyntax, StringsAreUnescaped) {
  const Result<JsonDocument> result = parse_json(R"(["\"\\\/\b\f\n\r\t", "\u00e4\u20ac\ud83d\ude00", "ä€"])", "f");
  ASSERT_TRUE(result.ok()) << to_text(result.diagnostics());
  std::vector<std::string> strings;
  Diagnostics diagnostics;
  ASSERT_TRUE(result->root().read(strings, diagnostics));
  EXPECT_EQ(strings, (std::vector<std::string>{"\"\\/\b\f\n\r\t", "ä€😀", "ä€"}));
}

}  // namespace
}  // namespace fascicle
