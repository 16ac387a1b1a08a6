// Beside the loop's tests, which have a JSON library to check against.
#include "engine/content/quote_json.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/engine/loop/parse_json.hpp"

namespace fascicle {
namespace {

using namespace std::string_literals;

TEST(QuoteJson, Table) {
  struct Row {
    std::string text, expected;
  };
  const Row rows[] = {
      {"", "\"\""},
      {"plain", "\"plain\""},
      {"a\"b\\c/", "\"a\\\"b\\\\c/\""},
      {"line\nbreak\ttab\x01", "\"line\\nbreak\\ttab\\u0001\""},
      {"nul\0inside"s, "\"nul\\u0000inside\""},
      {"\xc3\xa9 \xe2\x82\xac \xf0\x9f\x92\xaa", "\"\xc3\xa9 \xe2\x82\xac \xf0\x9f\x92\xaa\""},
      {"stray \x80", "\"stray \\ufffd\""},
      {"overlong \xc0\xaf", "\"overlong \\ufffd\\ufffd\""},
      {"overlong \xe0\x80\x80", "\"overlong \\ufffd\\ufffd\\ufffd\""},
      {"surrogate \xed\xa0\x80", "\"surrogate \\ufffd\\ufffd\\ufffd\""},
      {"too high \xf4\x90\x80\x80", "\"too high \\ufffd\\ufffd\\ufffd\\ufffd\""},
      {"cut \xe2\x82", "\"cut \\ufffd\\ufffd\""},
      {"cut \xf0", "\"cut \\ufffd\""},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(quote_json(row.text), row.expected);
    test::parse_json("[" + quote_json(row.text) + "]");
  }
}

TEST(QuoteJson, AnyBytesGiveValidJsonAndAsciiComesBack) {
  for (int first = 0; first < 256; ++first) {
    for (const int second : {0x00, 0x22, 0x41, 0x7f, 0x80, 0xa0, 0xbf, 0xc2, 0xff}) {
      const std::string text{static_cast<char>(first), static_cast<char>(second)};
      const Json::Value value = test::parse_json("[" + quote_json(text) + "]");
      if (first < 0x80 && second < 0x80) {
        EXPECT_EQ(value[0].asString(), text);
      }
    }
  }
}

}  // namespace
}  // namespace fascicle
