#include "modules/muscle/content/edit_collision.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "engine/content/quote_json.hpp"
#include "modules/muscle/content/collision_limits.hpp"

namespace fascicle::muscle {

namespace {

constexpr std::string_view kSpace = " \t\r\n";

// Four decimals (a tenth of a millimetre on the longest muscles), without trailing zeros.
std::string number(float value) {
  std::string text = fmt::format("{:.4f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string place_text(const SectionTag& tag, const CollisionNames& names) {
  const SectionTag written = as_written(tag);
  return fmt::format(R"({{ "muscle": {}, "at": {}, "angle": {} }})", quote_json(names.muscles[tag.muscle].name),
                     number(written.fraction), number(written.angle));
}

std::string bone_name(std::int32_t bone, const CollisionNames& names) {
  return quote_json(names.skeleton.names[static_cast<std::size_t>(bone)]);
}

std::string flags_text(std::optional<bool> mirror, bool automatic) {
  return fmt::format("{}{}", mirror ? (*mirror ? R"(, "mirror": true)" : R"(, "mirror": false)") : "",
                     automatic ? R"(, "automatic": true)" : "");
}

// The byte range of a value in its document's text.
struct Range {
  std::size_t begin = 0, end = 0;
};

Range range_of(const JsonNode& node, std::string_view text) {
  const auto begin = static_cast<std::size_t>(node.text().data() - text.data());
  return {begin, begin + node.text().size()};
}

std::string_view line_break(std::string_view text) {
  const std::size_t at = text.find('\n');
  return at != std::string_view::npos && at > 0 && text[at - 1] == '\r' ? "\r\n" : "\n";
}

// The white space that the line of byte `at` starts with.
std::string_view indent_at(std::string_view text, std::size_t at) {
  const std::size_t before = at == 0 ? std::string_view::npos : text.rfind('\n', at - 1);
  const std::size_t start = before == std::string_view::npos ? 0 : before + 1;
  return text.substr(start, std::min(text.find_first_not_of(" \t", start), at) - start);
}

bool is_automatic(const JsonNode& element) {
  Diagnostics ignored;
  bool automatic = false;
  const JsonNode flag = element.member("automatic");
  return flag.exists() && flag.read(automatic, ignored) && automatic;
}

std::string join_entries(std::span<const std::string> entries, std::string_view indent, bool first) {
  std::string text;
  for (const std::string& entry : entries) {
    if (!first) text += ',';
    first = false;
    text.append(indent).append(entry);
  }
  return text;
}

std::string add_list(const JsonDocument& document, std::string_view list, std::span<const std::string> entries) {
  const std::string_view text = document.text();
  if (entries.empty()) return std::string(text);
  const std::string end_of_line(line_break(text));
  const std::string body = fmt::format("{}: [{}{}  ]", quote_json(list),
                                       join_entries(entries, end_of_line + "    ", true), end_of_line);
  const JsonNode root = document.root();
  std::size_t at = range_of(root, text).begin + 1;  // after its brace
  for (const JsonNode member : root) at = range_of(member, text).end;
  const char* comma = root.size() > 0 ? "," : "";
  return fmt::format("{}{}{}  {}{}", text.substr(0, at), comma, end_of_line, body, text.substr(at));
}

// Elements keep the white space in front of them; that between an element and its comma goes.
std::string rebuild_list(const JsonDocument& document, const JsonNode& array, std::span<const std::string> entries,
                         bool drop_automatic) {
  const std::string_view text = document.text();
  bool drops = false;
  for (const JsonNode element : array) drops = drops || (drop_automatic && is_automatic(element));
  if (!drops && entries.empty()) return std::string(text);
  const Range whole = range_of(array, text);
  const std::string end_of_line(line_break(text));
  const std::string closing = end_of_line + std::string(indent_at(text, whole.begin));
  std::string indent = closing + "  ";
  std::string body;
  for (const JsonNode element : array) {
    if (drop_automatic && is_automatic(element)) continue;
    const Range range = range_of(element, text);
    const std::size_t before = text.find_last_not_of(kSpace, range.begin - 1) + 1;
    const std::string_view lead = text.substr(before, range.begin - before);
    if (!body.empty()) body += ',';
    if (body.empty() && lead.find('\n') != std::string_view::npos) indent = lead;
    body.append(lead).append(element.text());
  }
  body += join_entries(entries, indent, body.empty());
  return fmt::format("{}{}{}{}", text.substr(0, whole.begin + 1), body, body.empty() ? std::string() : closing,
                     text.substr(whole.end - 1));
}

std::string edit_list(const JsonDocument& document, std::string_view list, std::span<const std::string> entries,
                      bool drop_automatic) {
  const JsonNode array = document.root().member(list);
  if (!array.exists()) return add_list(document, list, entries);
  return array.is_array() ? rebuild_list(document, array, entries, drop_automatic) : std::string(document.text());
}

}  // namespace

SectionTag as_written(SectionTag tag) {
  const auto rounded = [](float value) { return std::round(1.0e4f * value) / 1.0e4f; };
  const float turn = 2.0f * std::numbers::pi_v<float>;
  tag.fraction = std::clamp(rounded(tag.fraction), static_cast<float>(kPlaceRange.min),
                            static_cast<float>(kPlaceRange.max));
  tag.angle = rounded(tag.angle) < turn ? rounded(tag.angle) : 0.0f;
  return tag;
}

std::string write_entry(const TransversalTag& tag, const CollisionNames& names, std::optional<bool> mirror) {
  const std::string second = tag.bone >= 0 ? fmt::format(R"({{ "bone": {} }})", bone_name(tag.bone, names))
                                           : place_text(tag.second, names);
  const bool says_yields = tag.bone < 0 && tag.yields != Yields::kBoth;
  return fmt::format(R"({{ "first": {}, "second": {}{}{}{} }})", place_text(tag.first, names), second,
                     !says_yields                      ? ""
                     : tag.yields == Yields::kFirst    ? R"(, "yields": "first")"
                                                       : R"(, "yields": "second")",
                     tag.sweeps ? R"(, "sweeps": true)" : "", flags_text(mirror, tag.automatic));
}

std::string write_entry(const BoneTag& tag, const CollisionNames& names, std::optional<bool> mirror) {
  std::string bones;
  for (const std::int32_t bone : tag.bones) bones += (bones.empty() ? "" : ", ") + bone_name(bone, names);
  return fmt::format(R"({{ "muscle": {}{}{}, "bones": [{}]{} }})", quote_json(names.muscles[tag.muscle].name),
                     tag.from > 0.0f ? fmt::format(R"(, "from": {})", number(tag.from)) : "",
                     tag.to < 1.0f ? fmt::format(R"(, "to": {})", number(tag.to)) : "", bones,
                     flags_text(mirror, tag.automatic));
}

std::string empty_collision_file() {
  return "{\n  \"$schema\": \"../../schema/collision.schema.json\",\n  \"version\": 1\n}\n";
}

std::string append_entries(const JsonDocument& document, std::string_view list, std::span<const std::string> entries) {
  return edit_list(document, list, entries, false);
}

std::string replace_automatic(const JsonDocument& document, std::string_view list,
                              std::span<const std::string> entries) {
  return edit_list(document, list, entries, true);
}

std::string name_collision_file(const JsonDocument& character, std::string_view reference) {
  const std::string_view text = character.text();
  const std::string member = fmt::format("\"collision\": {}", quote_json(reference));
  for (const char* before : {"muscles_from", "muscles"}) {
    const JsonNode node = character.root().member(before);
    if (!node.exists()) continue;
    const std::size_t colon = text.rfind(':', range_of(node, text).begin);
    const std::size_t key_end = text.rfind('"', colon);
    const std::size_t key = text.rfind('"', key_end - 1);
    const std::string_view indent = indent_at(text, key);
    const bool own_line = text.substr(0, key).ends_with('\n' + std::string(indent));
    const std::string lead = own_line ? std::string(line_break(text)) + std::string(indent) : " ";
    return fmt::format("{}{},{}{}", text.substr(0, key), member, lead, text.substr(key));
  }
  const JsonNode root = character.root();
  std::size_t at = range_of(root, text).begin + 1;
  for (const JsonNode last : root) at = range_of(last, text).end;
  return fmt::format("{}{}{}  {}{}", text.substr(0, at), root.size() > 0 ? "," : "", line_break(text), member,
                     text.substr(at));
}

}  // namespace fascicle::muscle
