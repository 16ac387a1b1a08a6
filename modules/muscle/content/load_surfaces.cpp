// The surface muscles of a character: names looked up, vertices and fibres chosen, the other side made, assets built.

#include "modules/muscle/content/load_parts.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/content/closest_name.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/content/mirror.hpp"
#include "modules/muscle/content/surface_attachments.hpp"
#include "modules/muscle/content/surface_clearance.hpp"
#include "modules/muscle/content/surface_fibres.hpp"
#include "modules/muscle/content/surface_line.hpp"
#include "modules/muscle/content/surface_mesh.hpp"

namespace fascicle::muscle {

namespace {

namespace fs = std::filesystem;

class SurfaceLoads {
 public:
  SurfaceLoads(const CharacterFile& file, const fs::path& base, ContentSources& sources, MuscleNames& names,
               CharacterAsset& asset, Diagnostics& diagnostics)
      : file_(file), base_(base), sources_(sources), names_(names), asset_(asset), diagnostics_(diagnostics) {}

  void load(const SurfaceMuscleEntry& entry) {
    const bool fresh = !entry.name.given() || claim_name(entry.name.text, entry.name.node, false);
    std::optional<SurfaceMuscleDescription> muscle = describe(entry);
    const bool sound = fresh && entry.sound && muscle;
    if (sound) add(*muscle, entry);
    if (entry.mirror && fresh && entry.name.given()) add_image(entry, sound ? &*muscle : nullptr);
  }

 private:
  // All that is wrong is told, whatever else is. Empty where something is.
  std::optional<SurfaceMuscleDescription> describe(const SurfaceMuscleEntry& entry) {
    const std::size_t errors_before = diagnostics_.errors.size();
    SurfaceMuscleDescription muscle;
    muscle.name = entry.name.text;
    muscle.settings = entry.settings;
    muscle.levels = entry.levels;
    muscle.hull = entry.hull;
    muscle.fibre_bundle = entry.inner_fibres;
    muscle.where = entry.node.where();
    for (const SurfaceAttachmentEntry& attachment : entry.attachments) {
      const std::int32_t bone = attachment.bone.given() ? find_bone(attachment.bone) : -1;
      muscle.attachments.push_back({bone, attachment.origin, {}});
    }
    for (const LinePointEntry& point : entry.action_line) {
      muscle.action_line.push_back({point.bone.given() ? find_bone(point.bone) : -1, glm::vec3(0.0f)});
    }
    muscle.frame_bone = entry.frame.given() ? find_bone(entry.frame) : usual_frame(muscle);
    muscle.bones = bones_of(entry);
    if (entry.driver.given() && check_driver(entry.driver)) muscle.driver = entry.driver.text;
    if (entry.attachments.empty() && !entry.free) {
      entry.node.warning(diagnostics_, fmt::format("the muscle '{}' is attached to no bone", muscle.name),
                         "give it \"attachments\", or say \"free\": true");
    }
    std::optional<SurfaceMesh> mesh = load_surface_mesh(entry, file_, base_, sources_, diagnostics_);
    if (!mesh) return std::nullopt;
    attach(entry, *mesh, muscle);
    place_action_line(entry, *mesh, muscle, diagnostics_);
    muscle.fibres = load_fibres(entry.fibres, entry, file_, base_, mesh->rest, sources_, diagnostics_);
    muscle.mesh = std::move(mesh->rest);
    turn_fibres(muscle);
    if (diagnostics_.errors.size() == errors_before) check_swallowed(muscle, asset_, diagnostics_);
    if (diagnostics_.errors.size() != errors_before) return std::nullopt;
    return muscle;
  }

  std::int32_t find_bone(const NameEntry& name) {
    const std::int32_t bone = asset_.skeleton->find(name.text);
    if (bone < 0) {
      name.node.error(diagnostics_, fmt::format("the skeleton has no bone '{}'", name.text),
                      suggest_name(name.text, asset_.skeleton->names, "bones"));
    }
    return bone;
  }

  // The bone that a muscle moves with as a whole, where its author leaves it open: its origin's.
  static std::int32_t usual_frame(const SurfaceMuscleDescription& muscle) {
    for (const SurfaceAttachment& attachment : muscle.attachments) {
      if (attachment.origin && attachment.bone >= 0) return attachment.bone;
    }
    return 0;
  }

  bool has_mesh(std::int32_t bone) const {
    return std::ranges::any_of(asset_.bone_meshes, [&](const BoneMesh& part) { return part.bone == bone; });
  }

  std::vector<std::int32_t> bones_of(const SurfaceMuscleEntry& entry) {
    std::vector<std::int32_t> bones;
    for (const NameEntry& name : entry.bones) {
      const std::int32_t bone = find_bone(name);
      if (bone < 0) continue;
      if (!has_mesh(bone)) {
        name.node.warning(diagnostics_, fmt::format("the bone '{}' has no mesh to keep out of", name.text),
                          "give it one in \"bone_meshes\"");
      }
      bones.push_back(bone);
    }
    for (std::int32_t bone = 0; entry.all_bones && bone < static_cast<std::int32_t>(asset_.skeleton->size()); ++bone) {
      if (has_mesh(bone)) bones.push_back(bone);
    }
    std::ranges::sort(bones);
    bones.erase(std::ranges::unique(bones).begin(), bones.end());
    return bones;
  }

