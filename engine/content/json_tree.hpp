// The parsed form behind JsonNode: values in one flat array in the order of the text, linked by indices.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/content/json_reader.hpp"
#include "engine/content/text_position.hpp"

namespace fascicle::detail {

constexpr std::uint32_t kNoJson = 0xffffffff;

struct JsonValue {
  JsonKind kind = JsonKind::kNull;
  bool boolean = false;
  double number = 0.0;
  std::uint32_t begin = 0, end = 0;  // of the value, in bytes of the text
  std::uint32_t key_begin = 0;       // of its name
  std::uint32_t key = kNoJson;       // index into strings, for members
  std::uint32_t string = kNoJson;    // index into strings, for strings
  std::uint32_t parent = kNoJson;
  std::uint32_t first_child = kNoJson;
  std::uint32_t next_sibling = kNoJson;
  std::uint32_t child_count = 0;
  std::uint32_t index = 0;  // among its siblings
};

struct JsonTree {
  std::string file;
  std::string text;
  LineTable lines;
  std::vector<JsonValue> values;     // values[0] is the root
  std::vector<std::string> strings;  // unescaped

  std::string path(std::uint32_t value) const;
  Diagnostic diagnostic(std::uint32_t value, std::size_t offset, std::string cause, std::string remedy) const;
};

// Fills values and strings from text. False after a syntax error, which is appended like every duplicate name.
bool parse_json_tree(JsonTree& tree, Diagnostics& diagnostics);

}  // namespace fascicle::detail
