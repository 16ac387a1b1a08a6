#include "engine/content/json_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

#include "engine/content/closest_name.hpp"
#include "engine/content/file_text.hpp"
#include "engine/content/json_tree.hpp"
#include "engine/content/limit_errors.hpp"

namespace fascicle {
namespace {

using detail::JsonTree;
using detail::JsonValue;
using detail::kNoJson;

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 30;
constexpr std::size_t kMaxShown = 40;  // bytes of an offending value in a message
// Enough to mend a file by; each costs a walk along its line, and a hostile file has millions.
constexpr std::size_t kMaxErrors = 200;
constexpr float kUnitTolerance = 1e-3f;

std::string_view kind_words(JsonKind kind) {
  switch (kind) {
    case JsonKind::kMissing:
      return "nothing";
    case JsonKind::kNull:
      return "null";
    case JsonKind::kBoolean:
      return "true or false";
    case JsonKind::kNumber:
      return "a number";
    case JsonKind::kString:
      return "a string";
    case JsonKind::kArray:
      return "an array";
    case JsonKind::kObject:
      return "an object";
  }
  return "";
}

// The text from `begin`, cut to a length that suits a message, never inside a UTF-8 sequence.
std::string shown(std::string_view text) {
  if (text.size() <= kMaxShown) return std::string(text);
  std::size_t length = kMaxShown;
  while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xc0u) == 0x80u) --length;
  return std::string(text.substr(0, length)) + "...";
}

const JsonValue& value_of(const JsonTree* tree, std::uint32_t index) { return tree->values[index]; }

std::string describe(const JsonTree* tree, const JsonValue& value) {
  const std::string_view text = std::string_view(tree->text).substr(value.begin, value.end - value.begin);
  switch (value.kind) {
    case JsonKind::kBoolean:
    case JsonKind::kNull:
      return std::string(text);
    case JsonKind::kNumber:
      return "the number " + shown(text);
    case JsonKind::kString:
      return "the string " + shown(text);
    default:
      return std::string(kind_words(value.kind));
  }
}

bool in_range(double number, const NumberRange& range) {
  return number >= range.min && number <= range.max && !(range.above_min && number == range.min);
}

std::string range_words(const NumberRange& range) {
  const bool low = range.min > -std::numeric_limits<double>::infinity();
  const bool high = range.max < std::numeric_limits<double>::infinity();
  if (low && high && !range.above_min) return fmt::format("between {} and {}", range.min, range.max);
  std::string words;
  if (low) words = fmt::format("{} {}", range.above_min ? "above" : "at least", range.min);
  if (high) words += fmt::format("{}at most {}", low ? " and " : "", range.max);
  return words;
}

}  // namespace