  bool has_driver(const std::string& name) const {
    return std::ranges::any_of(asset_.descriptions, [&](const MuscleDescription& one) { return one.name == name; });
  }

  bool check_driver(const NameEntry& driver) {
    if (has_driver(driver.text)) return true;
    std::vector<std::string> known;
    for (const MuscleDescription& muscle : asset_.descriptions) known.push_back(muscle.name);
    driver.node.error(diagnostics_, fmt::format("the character has no muscle '{}' to drive this one", driver.text),
                      known.empty() ? "it has none at all: leave out \"driver\", and its bones carry it"
                                    : suggest_name(driver.text, known, "muscles"));
    return false;
  }

  // Fills in the attachments' vertices.
  void attach(const SurfaceMuscleEntry& entry, const SurfaceMesh& mesh, SurfaceMuscleDescription& muscle) {
    constexpr std::int32_t kFree = -1;
    std::vector<std::int32_t> owner(mesh.rest.positions.size(), kFree);
    for (std::size_t i = 0; i < entry.attachments.size(); ++i) {
      const SurfaceAttachmentEntry& attachment = entry.attachments[i];
      SurfaceAttachment& chosen = muscle.attachments[i];
      if (chosen.bone < 0) continue;
      chosen.vertices = choose_attached_vertices(attachment, mesh, asset_, chosen.bone,
                                                 file_.positions_in_character_space, diagnostics_);
      std::size_t shared = 0;
      std::int32_t with = kFree;
      for (const std::uint32_t vertex : chosen.vertices) {
        if (owner[vertex] == kFree) {
          owner[vertex] = static_cast<std::int32_t>(i);
        } else if (shared++ == 0) {
          with = owner[vertex];
        }
      }
      if (shared == 0) continue;
      attachment.node.error(diagnostics_,
                            fmt::format("{} of its {} vertices belong to attachment {} already ('{}')", shared,
                                        chosen.vertices.size(), with,
                                        entry.attachments[static_cast<std::size_t>(with)].bone.text),
                            "let the areas not overlap: a vertex follows one bone");
    }
    if (std::ranges::find(owner, kFree) == owner.end()) {
      entry.node.error(diagnostics_, fmt::format("all {} vertices are attached, and none is left to move", owner.size()),
                       "make the areas smaller");
    }
  }

  static glm::dvec3 middle(const SurfaceMuscleDescription& muscle, bool origin, std::size_t& count) {
    glm::dvec3 sum(0.0);
    count = 0;
    for (const SurfaceAttachment& attachment : muscle.attachments) {
      if (attachment.origin != origin) continue;
      for (const std::uint32_t vertex : attachment.vertices) sum += glm::dvec3(muscle.mesh.positions[vertex]);
      count += attachment.vertices.size();
    }
    return count == 0 ? sum : sum / static_cast<double>(count);
  }

  // Fibres run from the origin to the insertion, where the muscle has both.
  static void turn_fibres(SurfaceMuscleDescription& muscle) {
    std::size_t origins = 0, insertions = 0;
    const glm::dvec3 from = middle(muscle, true, origins);
    const glm::dvec3 to = middle(muscle, false, insertions);
    if (origins == 0 || insertions == 0) return;
    for (FibreLine& fibre : muscle.fibres) {
      const glm::dvec3 way = glm::dvec3(fibre.points.back()) - glm::dvec3(fibre.points.front());
      if (glm::dot(way, to - from) < 0.0) std::ranges::reverse(fibre.points);
    }
  }

  bool claim_name(const std::string& name, const JsonNode& node, bool mirrored) {
    const Diagnostic where = node.where();
    const auto [known, fresh] = names_.emplace(name, fmt::format("{}:{}", where.file, where.line));
    if (fresh) return true;
    node.error(diagnostics_,
               fmt::format("{} a second surface muscle '{}', the first is at {}",
                           mirrored ? "the mirror image would be" : "this is", name, known->second),
               mirrored ? "write only one side, or leave out \"mirror\"" : "give each surface muscle a name of its own");
    return false;
  }

