#include <algorithm>
#include <set>
#include <string_view>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/animation/joint_model.hpp"
#include "engine/animation/joint_model_reader.hpp"
#include "engine/content/gltf_reader.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/asset/check_descriptions.hpp"
#include "modules/muscle/content/bone_field_store.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/build_levels.hpp"
#include "modules/muscle/content/character_file.hpp"
#include "modules/muscle/content/collision_levels.hpp"
#include "modules/muscle/content/content_sources.hpp"
#include "modules/muscle/content/load_parts.hpp"
#include "modules/muscle/content/migrate.hpp"
#include "modules/muscle/content/resolve_muscles.hpp"
#include "modules/muscle/content/surface_hulls.hpp"

namespace fascicle::muscle {

namespace {

namespace fs = std::filesystem;

// A character file with the document that its nodes point into.
struct OpenFile {
  JsonDocument document;
  CharacterFile content;
};

// The file and those that its muscles come from, the nearest first.
class MuscleChain {
 public:
  MuscleChain(ContentSources& sources, Diagnostics& diagnostics) : sources_(sources), diagnostics_(diagnostics) {}

  // False where the first file cannot be read as JSON.
  bool open(const fs::path& file) {
    if (!add(file)) return false;
    while (true) {
      const CharacterFile& last = files_.back()->content;
      if (!last.muscles_from.given()) return true;
      const std::string& reference = last.muscles_from.text;
      const std::optional<fs::path> next =
          sources_.resolve(reference, paths_.back().parent_path(), last.muscles_from.node, diagnostics_);
      if (!next) return true;
      if (closes_cycle(*next, last.muscles_from.node) || !add(*next)) return true;
    }
  }

  const std::vector<std::unique_ptr<OpenFile>>& files() const { return files_; }
  const fs::path& path(std::size_t i) const { return paths_[i]; }

  // The nearest rule that there is, else one that is not given.
  const MirrorRule& mirror() const {
    for (const auto& file : files_) {
      if (file->content.mirror.given()) return file->content.mirror;
    }
    return files_.front()->content.mirror;
  }

 private:
  bool add(const fs::path& file) {
    sources_.note(file);
    Result<JsonDocument> document = read_content_file(file, ContentKind::kCharacter);
    const bool readable = document.ok();
    Diagnostics found = std::move(document.diagnostics());
    if (readable) {
      auto open = std::make_unique<OpenFile>(OpenFile{std::move(*document), {}});
      open->content = read_character_file(open->document.root(), {found});
      files_.push_back(std::move(open));
      paths_.push_back(file.lexically_normal());
    }
    diagnostics_.append(std::move(found));
    return readable;
  }

  bool closes_cycle(const fs::path& next, const JsonNode& node) {
    std::error_code error;
    const auto same = [&](const fs::path& known) { return fs::equivalent(known, next, error); };
    const auto start = std::find_if(paths_.begin(), paths_.end(), same);
    if (start == paths_.end()) return false;
    std::vector<std::string> chain;
    for (auto path = start; path != paths_.end(); ++path) chain.push_back(path->filename().string());
    chain.push_back(start->filename().string());
    node.error(diagnostics_, fmt::format("muscles_from runs in a circle: {}", fmt::join(chain, " -> ")),
               "let one of these files hold its muscles itself");
    return true;
  }

