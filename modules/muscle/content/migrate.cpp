#include "modules/muscle/content/migrate.hpp"

#include <algorithm>
#include <numbers>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "engine/content/quote_json.hpp"

namespace fascicle::muscle {

namespace {

// A member of version 0 and what it is in version 1.
struct Renamed {
  std::string_view old_name;
  std::string_view new_name;
  double factor = 1.0;  // of its value
};

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr Renamed kCharacter0[] = {{"lod", "level"}, {"specific_tension_ncm2", "specific_tension", 1e4}};
constexpr Renamed kLevel0[] = {{"sections", "section_vertices"}, {"subdivisions", "longitudinal_subdivision"}};
constexpr Renamed kMuscle0[] = {{"fmax", "max_isometric_force"},
                                {"fibre_length", "optimal_fibre_length"},
                                {"tendon_length", "tendon_slack_length"},
                                {"pennation_degrees", "pennation", kDegree},
                                {"via_points", "via"}};
constexpr Renamed kScene0[] = {{"fps", "step_hz"}};
constexpr Renamed kSceneCharacter0[] = {{"path", "file"}, {"heading_degrees", "heading", kDegree}};
constexpr Renamed kCamera0[] = {{"fov_degrees", "fov", kDegree}};

// Replace the token at a line and column.
struct Edit {
  int line = 0;
  int column = 0;
  std::string text;
};

void edit_members(const JsonNode& object, std::span<const Renamed> renamed, std::vector<Edit>& edits) {
  for (const JsonNode member : object) {
    const auto found = std::find_if(renamed.begin(), renamed.end(),
                                    [&](const Renamed& r) { return r.old_name == member.key(); });
    if (found == renamed.end()) continue;
    Diagnostics at_key;
    member.error_at_key(at_key, {}, {});
    edits.push_back({at_key.errors.front().line, at_key.errors.front().column, quote_json(found->new_name)});
    Diagnostics ignored;  // a value of another kind is left for the reader to refuse
    double value = 0.0;
    if (found->factor != 1.0 && member.read(value, ignored)) {
      edits.push_back({member.line(), member.column(), fmt::format("{}", value * found->factor)});
    }
  }
}

void edit_version(const JsonNode& version, std::vector<Edit>& edits) {
  edits.push_back({version.line(), version.column(), fmt::format("{}", kContentVersion)});
}

std::vector<Edit> edits_from_0(const JsonNode& root, ContentKind kind) {
  std::vector<Edit> edits;
  edit_version(root.member("version"), edits);
  if (kind == ContentKind::kCharacter) {
    edit_members(root, kCharacter0, edits);
    edit_members(root.member("lod"), kLevel0, edits);
    for (const JsonNode muscle : root.member("muscles")) edit_members(muscle, kMuscle0, edits);
  } else if (kind == ContentKind::kScene) {
    edit_members(root, kScene0, edits);
    for (const JsonNode character : root.member("characters")) edit_members(character, kSceneCharacter0, edits);
    edit_members(root.member("camera"), kCamera0, edits);
  }
  std::sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) {
    return a.line != b.line ? a.line < b.line : a.column < b.column;
  });
  return edits;
}

// The end of the string, number or word that starts at `at`.
std::size_t token_end(std::string_view text, std::size_t at) {
  if (at < text.size() && text[at] == '"') {
    for (++at; at < text.size() && text[at] != '"'; ++at) at += text[at] == '\\' ? 1 : 0;
    return std::min(at + 1, text.size());
  }
  constexpr std::string_view kEnds = " \t\r\n,]}:";
  while (at < text.size() && kEnds.find(text[at]) == std::string_view::npos) ++at;
  return at;
}

// Lines end with \n, \r\n or \r and columns count UTF-8 characters, as positions of JsonNode do.
std::string apply_edits(std::string_view text, std::span<const Edit> edits) {
  std::string out;
  out.reserve(text.size() + 16 * edits.size());
  int line = 1, column = 1;
  std::size_t next = 0;
  for (std::size_t at = 0; at < text.size();) {
    if (next < edits.size() && edits[next].line == line && edits[next].column == column) {
      out += edits[next++].text;
      const std::size_t end = token_end(text, at);
      for (; at < end; ++at) column += (static_cast<unsigned char>(text[at]) & 0xc0u) != 0x80u ? 1 : 0;
      continue;
    }
    const char c = text[at++];
    out += c;
    const bool ends_line = c == '\n' || (c == '\r' && (at == text.size() || text[at] != '\n'));
    if (ends_line) {
      ++line;
      column = 1;
    } else if (at == text.size() || (static_cast<unsigned char>(text[at]) & 0xc0u) != 0x80u) {
      ++column;
    }
  }
  return out;
}

}  // namespace

std::optional<ContentKind> content_kind(const std::filesystem::path& file, const JsonNode& root) {
  const std::string name = file.filename().string();
  if (name.ends_with(".character.json")) return ContentKind::kCharacter;
  if (name.ends_with(".scene.json")) return ContentKind::kScene;
  if (name.ends_with(".collision.json")) return ContentKind::kCollision;
  if (root.member("characters").exists()) return ContentKind::kScene;
  if (root.member("transversals").exists() || root.member("stay_out").exists()) return ContentKind::kCollision;
  if (root.member("skeleton").exists() || root.member("muscles").exists()) return ContentKind::kCharacter;
  return std::nullopt;
}

Result<JsonDocument> migrate(const JsonDocument& document, ContentKind kind) {
  const JsonNode root = document.root();
  Diagnostics diagnostics;
  if (!root.require_object(diagnostics)) return diagnostics;
  const JsonNode node = root.member("version");
  if (!node.exists()) {
    root.error(diagnostics, "the field 'version' is missing",
               fmt::format("add \"version\": {} (the format's version; 0 for files older than the first release)",
                           kContentVersion));
    return diagnostics;
  }
  std::int32_t version = 0;
  if (!node.read(version, diagnostics, at_least(0))) return diagnostics;
  if (version > kContentVersion) {
    node.error(diagnostics,
               fmt::format("the file has version {}, this program reads up to {}", version, kContentVersion),
               "use a newer program, or write the file in the older version and set \"version\" to it");
    return diagnostics;
  }
  if (version == kContentVersion) return document;
  const std::vector<Edit> edits = edits_from_0(root, kind);
  node.warning(diagnostics,
               fmt::format("the file has version {} and was read as version {}", version, kContentVersion),
               fmt::format("`fascicle-check --migrate {}` rewrites it", root.file()));
  Result<JsonDocument> migrated = parse_json(apply_edits(document.text(), edits), root.file());
  // Two members may have become one: the parser reports it as a duplicate name.
  migrated.diagnostics().append(std::move(diagnostics));
  return migrated;
}

Result<JsonDocument> read_content_file(const std::filesystem::path& file, ContentKind kind) {
  Result<JsonDocument> read = read_json_file(file);
  if (!read) return read;
  return migrate(*read, kind);
}

}  // namespace fascicle::muscle