  // `original`: null where it is wrong; what can be said without it is said all the same.
  void add_image(const SurfaceMuscleEntry& entry, const SurfaceMuscleDescription* original) {
    const MirrorRule& rule = file_.mirror;
    if (!rule.given()) {
      entry.node.member("mirror").error(
          diagnostics_, "the file has no mirror rule",
          "add \"mirror\": {\"axis\": \"x\", \"bones\": [[\"_r\", \"_l\"]], \"names\": [[\"_r\", \"_l\"]]}");
      return;
    }
    const std::optional<std::string> name = mirror_name(entry.name.text, rule.names);
    if (!name) {
      entry.name.node.error(diagnostics_,
                            fmt::format("'{}' holds none of the parts that the mirror rule exchanges", entry.name.text),
                            "give it a side, as in soleus_r, or add a pair to /mirror/names");
      return;
    }
    if (!claim_name(*name, entry.name.node, true) || original == nullptr) return;
    SurfaceMuscleDescription image = *original;
    image.name = *name;
    bool sound = mirror_bone(entry.node, image.frame_bone);
    for (SurfaceAttachment& attachment : image.attachments) sound = mirror_bone(entry.node, attachment.bone) && sound;
    for (ActionLinePoint& point : image.action_line) sound = mirror_bone(entry.node, point.bone) && sound;
    if (!entry.all_bones) {
      for (std::int32_t& bone : image.bones) sound = mirror_bone(entry.node, bone) && sound;
      std::ranges::sort(image.bones);
    }
    if (!image.driver.empty()) {
      image.driver = mirror_name(image.driver, rule.names).value_or(image.driver);
      if (!has_driver(image.driver)) {
        entry.driver.node.error(diagnostics_,
                                fmt::format("the mirror image's driver would be '{}', which the character doesn't have",
                                            image.driver),
                                "mirror the driver, too");
        sound = false;
      }
    }
    if (!sound) return;
    for (glm::vec3& position : image.mesh.positions) position = mirror_point(position, rule.axis);
    for (std::size_t i = 0; i + 2 < image.mesh.indices.size(); i += 3) {
      std::swap(image.mesh.indices[i + 1], image.mesh.indices[i + 2]);
    }
    for (FibreLine& fibre : image.fibres) {
      for (glm::vec3& point : fibre.points) point = mirror_point(point, rule.axis);
    }
    for (ActionLinePoint& point : image.action_line) point.position = mirror_point(point.position, rule.axis);
    add(image, entry);
  }

  bool mirror_bone(const JsonNode& node, std::int32_t& bone) {
    const std::string& name = asset_.skeleton->names[static_cast<std::size_t>(bone)];
    const std::optional<std::string> image = mirror_name(name, file_.mirror.bones);
    if (!image) return true;
    bone = asset_.skeleton->find(*image);
    if (bone >= 0) return true;
    node.error(diagnostics_,
               fmt::format("the mirror image of bone '{}' would be '{}', which the skeleton doesn't have", name, *image),
               suggest_name(*image, asset_.skeleton->names, "bones"));
    bone = 0;
    return false;
  }

  void add(const SurfaceMuscleDescription& muscle, const SurfaceMuscleEntry& entry) {
    asset_.surface_descriptions.push_back(muscle);
    hide_driver(muscle, entry);
  }

  void hide_driver(const SurfaceMuscleDescription& muscle, const SurfaceMuscleEntry& entry) {
    asset_.hidden_muscles.resize(asset_.descriptions.size(), 0);
    if (muscle.driver.empty() || !entry.hide_driver) return;
    for (std::size_t i = 0; i < asset_.descriptions.size(); ++i) {
      if (asset_.descriptions[i].name == muscle.driver) asset_.hidden_muscles[i] = 1;
    }
  }

  const CharacterFile& file_;
  const fs::path& base_;
  ContentSources& sources_;
  MuscleNames& names_;
  CharacterAsset& asset_;
  Diagnostics& diagnostics_;
};

// The fibres' builder knows a muscle's name and no file.
void place_at(const Diagnostic& where, const char* field, Diagnostics& found) {
  const auto place = [&](Diagnostic& one) {
    one.file = where.file;
    one.line = where.line;
    one.column = where.column;
    one.path = where.path + field;
  };
  std::ranges::for_each(found.errors, place);
  std::ranges::for_each(found.warnings, place);
}

}  // namespace

void load_surface_muscles(const CharacterFile& file, const fs::path& base, ContentSources& sources, MuscleNames& names,
                          CharacterAsset& asset, Diagnostics& diagnostics) {
  SurfaceLoads loads(file, base, sources, names, asset, diagnostics);
  for (const SurfaceMuscleEntry& entry : file.surface_muscles) loads.load(entry);
}

void build_surface_muscles(CharacterAsset& asset, Diagnostics& diagnostics) {
  const std::size_t count = asset.surface_descriptions.size();
  const auto bones = static_cast<std::uint32_t>(asset.skeleton->size());
  asset.surface_muscles.assign(count, nullptr);
  asset.fibre_bundles.assign(count, nullptr);
  asset.hulls.assign(count, nullptr);
  std::vector<Diagnostics> found(count);
  parallel::for_range(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfaceMuscleDescription& muscle = asset.surface_descriptions[i];
      auto built = build_surface_asset(muscle, bones, asset.muscles.get());
      if (built) asset.surface_muscles[i] = *built;
      found[i] = std::move(built.diagnostics());
      if (!asset.surface_muscles[i] || !muscle.fibre_bundle) continue;
      auto bundle = build_fibre_bundle(*asset.surface_muscles[i], *muscle.fibre_bundle);
      if (bundle) asset.fibre_bundles[i] = *bundle;
      place_at(muscle.where, "/inner_fibres", bundle.diagnostics());
      found[i].append(std::move(bundle.diagnostics()));
    }
  });
  for (Diagnostics& each : found) diagnostics.append(std::move(each));
}

}  // namespace fascicle::muscle
