// JSON that remembers where everything stands, so that every error names file, line, column and JSON pointer.
//
// The text is parsed strictly (RFC 8259: no comments, no trailing commas, no NaN, no duplicate names, nesting up to 64)
// into a JsonDocument. A JsonNode is a cheap view of one value; it is valid as long as its document. JsonObject reads
// the members of an object by name, appends what is wrong to a Diagnostics and goes on, so that all errors of a file
// are found in one go:
//
//   JsonObject object(node, diagnostics);
//   object.require("name", muscle.name);
//   object.require("position", point.position);
//   object.optional("max_isometric_force", hill.max_isometric_force, at_least(0));   // unchanged when absent
//   for (JsonNode via : object.optional_array("via")) read_point(via, ...);
//   object.finish();   // every member that nobody asked for is an error, with the nearest known name as remedy
//
// Every function that reads returns whether the value was there and right; where it returns false because the value is
// wrong, or because it is required and missing, it has appended an error, and `out` is unchanged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "engine/content/result.hpp"

namespace fascicle {

enum class JsonKind : std::uint8_t { kMissing, kNull, kBoolean, kNumber, kString, kArray, kObject };

namespace detail {
struct JsonTree;
}

// Limits of a number or of each number of a list. Numbers are always finite.
struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  // min itself is excluded
};
constexpr NumberRange at_least(double min) { return {.min = min}; }
constexpr NumberRange above(double min) { return {.min = min, .above_min = true}; }
constexpr NumberRange between(double min, double max) { return {.min = min, .max = max}; }

class JsonNode {
 public:
  JsonNode() = default;  // missing
  JsonNode(const detail::JsonTree* tree, std::uint32_t index) : tree_(tree), index_(index) {}

  JsonKind kind() const;
  bool exists() const { return tree_ != nullptr; }
  bool is_object() const { return kind() == JsonKind::kObject; }
  bool is_array() const { return kind() == JsonKind::kArray; }
  bool is_string() const { return kind() == JsonKind::kString; }
  bool is_number() const { return kind() == JsonKind::kNumber; }

  // Children, in the order of the file.
  class Iterator {
   public:
    using value_type = JsonNode;
    using difference_type = std::ptrdiff_t;
    using iterator_category = std::forward_iterator_tag;
    Iterator() = default;
    Iterator(const detail::JsonTree* tree, std::uint32_t index) : tree_(tree), index_(index) {}
    JsonNode operator*() const { return {tree_, index_}; }
    Iterator& operator++();
    Iterator operator++(int) {
      Iterator old = *this;
      ++*this;
      return old;
    }
    bool operator==(const Iterator& other) const { return index_ == other.index_; }

   private:
    const detail::JsonTree* tree_ = nullptr;
    std::uint32_t index_ = 0xffffffff;
  };
  Iterator begin() const;  // members of an object or elements of an array; empty for other kinds
  Iterator end() const { return {}; }
  std::size_t size() const;

  std::string_view key() const;                  // name in the parent object, empty for array elements and the root
  JsonNode member(std::string_view name) const;  // missing when there is none
  JsonNode element(std::size_t index) const;     // missing when out of range; walks the list

  std::string_view text() const;  // as it stands in the file
  int line() const;
  int column() const;
  std::string path() const;  // JSON pointer: "/muscles/3/origin"; empty for the root
  const std::string& file() const;

  // This place, with a cause and a remedy. Beyond 200 errors in `diagnostics` more are only counted, in a last entry.
  Diagnostic where(std::string cause = {}, std::string remedy = {}) const;
  void error(Diagnostics& diagnostics, std::string cause, std::string remedy) const;
  void warning(Diagnostics& diagnostics, std::string cause, std::string remedy) const;
  // The same, at the member's name rather than at its value.
  void error_at_key(Diagnostics& diagnostics, std::string cause, std::string remedy) const;

  bool require_object(Diagnostics& diagnostics) const;
  bool require_array(Diagnostics& diagnostics, std::size_t min_size = 0,
                     std::size_t max_size = std::numeric_limits<std::size_t>::max()) const;