  ContentSources& sources_;
  Diagnostics& diagnostics_;
  std::vector<std::unique_ptr<OpenFile>> files_;
  std::vector<fs::path> paths_;
};

void load_skeleton(const CharacterFile& file, const fs::path& base, ContentSources& sources, CharacterAsset& asset,
                   Diagnostics& diagnostics) {
  if (file.joints.exists()) {
    Result<JointModel> model = read_joint_model(file.joints);
    if (model) {
      asset.joints = std::make_shared<const JointModel>(std::move(*model));
      asset.skeleton = asset.joints->skeleton;
    }
    diagnostics.append(std::move(model.diagnostics()));
  } else if (file.gltf.given()) {
    const std::shared_ptr<const GltfFile> gltf = sources.gltf(file.gltf.text, base, file.gltf.node, diagnostics);
    if (!gltf) return;
    // The skeleton and the clips live inside the file's data and keep it alive.
    asset.skeleton = std::shared_ptr<const Skeleton>(gltf, &gltf->skeleton);
    for (const Clip& clip : gltf->clips) asset.clips.emplace_back(gltf, &clip);
  }
}

// Appends the builder's faults, but for those at places where another muscle has brought one already: a muscle and its
// mirror image are one entry of the file, and fail alike but for a rounded figure in the text.
class FaultReport {
 public:
  explicit FaultReport(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  // The faults of one muscle.
  void add(Diagnostics found) {
    std::erase_if(found.errors, [&](const Diagnostic& fault) { return known_.contains(place_of(fault)); });
    for (const Diagnostic& fault : found.errors) known_.insert(place_of(fault));
    diagnostics_.append(std::move(found));
  }

 private:
  using Place = std::tuple<std::string, int, int, std::string>;
  static Place place_of(const Diagnostic& fault) { return {fault.file, fault.line, fault.column, fault.path}; }

  Diagnostics& diagnostics_;
  std::set<Place> known_;
};

// Fills asset.descriptions. The muscles that could be resolved are checked, and those without a fault built in their
// unfitted shape, even where the file has errors elsewhere: an author sees what is wrong with all of them at once. What is
// built here only tells faults; build_levels builds what is used.
void check_muscles(std::span<const ResolvedMuscle> resolved, CharacterAsset& asset, Diagnostics& diagnostics) {
  for (const ResolvedMuscle& muscle : resolved) asset.descriptions.push_back(muscle.description);
  if (asset.descriptions.empty()) return;
  const std::span<const glm::mat4> bones = asset.skeleton->rest_world;
  if (Diagnostics found = check_rest_bones(bones); !found.ok()) return diagnostics.append(std::move(found));
  FaultReport report(diagnostics);
  std::vector<MuscleDescription> sound;
  for (const MuscleDescription& description : asset.descriptions) {
    Diagnostics found = check_description(description, bones);
    if (found.ok()) sound.push_back(description);
    report.add(std::move(found));
  }
  Diagnostics built = std::move(build_muscle_asset(sound, bones).diagnostics());
  for (const Diagnostic& fault : built.errors) report.add({.errors = {fault}, .warnings = {}});
}

// What is stored beside a character file: `what`, as its author calls it. That it is broken is no error: it is made
// anew.
template <class Store>
Store load_store(const fs::path& store_file, Result<Store> (*read)(const fs::path&), std::string_view what,
                 const std::string& remedy, ContentSources& sources, Diagnostics& diagnostics) {
  sources.note(store_file);
  std::error_code error;
  if (!fs::exists(store_file, error)) return {};
  Result<Store> store = fs::is_regular_file(store_file, error)  // a pipe could be read for ever
                            ? read(store_file)
                            : Diagnostic{store_file.string(), 0, 0, {}, "this is no ordinary file", "remove it"};
  if (store) return std::move(*store);
  Diagnostic warning = store.diagnostics().errors.front();
  warning.cause = fmt::format("the stored {} cannot be used: {}", what, warning.cause);
  warning.remedy = remedy;
  diagnostics.warnings.push_back(std::move(warning));
  return {};
}

// The fits beside a file and beside the ones that its muscles come from: a muscle that nothing has changed about is
// fitted already. The nearest file's go first.
FitStore load_fits(const MuscleChain& chain, const CharacterAsset& asset, ContentSources& sources,
                   Diagnostics& diagnostics) {
  FitStore store;
  if (asset.muscle_meshes.empty()) return store;
  for (std::size_t i = 0; i < chain.files().size(); ++i) {
    const fs::path& file = chain.path(i);
    store.merge(load_store(fit_store_of(file), read_fit_store, "fits",
                           "muscles are fitted at load; run fascicle-cook fit " + file.string(), sources, diagnostics));
  }
  return store;
}

// Likewise the hulls.
HullStore load_hulls(const MuscleChain& chain, const CharacterAsset& asset, ContentSources& sources,
                     Diagnostics& diagnostics) {
  HullStore store;
  if (std::ranges::none_of(asset.surface_descriptions, uses_hull)) return store;
  for (std::size_t i = 0; i < chain.files().size(); ++i) {
    const fs::path& file = chain.path(i);
    store.merge(load_store(hull_store_of(file), read_hull_store, "hulls",
                           "they are made at load; run fascicle-cook hull --store " + file.string(), sources,
                           diagnostics));
  }
  return store;
}

}  // namespace

Result<std::shared_ptr<const CharacterAsset>> load_character(const fs::path& file, const LoadOptions& options) {
  ContentSources sources(options.data_folder);
  return load_character(file, options, sources);
}

Result<std::shared_ptr<const CharacterAsset>> load_character(const fs::path& file, const LoadOptions& options,
                                                             ContentSources& sources) {
  Diagnostics diagnostics;
  auto asset = std::make_shared<CharacterAsset>();
  MuscleChain chain(sources, diagnostics);
  if (!chain.open(file)) return diagnostics;
  const CharacterFile& content = chain.files().front()->content;
  const fs::path base = chain.path(0).parent_path();
  asset->name = content.name;
  load_skeleton(content, base, sources, *asset, diagnostics);
  load_skins(content, base, sources, *asset, diagnostics);
  load_bone_meshes(content, base, sources, *asset, diagnostics);
  std::vector<ResolvedMuscle> resolved;
  MuscleNames names;
  if (asset->skeleton) {
    for (std::size_t i = chain.files().size(); i-- > 0;) {  // the base's muscles come first
      resolve_muscles(chain.files()[i]->content, *asset->skeleton, options, names, resolved, diagnostics);
    }
  }
  for (std::size_t i = chain.files().size(); i-- > 0;) {
    load_muscle_meshes(chain.files()[i]->content, chain.path(i).parent_path(), resolved, sources, *asset, diagnostics);
  }
  if (asset->skeleton) check_muscles(resolved, *asset, diagnostics);
  if (asset->skeleton) {
    MuscleNames surface_names;
    for (std::size_t i = chain.files().size(); i-- > 0;) {
      load_surface_muscles(chain.files()[i]->content, chain.path(i).parent_path(), sources, surface_names, *asset,
                           diagnostics);
    }
  }
  const MirrorRule& mirror = chain.mirror();
  if (asset->skeleton) asset->mirror = make_mirror_map(mirror, *asset);
  ResolvedCollision collision = load_collision(content, base, mirror, names, sources, *asset, diagnostics);
  if (diagnostics.ok() && !resolved.empty()) {
    FitStore store;
    if (options.fit == FitMode::kStored) store = load_fits(chain, *asset, sources, diagnostics);
    const FitSettings settings{options.fit != FitMode::kNone, content.fit_supersampling, content.coarser_levels};
    build_levels(resolved, settings, store, *asset, diagnostics);
    if (asset->muscles) place_images(*asset->muscles, mirror.axis, collision);
  }
  asset->collision = std::move(collision.description);
  if (diagnostics.ok()) build_surface_muscles(*asset, diagnostics);
  if (diagnostics.ok() && options.hulls != HullMode::kNone) {
    HullStore store;
    if (options.hulls == HullMode::kStored) store = load_hulls(chain, *asset, sources, diagnostics);
    build_hulls(store, *asset, diagnostics);
  }
  const bool has_muscles = asset->muscles || !asset->surface_muscles.empty();
  if (options.bone_fields && has_muscles) load_bone_fields(file, *asset, diagnostics);
  if (diagnostics.ok()) build_collision_levels(*asset);
  drop_repetitions(diagnostics);
  asset->files = sources.files();
  if (!diagnostics.ok()) return diagnostics;
  return Result<std::shared_ptr<const CharacterAsset>>(std::move(asset), std::move(diagnostics));
}

}  // namespace fascicle::muscle