namespace detail {

std::string JsonTree::path(std::uint32_t value) const {
  std::vector<std::uint32_t> chain;
  for (; value != kNoJson && values[value].parent != kNoJson; value = values[value].parent) chain.push_back(value);
  std::string pointer;
  for (auto it = chain.rbegin(); it != chain.rend(); ++it) {
    pointer += '/';
    if (values[*it].key == kNoJson) {
      pointer += std::to_string(values[*it].index);
      continue;
    }
    for (const char c : strings[values[*it].key]) {  // RFC 6901 escapes; control characters would break the line
      if (c == '~')
        pointer += "~0";
      else if (c == '/')
        pointer += "~1";
      else
        pointer += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return pointer;
}

Diagnostic JsonTree::diagnostic(std::uint32_t value, std::size_t offset, std::string cause, std::string remedy) const {
  const TextPosition position = lines.position(text, offset);
  return {file, position.line, position.column, path(value), std::move(cause), std::move(remedy)};
}

}  // namespace detail

JsonNode::Iterator& JsonNode::Iterator::operator++() {
  index_ = value_of(tree_, index_).next_sibling;
  return *this;
}

JsonKind JsonNode::kind() const { return exists() ? value_of(tree_, index_).kind : JsonKind::kMissing; }

JsonNode::Iterator JsonNode::begin() const {
  return exists() ? Iterator(tree_, value_of(tree_, index_).first_child) : Iterator();
}

std::size_t JsonNode::size() const { return exists() ? value_of(tree_, index_).child_count : 0; }

std::string_view JsonNode::key() const {
  if (!exists() || value_of(tree_, index_).key == kNoJson) return {};
  return tree_->strings[value_of(tree_, index_).key];
}

JsonNode JsonNode::member(std::string_view name) const {
  if (!is_object()) return {};
  for (const JsonNode child : *this) {
    if (child.key() == name) return child;
  }
  return {};
}

JsonNode JsonNode::element(std::size_t index) const {
  if (!is_array() || index >= size()) return {};
  Iterator at = begin();
  for (; index > 0; --index) ++at;
  return *at;
}

std::string_view JsonNode::text() const {
  if (!exists()) return {};
  const JsonValue& value = value_of(tree_, index_);
  return std::string_view(tree_->text).substr(value.begin, value.end - value.begin);
}

int JsonNode::line() const { return where().line; }
int JsonNode::column() const { return where().column; }
std::string JsonNode::path() const { return exists() ? tree_->path(index_) : std::string(); }

const std::string& JsonNode::file() const {
  static const std::string kNone;
  return exists() ? tree_->file : kNone;
}

Diagnostic JsonNode::where(std::string cause, std::string remedy) const {
  if (!exists()) return {{}, 0, 0, {}, std::move(cause), std::move(remedy)};
  return tree_->diagnostic(index_, value_of(tree_, index_).begin, std::move(cause), std::move(remedy));
}

void JsonNode::error(Diagnostics& diagnostics, std::string cause, std::string remedy) const {
  if (!has_room(diagnostics.errors, kMaxErrors, file())) return;
  diagnostics.errors.push_back(where(std::move(cause), std::move(remedy)));
}

void JsonNode::warning(Diagnostics& diagnostics, std::string cause, std::string remedy) const {
  if (!has_room(diagnostics.warnings, kMaxErrors, file())) return;
  diagnostics.warnings.push_back(where(std::move(cause), std::move(remedy)));
}

void JsonNode::error_at_key(Diagnostics& diagnostics, std::string cause, std::string remedy) const {
  if (key().data() == nullptr) return error(diagnostics, std::move(cause), std::move(remedy));
  if (!has_room(diagnostics.errors, kMaxErrors, file())) return;
  diagnostics.errors.push_back(
      tree_->diagnostic(index_, value_of(tree_, index_).key_begin, std::move(cause), std::move(remedy)));
}

namespace {

// False in silence for a missing node: its absence was reported, or allowed, where it was looked up.
bool require_kind(const JsonNode& node, const JsonTree* tree, std::uint32_t index, JsonKind kind,
                  Diagnostics& diagnostics) {
  if (!node.exists()) return false;
  if (node.kind() == kind) return true;
  node.error(diagnostics, fmt::format("{} where {} is wanted", describe(tree, value_of(tree, index)), kind_words(kind)),
             fmt::format("write {}", kind_words(kind)));
  return false;
}

}  // namespace

bool JsonNode::require_object(Diagnostics& diagnostics) const {
  return require_kind(*this, tree_, index_, JsonKind::kObject, diagnostics);
}

bool JsonNode::require_array(Diagnostics& diagnostics, std::size_t min_size, std::size_t max_size) const {
  if (!require_kind(*this, tree_, index_, JsonKind::kArray, diagnostics)) return false;
  if (size() >= min_size && size() <= max_size) return true;
  const std::string wanted = min_size == max_size ? fmt::format("exactly {}", min_size)
                             : size() < min_size  ? fmt::format("at least {}", min_size)
                                                  : fmt::format("at most {}", max_size);
  error(diagnostics, fmt::format("{} element{}", size(), size() == 1 ? "" : "s"), fmt::format("write {}", wanted));
  return false;
}

bool JsonNode::read(double& out, Diagnostics& diagnostics, NumberRange range) const {
  if (!require_kind(*this, tree_, index_, JsonKind::kNumber, diagnostics)) return false;
  const double number = value_of(tree_, index_).number;
  if (!in_range(number, range)) {
    error(diagnostics, fmt::format("{} is out of range", number), fmt::format("write a number {}", range_words(range)));
    return false;
  }
  out = number;
  return true;
}

bool JsonNode::read(float& out, Diagnostics& diagnostics, NumberRange range) const {
  double number = 0.0;
  if (!read(number, diagnostics, range)) return false;
  if (std::abs(number) > static_cast<double>(std::numeric_limits<float>::max())) {
    error(diagnostics, fmt::format("{} is too large", number), "write a number below 3.4e38");
    return false;
  }
  // A number just above an excluded minimum must not round onto it.
  const auto rounded = static_cast<float>(number);
  if (range.above_min && static_cast<double>(rounded) <= range.min) {
    error(diagnostics, fmt::format("{} is too close to {} for single precision", number, range.min),
          "write a larger number");
    return false;
  }
  out = rounded;
  return true;
}

namespace {

template <class Integer>
bool read_integer(const JsonNode& node, Integer& out, Diagnostics& diagnostics, const NumberRange& range) {
  double number = 0.0;
  if (!node.read(number, diagnostics)) return false;
  NumberRange limits = range;
  limits.min = std::max(limits.min, static_cast<double>(std::numeric_limits<Integer>::min()));
  limits.max = std::min(limits.max, static_cast<double>(std::numeric_limits<Integer>::max()));
  limits.above_min = range.above_min && limits.min == range.min;
  if (number != std::floor(number) || !in_range(number, limits)) {
    node.error(diagnostics,
               fmt::format("{} is {}", number, number != std::floor(number) ? "not a whole number" : "out of range"),
               fmt::format("write a whole number {}", range_words(limits)));
    return false;
  }
  out = static_cast<Integer>(number);
  return true;
}

}  // namespace

bool JsonNode::read(std::int32_t& out, Diagnostics& diagnostics, NumberRange range) const {
  return read_integer(*this, out, diagnostics, range);
}
bool JsonNode::read(std::uint32_t& out, Diagnostics& diagnostics, NumberRange range) const {
  return read_integer(*this, out, diagnostics, range);
}

bool JsonNode::read(bool& out, Diagnostics& diagnostics) const {
  if (!require_kind(*this, tree_, index_, JsonKind::kBoolean, diagnostics)) return false;
  out = value_of(tree_, index_).boolean;
  return true;
}

bool JsonNode::read(std::string& out, Diagnostics& diagnostics) const {
  if (!require_kind(*this, tree_, index_, JsonKind::kString, diagnostics)) return false;
  out = tree_->strings[value_of(tree_, index_).string];
  return true;
}

bool JsonNode::read(glm::vec3& out, Diagnostics& diagnostics, NumberRange range) const {
  if (!require_array(diagnostics, 3, 3)) return false;
  std::vector<float> numbers;
  if (!read(numbers, diagnostics, range)) return false;
  out = {numbers[0], numbers[1], numbers[2]};
  return true;
}

bool JsonNode::read(glm::quat& out, Diagnostics& diagnostics) const {
  if (!require_array(diagnostics, 4, 4)) return false;
  std::vector<float> numbers;
  if (!read(numbers, diagnostics)) return false;
  const glm::quat quat(numbers[3], numbers[0], numbers[1], numbers[2]);
  const float length = glm::length(quat);
  if (!(std::abs(length - 1.0f) <= kUnitTolerance)) {
    error(diagnostics, fmt::format("a quaternion of length {:.4g}", length),
          "write a unit quaternion [x, y, z, w]; [0, 0, 0, 1] turns nothing");
    return false;
  }
  out = quat / length;
  return true;
}

namespace {

template <class T, class... Range>
bool read_list(const JsonNode& node, std::vector<T>& out, Diagnostics& diagnostics, Range... range) {
  if (!node.require_array(diagnostics)) return false;
  std::vector<T> list;
  list.reserve(node.size());
  bool ok = true;
  for (const JsonNode child : node) {
    T value{};
    ok = child.read(value, diagnostics, range...) && ok;
    list.push_back(std::move(value));
  }
  if (ok) out = std::move(list);
  return ok;
}

}  // namespace

bool JsonNode::read(std::vector<float>& out, Diagnostics& diagnostics, NumberRange range) const {
  return read_list(*this, out, diagnostics, range);
}
bool JsonNode::read(std::vector<double>& out, Diagnostics& diagnostics, NumberRange range) const {
  return read_list(*this, out, diagnostics, range);
}
bool JsonNode::read(std::vector<std::string>& out, Diagnostics& diagnostics) const {
  return read_list(*this, out, diagnostics);
}

bool JsonNode::read_choice(std::size_t& out, Diagnostics& diagnostics,
                           std::span<const std::string_view> choices) const {
  std::string text;
  if (!read(text, diagnostics)) return false;
  const auto found = std::ranges::find(choices, std::string_view(text));
  if (found == choices.end()) {
    error(diagnostics, fmt::format("unknown value '{}'", shown(text)), suggest_name(text, choices, "values"));
    return false;
  }
  out = static_cast<std::size_t>(found - choices.begin());
  return true;
}

JsonNode JsonDocument::root() const { return {tree_.get(), 0}; }
JsonNode JsonDocument::nearest(std::string_view pointer) const {
  JsonNode node = root();
  while (pointer.starts_with('/')) {
    pointer.remove_prefix(1);
    const std::string_view step = pointer.substr(0, pointer.find('/'));
    pointer.remove_prefix(step.size());
    std::size_t index = 0;
    const bool number = std::from_chars(step.data(), step.data() + step.size(), index).ec == std::errc();
    const JsonNode next = node.is_array() ? (number ? node.element(index) : JsonNode()) : node.member(step);
    if (!next.exists()) break;
    node = next;
  }
  return node;
}

const std::string& JsonDocument::file() const { return tree_->file; }
std::string_view JsonDocument::text() const { return tree_->text; }

Result<JsonDocument> parse_json(std::string text, std::string file_name) {
  auto tree = std::make_shared<JsonTree>();
  tree->file = std::move(file_name);
  Diagnostics diagnostics;
  if (text.size() > kMaxFileBytes) {
    diagnostics.errors.push_back({tree->file,
                                  0,
                                  0,
                                  {},
                                  fmt::format("larger than {} MiB", kMaxFileBytes >> 20),
                                  "split it, or check that it is the right file"});
    return diagnostics;
  }
  tree->text = std::move(text);
  tree->lines = LineTable(tree->text);
  detail::parse_json_tree(*tree, diagnostics);
  if (!diagnostics.ok()) return diagnostics;
  return JsonDocument(std::move(tree));
}

Result<JsonDocument> read_json_file(const std::filesystem::path& file) {
  Result<std::string> text = read_text_file(file, kMaxFileBytes);
  if (!text) return std::move(text.diagnostics());
  return parse_json(std::move(*text), file.string());
}

JsonObject::JsonObject(JsonNode node, Diagnostics& diagnostics)
    : node_(node), diagnostics_(&diagnostics), valid_(node.require_object(diagnostics)) {}

JsonNode JsonObject::optional(std::string_view name) {
  if (std::ranges::find(known_, name) == known_.end()) known_.push_back(name);
  return valid_ ? node_.member(name) : JsonNode();
}

JsonNode JsonObject::require(std::string_view name) {
  const JsonNode found = optional(name);
  if (valid_ && !found.exists()) {
    node_.error(*diagnostics_, fmt::format("'{}' is missing", name), fmt::format("add \"{}\"", name));
  }
  return found;
}

JsonNode JsonObject::require_array(std::string_view name, std::size_t min_size, std::size_t max_size) {
  const JsonNode found = require(name);
  return found.require_array(*diagnostics_, min_size, max_size) ? found : JsonNode();
}

JsonNode JsonObject::optional_array(std::string_view name, std::size_t min_size, std::size_t max_size) {
  const JsonNode found = optional(name);
  return found.require_array(*diagnostics_, min_size, max_size) ? found : JsonNode();
}

bool JsonObject::require_choice(std::string_view name, std::size_t& out,
                                std::initializer_list<std::string_view> choices) {
  return require(name).read_choice(out, *diagnostics_, std::span(choices.begin(), choices.size()));
}

bool JsonObject::optional_choice(std::string_view name, std::size_t& out,
                                 std::initializer_list<std::string_view> choices) {
  return optional(name).read_choice(out, *diagnostics_, std::span(choices.begin(), choices.size()));
}

void JsonObject::finish() {
  if (!valid_) return;
  for (const JsonNode member : node_) {
    if (std::ranges::find(known_, member.key()) != known_.end()) continue;
    member.error_at_key(*diagnostics_, fmt::format("unknown member '{}'", shown(member.key())),
                        suggest_name(member.key(), std::span<const std::string_view>(known_), "members"));
  }
}

}  // namespace fascicle