  // Checked values; each appends an error and leaves `out` unchanged when the value is of another kind or out of range.
  // Integers refuse fractions and overflow. vec3: 3 numbers. quat: 4 numbers x, y, z, w, within 1e-3 of unit length,
  // normalised. Strings are UTF-8 without NUL.
  bool read(double& out, Diagnostics& diagnostics, NumberRange range = {}) const;
  bool read(float& out, Diagnostics& diagnostics, NumberRange range = {}) const;
  bool read(std::int32_t& out, Diagnostics& diagnostics, NumberRange range = {}) const;
  bool read(std::uint32_t& out, Diagnostics& diagnostics, NumberRange range = {}) const;
  bool read(bool& out, Diagnostics& diagnostics) const;
  bool read(std::string& out, Diagnostics& diagnostics) const;
  bool read(glm::vec3& out, Diagnostics& diagnostics, NumberRange range = {}) const;
  bool read(glm::quat& out, Diagnostics& diagnostics) const;
  bool read(std::vector<float>& out, Diagnostics& diagnostics, NumberRange range = {}) const;
  bool read(std::vector<double>& out, Diagnostics& diagnostics, NumberRange range = {}) const;
  bool read(std::vector<std::string>& out, Diagnostics& diagnostics) const;
  template <class T, class... Range>
  bool read(std::optional<T>& out, Diagnostics& diagnostics, Range... range) const {
    T value{};
    if (!read(value, diagnostics, range...)) return false;
    out = value;
    return true;
  }
  // A string that must be one of `choices`; `out` becomes its index.
  bool read_choice(std::size_t& out, Diagnostics& diagnostics, std::span<const std::string_view> choices) const;

  friend bool operator==(const JsonNode&, const JsonNode&) = default;

 private:
  const detail::JsonTree* tree_ = nullptr;
  std::uint32_t index_ = 0;
};

// Owns the text and its tree. Moving it keeps its nodes valid.
class JsonDocument {
 public:
  JsonNode root() const;
  // The value at a JSON pointer such as "/muscles/3/name" (without escapes), or where there is none its nearest
  // ancestor.
  JsonNode nearest(std::string_view pointer) const;
  const std::string& file() const;
  std::string_view text() const;

 private:
  friend Result<JsonDocument> parse_json(std::string text, std::string file_name);
  explicit JsonDocument(std::shared_ptr<const detail::JsonTree> tree) : tree_(std::move(tree)) {}
  std::shared_ptr<const detail::JsonTree> tree_;
};

// Errors: unreadable, larger than 1 GiB or of more than 16 million values, empty, not UTF-8, not JSON (the first syntax
// error), nested too deeply, and every duplicate name.
Result<JsonDocument> read_json_file(const std::filesystem::path& file);
Result<JsonDocument> parse_json(std::string text, std::string file_name);

// Reads the members of one object and keeps account of the names that were asked for.
class JsonObject {
 public:
  // Appends an error when `node` is not an object; every later call then returns false or a missing node in silence.
  JsonObject(JsonNode node, Diagnostics& diagnostics);
  JsonObject(const JsonObject&) = delete;
  JsonObject& operator=(const JsonObject&) = delete;

  bool valid() const { return valid_; }
  JsonNode node() const { return node_; }
  // The names that were asked for so far, in order.
  std::span<const std::string_view> known() const { return known_; }
  Diagnostics& diagnostics() { return *diagnostics_; }

  // `name` must outlive this object (a literal). A required member that is missing is an error at the object.
  JsonNode require(std::string_view name);
  JsonNode optional(std::string_view name);
  JsonNode require_array(std::string_view name, std::size_t min_size = 0,
                         std::size_t max_size = std::numeric_limits<std::size_t>::max());
  JsonNode optional_array(std::string_view name, std::size_t min_size = 0,
                          std::size_t max_size = std::numeric_limits<std::size_t>::max());
  template <class T, class... Range>
  bool require(std::string_view name, T& out, Range... range) {
    const JsonNode found = require(name);
    return found.exists() && found.read(out, *diagnostics_, range...);
  }
  template <class T, class... Range>
  bool optional(std::string_view name, T& out, Range... range) {
    const JsonNode found = optional(name);
    return found.exists() && found.read(out, *diagnostics_, range...);
  }
  // `out` becomes the index of the string among `choices`.
  bool require_choice(std::string_view name, std::size_t& out, std::initializer_list<std::string_view> choices);
  bool optional_choice(std::string_view name, std::size_t& out, std::initializer_list<std::string_view> choices);

  // Appends an error for each member that was never asked for.
  void finish();

 private:
  JsonNode node_;
  Diagnostics* diagnostics_;
  bool valid_;
  std::vector<std::string_view> known_;
};

}  // namespace fascicle
