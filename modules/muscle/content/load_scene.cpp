#include "modules/muscle/content/load_scene.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "engine/animation/clip.hpp"
#include "engine/animation/motion.hpp"
#include "engine/animation/motion_reader.hpp"
#include "engine/content/closest_name.hpp"
#include "modules/muscle/content/content_sources.hpp"
#include "modules/muscle/content/load_parts.hpp"
#include "modules/muscle/content/migrate.hpp"
#include "modules/muscle/content/scene_file.hpp"

namespace fascicle::muscle {

namespace {

namespace fs = std::filesystem;
using CharacterPointer = std::shared_ptr<const CharacterAsset>;

// Characters of one scene by file, each loaded once; null: loaded and wrong.
class CharacterLoads {
 public:
  CharacterLoads(const LoadOptions& options, ContentSources& sources) : options_(options), sources_(sources) {}

  CharacterPointer load(const fs::path& file, Diagnostics& diagnostics) {
    std::error_code error;
    fs::path key = fs::weakly_canonical(file, error);
    if (error) key = file;
    if (const auto known = loaded_.find(key); known != loaded_.end()) return known->second;
    std::vector<fs::path> files;
    Result<CharacterPointer> loaded = load_character(file, options_, files);
    for (const fs::path& read : files) sources_.note(read);
    const CharacterPointer character = loaded ? *loaded : nullptr;
    diagnostics.append(std::move(loaded.diagnostics()));
    loaded_.emplace(std::move(key), character);
    return character;
  }

 private:
  const LoadOptions& options_;
  ContentSources& sources_;
  std::map<fs::path, CharacterPointer> loaded_;
};

void choose_clip(const SceneCharacterEntry& entry, SceneCharacter& placed, Diagnostics& diagnostics) {
  const auto& clips = placed.character->clips;
  const auto found =
      std::find_if(clips.begin(), clips.end(), [&](const auto& clip) { return clip->name == entry.clip.text; });
  if (found != clips.end()) {
    placed.animation.clip = *found;
    return;
  }
  std::vector<std::string> names;
  for (const auto& clip : clips) names.push_back(clip->name);
  entry.clip.node.error(diagnostics,
                        fmt::format("the character '{}' has no clip '{}'", placed.character->name, entry.clip.text),
                        placed.character->joints ? "a joint skeleton plays a \"motion\" file (.mot, .sto)"
                                                 : suggest_name(entry.clip.text, names, "clips"));
}

void choose_motion(const SceneCharacterEntry& entry, const fs::path& base, ContentSources& sources,
                   SceneCharacter& placed, Diagnostics& diagnostics) {
  const std::optional<fs::path> path = sources.resolve(entry.motion.text, base, entry.motion.node, diagnostics);
  if (!path) return;
  if (!placed.character->joints) {
    entry.motion.node.error(diagnostics,
                            fmt::format("the character '{}' has a glTF skeleton, which a motion cannot move",
                                        placed.character->name),
                            "name one of its clips in \"clip\"");
    return;
  }
  Result<Motion> motion = read_motion(*path, *placed.character->joints);
  if (motion && entry.whole_record) loop_whole_record(*motion);
  if (motion) placed.animation.motion = std::make_shared<const Motion>(std::move(*motion));
  diagnostics.append(std::move(motion.diagnostics()));
}

// False, with one error that says what to do, where the scene needs the data folder and it is not there.
bool has_its_data(const SceneFile& scene, const ContentSources& sources, Diagnostics& diagnostics) {
  if (!scene.values.requires_data) return true;
  std::error_code error;
  if (!sources.data_folder().empty() && fs::is_directory(sources.data_folder(), error)) return true;
  scene.requires_data.error(diagnostics, fmt::format("{}, which this scene needs", kNoDataFolder),
                            "set the environment variable FASCICLE_DATA to the folder that holds it");
  return false;
}

Result<std::shared_ptr<const SceneAsset>> load_scene_with(const fs::path& file, const LoadOptions& options,
                                                          ContentSources& sources) {
  const fs::file_time_type started = fs::file_time_type::clock::now();
  sources.note(file);
  Result<JsonDocument> document = read_content_file(file, ContentKind::kScene);
  Diagnostics diagnostics = std::move(document.diagnostics());
  if (!document.ok()) return diagnostics;
  const SceneFile scene = read_scene_file(document->root(), {diagnostics});
  if (!has_its_data(scene, sources, diagnostics)) return diagnostics;
  auto asset = std::make_shared<SceneAsset>(scene.values);
  const fs::path base = file.parent_path();
  CharacterLoads characters(options, sources);
  for (const SceneCharacterEntry& entry : scene.characters) {
    if (!entry.file.given()) continue;
    SceneCharacter placed = entry.values;
    const std::optional<fs::path> path = sources.resolve(entry.file.text, base, entry.file.node, diagnostics);
    if (!path) continue;
    placed.character = characters.load(*path, diagnostics);
    if (!placed.character) continue;
    if (entry.clip.given()) choose_clip(entry, placed, diagnostics);
    if (entry.motion.given()) choose_motion(entry, base, sources, placed, diagnostics);
    asset->characters.push_back(std::move(placed));
  }
  drop_repetitions(diagnostics);  // characters that share a broken file report it each
  asset->files = sources.files();
  asset->load_started = started;
  if (!diagnostics.ok()) return diagnostics;
  return Result<std::shared_ptr<const SceneAsset>>(std::move(asset), std::move(diagnostics));
}

}  // namespace

Result<std::shared_ptr<const SceneAsset>> load_scene(const fs::path& file, const LoadOptions& options,
                                                     std::vector<fs::path>& files) {
  ContentSources sources(options.data_folder);
  auto result = load_scene_with(file, options, sources);
  files = sources.files();
  return result;
}

Result<std::shared_ptr<const SceneAsset>> load_scene(const fs::path& file, const LoadOptions& options) {
  std::vector<fs::path> files;
  return load_scene(file, options, files);
}

Result<CharacterPointer> load_character(const fs::path& file, const LoadOptions& options,
                                        std::vector<fs::path>& files) {
  ContentSources sources(options.data_folder);
  auto result = load_character(file, options, sources);
  files = sources.files();
  return result;
}

bool lacks_data(const Diagnostics& diagnostics) {
  return std::any_of(diagnostics.errors.begin(), diagnostics.errors.end(),
                     [](const Diagnostic& error) { return error.cause.starts_with(kNoDataFolder); });
}

}  // namespace fascicle::muscle
