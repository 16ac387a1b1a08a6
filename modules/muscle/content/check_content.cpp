#include "modules/muscle/content/check_content.hpp"

#include <fmt/format.h>

#include "engine/content/file_text.hpp"
#include "modules/muscle/content/collision_file.hpp"
#include "modules/muscle/content/migrate.hpp"
#include "modules/muscle/content/scene_asset.hpp"

namespace fascicle::muscle {

namespace {

// What the file is; an error where nothing tells. A name that tells is enough: the loader reads the file itself.
std::optional<ContentKind> find_kind(const std::filesystem::path& file, Diagnostics& diagnostics) {
  if (const auto kind = content_kind(file, JsonNode())) return kind;
  Result<JsonDocument> document = read_json_file(file);
  if (!document) {
    diagnostics.append(std::move(document.diagnostics()));
    return std::nullopt;
  }
  const auto kind = content_kind(file, document->root());
  if (!kind) {
    document->root().error(diagnostics, "neither a character nor a scene",
                           "name the file NAME.character.json or NAME.scene.json");
  }
  return kind;
}

// A collision file by itself: its fields. What its names mean, only a character tells.
Diagnostics check_collision_file(const std::filesystem::path& file) {
  Result<JsonDocument> document = read_content_file(file, ContentKind::kCollision);
  Diagnostics diagnostics = std::move(document.diagnostics());
  if (document.ok()) read_collision_file(document->root(), {diagnostics});
  return diagnostics;
}

}  // namespace

Diagnostics check_content(const std::filesystem::path& file, const LoadOptions& options) {
  Diagnostics diagnostics;
  const std::optional<ContentKind> kind = find_kind(file, diagnostics);
  if (!kind) return diagnostics;
  switch (*kind) {
    case ContentKind::kScene: return std::move(load_scene(file, options).diagnostics());
    case ContentKind::kCollision: return check_collision_file(file);
    case ContentKind::kCharacter: break;
  }
  return std::move(load_character(file, options).diagnostics());
}

Diagnostics migrate_content_file(const std::filesystem::path& file) {
  Diagnostics diagnostics;
  const std::optional<ContentKind> kind = find_kind(file, diagnostics);
  if (!kind) return diagnostics;
  Result<JsonDocument> document = read_json_file(file);
  if (!document) return std::move(document.diagnostics());
  Result<JsonDocument> migrated = migrate(*document, *kind);
  if (!migrated) return std::move(migrated.diagnostics());
  if (migrated->text() == document->text()) return diagnostics;
  diagnostics.append(write_text_atomically(file, migrated->text()));
  if (diagnostics.ok()) {
    diagnostics.warnings.push_back(
        {file.string(), 0, 0, {}, fmt::format("rewritten in version {}", kContentVersion), "look at the changes"});
  }
  return diagnostics;
}

}  // namespace fascicle::muscle
