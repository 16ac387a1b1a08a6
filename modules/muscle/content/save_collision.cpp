#include "modules/muscle/content/save_collision.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <system_error>

#include <fmt/format.h>

#include "engine/content/file_text.hpp"
#include "engine/content/json_reader.hpp"
#include "modules/muscle/content/collision_file.hpp"
#include "modules/muscle/content/content_sources.hpp"
#include "modules/muscle/content/edit_collision.hpp"

namespace fascicle::muscle {

namespace {

namespace fs = std::filesystem;

// The text of a file after a change; errors of the file as it was or as it would be.
using Edit = std::function<std::string(const JsonDocument&)>;

Result<std::string> apply(std::string text, const std::string& file, const std::vector<Edit>& edits) {
  for (const Edit& edit : edits) {
    const Result<JsonDocument> document = parse_json(std::move(text), file);
    if (!document) return document.diagnostics();
    text = edit(*document);
  }
  const Result<JsonDocument> document = parse_json(text, file);
  if (!document) return document.diagnostics();
  Diagnostics found;
  read_collision_file(document->root(), {found});
  if (!found.ok()) return found;
  return text;
}

std::string name_beside(const fs::path& character_file) {
  std::string name = character_file.filename().string();
  name = name.substr(0, name.find('.'));
  return name + ".collision.json";
}

Result<SavedCollision> save(const fs::path& character_file, const std::vector<Edit>& edits, bool write,
                            const fs::path& data_folder) {
  const Result<CollisionFilePlace> place = find_collision_file(character_file, data_folder);
  if (!place) return place.diagnostics();
  SavedCollision saved{.file = place->file};
  std::error_code error;
  const bool there = fs::exists(place->file, error);
  std::string old_text = empty_collision_file();
  if (there) {
    Result<std::string> read = read_text_file(place->file);
    if (!read) return read.diagnostics();
    old_text = std::move(*read);
  }
  const Result<std::string> text = apply(old_text, place->file.string(), edits);
  if (!text) return text.diagnostics();
  saved.named_anew = !place->named;
  saved.changed = !there || *text != old_text || saved.named_anew;
  if (!write) return saved;
  if (!there || *text != old_text) {
    if (Diagnostics found = write_text_atomically(place->file, *text); !found.ok()) return found;
  }
  if (saved.named_anew) {
    const Result<JsonDocument> character = read_json_file(character_file);
    if (!character) return character.diagnostics();
    const std::string named = name_collision_file(*character, name_beside(character_file));
    if (Diagnostics found = write_text_atomically(character_file, named); !found.ok()) return found;
  }
  return saved;
}

Diagnostic fault(const CharacterAsset& character, std::string cause, std::string remedy) {
  return {character.files.empty() ? std::string() : character.files.front().string(), 0, 0, {}, std::move(cause),
          std::move(remedy)};
}

bool is_near(const SectionTag& a, const SectionTag& b) {
  return a.muscle == b.muscle && std::abs(a.fraction - b.fraction) < 1.0e-3f && std::abs(a.angle - b.angle) < 1.0e-3f;
}

std::optional<Diagnostic> find_fault(const TransversalTag& tag, const CharacterAsset& character) {
  const auto wrong = [&](const SectionTag& place) {
    return place.muscle >= character.descriptions.size() || !(place.fraction > 0.0f && place.fraction < 1.0f) ||
           !(place.angle >= 0.0f && place.angle < 7.0f);
  };
  const bool of_bone = tag.bone >= 0;
  if (!character.skeleton || wrong(tag.first) || (!of_bone && wrong(tag.second)) ||
      (of_bone && static_cast<std::size_t>(tag.bone) >= character.skeleton->size())) {
    return fault(character, "this is no place between the ends of a muscle", "choose two sections that are no ends");
  }
  if (!of_bone && tag.first.muscle == tag.second.muscle) {
    return fault(character,
                 fmt::format("both ends are on '{}'", character.descriptions[tag.first.muscle].name),
                 "choose sections of two muscles");
  }
  for (const TransversalTag& known : character.collision.transversals) {
    if (known.automatic || known.bone != tag.bone) continue;
    const bool same = is_near(known.first, tag.first) && (of_bone || is_near(known.second, tag.second));
    const bool crossed = !of_bone && is_near(known.first, tag.second) && is_near(known.second, tag.first);
    if (!same && !crossed) continue;
    return fault(character,
                 fmt::format("these places are tagged already, at {}:{}", known.where.file, known.where.line),
                 "edit that entry");
  }
  return std::nullopt;
}

}  // namespace

Result<CollisionFilePlace> find_collision_file(const fs::path& character_file, const fs::path& data_folder) {
  const Result<JsonDocument> document = read_json_file(character_file);
  if (!document) return document.diagnostics();
  Diagnostics found;
  if (!document->root().require_object(found)) return found;
  const JsonNode node = document->root().member("collision");
  if (!node.exists()) return CollisionFilePlace{character_file.parent_path() / name_beside(character_file), false};
  std::string reference;
  if (!node.read(reference, found)) return found;
  ContentSources sources(data_folder);
  const auto path = sources.resolve(reference, character_file.parent_path(), node, found);
  if (!path) return found;
  return CollisionFilePlace{*path, true};
}

Result<SavedCollision> save_transversal(const fs::path& character_file, const CharacterAsset& character,
                                        const TransversalTag& tag, std::optional<bool> mirror,
                                        const fs::path& data_folder) {
  if (std::optional<Diagnostic> found = find_fault(tag, character)) return std::move(*found);
  const CollisionNames names{character.descriptions, *character.skeleton};
  const std::array entries{write_entry(tag, names, mirror)};
  const Edit edit = [&](const JsonDocument& document) { return append_entries(document, "transversals", entries); };
  return save(character_file, {edit}, true, data_folder);
}

Result<SavedCollision> save_automatic(const fs::path& character_file, const AutomaticEntries& entries, bool write,
                                      const fs::path& data_folder) {
  return save(character_file,
              {[&](const JsonDocument& document) {
                 return replace_automatic(document, "transversals", entries.transversals);
               },
               [&](const JsonDocument& document) { return replace_automatic(document, "stay_out", entries.stay_out); }},
              write, data_folder);
}

}  // namespace fascicle::muscle
