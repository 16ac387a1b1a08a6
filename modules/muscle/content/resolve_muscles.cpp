#include "modules/muscle/content/resolve_muscles.hpp"

#include <optional>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "engine/content/closest_name.hpp"
#include "modules/muscle/content/attachment_rules.hpp"
#include "modules/muscle/content/mirror.hpp"

namespace fascicle::muscle {

namespace {

struct Resolver {
  const CharacterFile& file;
  const Skeleton& skeleton;
  const LoadOptions& options;
  std::vector<glm::dmat4> to_bone;  // inverse rest matrices
  MuscleNames& names;
  Diagnostics& diagnostics;
};

std::int32_t look_up_bone(const Resolver& resolver, const NameEntry& name) {
  const std::int32_t bone = resolver.skeleton.find(name.text);
  if (bone < 0) {
    name.node.error(resolver.diagnostics, fmt::format("the skeleton has no bone '{}'", name.text),
                    suggest_name(name.text, resolver.skeleton.names, "bones"));
  }
  return bone;
}

// All bones are looked up even where one is unknown, so that each is reported. Empty where one is wrong.
std::vector<PlacedAttachment> place_attachments(const Resolver& resolver, const MuscleEntry& entry) {
  std::vector<PlacedAttachment> line;
  bool sound = entry.attachments.size() >= 2;
  for (const AttachmentEntry& attachment : entry.attachments) {
    PlacedAttachment placed;
    placed.node = attachment.position_node.exists() ? attachment.position_node : attachment.node;
    placed.bone_node = attachment.bone.node;
    if (attachment.bone.given()) placed.bone = look_up_bone(resolver, attachment.bone);
    if (placed.bone < 0 || !attachment.position) {
      sound = false;
      continue;
    }
    const glm::mat4& rest = resolver.skeleton.rest_world[static_cast<std::size_t>(placed.bone)];
    placed.rest = resolver.file.positions_in_character_space
                      ? *attachment.position
                      : glm::vec3(rest * glm::vec4(*attachment.position, 1.0f));
    line.push_back(placed);
  }
  if (!sound) line.clear();
  return line;
}

MuscleDescription describe(const Resolver& resolver, const MuscleEntry& entry, const std::string& name,
                           std::span<const PlacedAttachment> line, bool as_written) {
  MuscleDescription description = entry.values;
  const CharacterFile& file = resolver.file;
  description.name = name;
  for (std::size_t i = 0; i < line.size(); ++i) {
    AttachmentDescription attachment;
    attachment.bone = line[i].bone;
    attachment.counts = entry.attachments[i].counts;
    // A position given in the bone's frame stays as it is, bit for bit.
    attachment.position =
        as_written && !file.positions_in_character_space
            ? *entry.attachments[i].position
            : glm::vec3(resolver.to_bone[static_cast<std::size_t>(line[i].bone)] * glm::dvec4(line[i].rest, 1.0));
    description.attachments.push_back(attachment);
  }
  const auto pick = [](std::optional<std::uint32_t> first, std::optional<std::uint32_t> second,
                       std::optional<std::uint32_t> third, std::uint32_t otherwise) {
    return first ? *first : second ? *second : third.value_or(otherwise);
  };
  description.section_vertices = pick(resolver.options.section_vertices, entry.level.section_vertices,
                                      file.level.section_vertices, description.section_vertices);
  description.longitudinal_subdivision =
      pick(resolver.options.longitudinal_subdivision, entry.level.longitudinal_subdivision,
           file.level.longitudinal_subdivision, description.longitudinal_subdivision);
  if (description.specific_tension == 0.0f) description.specific_tension = file.specific_tension;
  return description;
}

// The bound by which the fit chooses the level, where no counts are given nearer to the muscle.
std::optional<float> pick_max_distance(const Resolver& resolver, const MuscleEntry& entry) {
  if (resolver.options.section_vertices || resolver.options.longitudinal_subdivision) return std::nullopt;
  if (entry.level.section_vertices || entry.level.longitudinal_subdivision) return std::nullopt;
  return entry.level.max_distance ? entry.level.max_distance : resolver.file.level.max_distance;
}

// An area's bone must be there; where no bone is named it is the attachment's.
void check_areas(const Resolver& resolver, const MuscleEntry& entry) {
  for (const AttachmentEntry& attachment : entry.attachments) {
    if (attachment.area.bone.given()) look_up_bone(resolver, attachment.area.bone);
  }
}

// What both sides of a muscle share.
ResolvedMuscle resolve_common(const Resolver& resolver, const MuscleEntry& entry) {
  ResolvedMuscle muscle;
  muscle.source = &resolver.file;
  muscle.mesh = entry.mesh;
  muscle.areas = {entry.attachments.front().area, entry.attachments.back().area};
  muscle.fit = resolver.file.fit && entry.fit;
  muscle.max_distance = pick_max_distance(resolver, entry);
  return muscle;
}

// False where a muscle of that name is there already.
bool claim_name(const Resolver& resolver, const std::string& name, const JsonNode& node, bool mirrored) {
  const Diagnostic where = node.where();
  const auto [known, fresh] = resolver.names.emplace(name, fmt::format("{}:{}", where.file, where.line));
  if (fresh) return true;
  node.error(resolver.diagnostics,
             fmt::format("{} a second muscle '{}', the first is at {}",
                         mirrored ? "the mirror image would be" : "this is", name, known->second),
             mirrored ? "write only one side, or leave out \"mirror\"" : "give each muscle a name of its own");
  return false;
}

// The line on the other side; empty where a bone has no counterpart, which is an error.
std::vector<PlacedAttachment> mirror_line(const Resolver& resolver, std::span<const PlacedAttachment> line) {
  const MirrorRule& rule = resolver.file.mirror;
  std::vector<PlacedAttachment> mirrored;
  bool sound = true;
  for (PlacedAttachment placed : line) {
    const std::string& bone = resolver.skeleton.names[static_cast<std::size_t>(placed.bone)];
    if (const std::optional<std::string> image = mirror_name(bone, rule.bones)) {
      placed.bone = resolver.skeleton.find(*image);
      if (placed.bone < 0) {
        placed.bone_node.error(
            resolver.diagnostics,
            fmt::format("the mirror image of bone '{}' would be '{}', which the skeleton doesn't have", bone, *image),
            suggest_name(*image, resolver.skeleton.names, "bones"));
        sound = false;
      }
    }
    placed.rest = mirror_point(placed.rest, rule.axis);
    mirrored.push_back(placed);
  }
  if (!sound) mirrored.clear();
  return mirrored;
}

void add_mirror_image(const Resolver& resolver, const MuscleEntry& entry, std::span<const PlacedAttachment> line,
                      std::vector<ResolvedMuscle>& muscles) {
  const MirrorRule& rule = resolver.file.mirror;
  const JsonNode flag = entry.node.member("mirror");
  if (!rule.given()) {
    flag.error(resolver.diagnostics, "the file has no mirror rule",
               "add \"mirror\": {\"axis\": \"x\", \"bones\": [[\"_r\", \"_l\"]], \"names\": [[\"_r\", \"_l\"]]}");
    return;
  }
  if (rule.names.empty() || rule.bones.empty()) return;  // reported where the rule was read
  const std::optional<std::string> name = mirror_name(entry.name.text, rule.names);
  if (!name) {
    entry.name.node.error(resolver.diagnostics,
                          fmt::format("'{}' holds none of the parts that the mirror rule exchanges", entry.name.text),
                          "give it a side, as in soleus_r, or add a pair to /mirror/names");
    return;
  }
  const bool fresh = claim_name(resolver, *name, entry.name.node, true);
  const std::vector<PlacedAttachment> mirrored = mirror_line(resolver, line);
  if (!fresh || mirrored.empty() || !entry.sound) return;
  ResolvedMuscle muscle = resolve_common(resolver, entry);
  muscle.description = describe(resolver, entry, *name, mirrored, false);
  for (std::string& group : muscle.description.groups) group = mirror_name(group, rule.names).value_or(group);
  muscle.mirror_axis = rule.axis;
  for (AreaEntry& area : muscle.areas) area.bone.text = mirror_name(area.bone.text, rule.bones).value_or(area.bone.text);
  if (entry.mesh.name.given()) {
    muscle.mirrored_mesh = entry.mesh.name;
    muscle.mesh.name.text = mirror_name(entry.mesh.name.text, rule.names).value_or(entry.mesh.name.text);
  }
  muscle.description.mesh = muscle.mesh.name.given() ? muscle.mesh.name.text : muscle.mesh.file.text;
  muscles.push_back(std::move(muscle));
}

}  // namespace

void resolve_muscles(const CharacterFile& file, const Skeleton& skeleton, const LoadOptions& options,
                     MuscleNames& names, std::vector<ResolvedMuscle>& muscles, Diagnostics& diagnostics) {
  Resolver resolver{file, skeleton, options, {}, names, diagnostics};
  for (const glm::mat4& rest : skeleton.rest_world) resolver.to_bone.push_back(glm::inverse(glm::dmat4(rest)));
  for (const MuscleEntry& entry : file.muscles) {
    const bool fresh = !entry.name.given() || claim_name(resolver, entry.name.text, entry.name.node, false);
    const std::vector<PlacedAttachment> line = place_attachments(resolver, entry);
    check_areas(resolver, entry);
    const bool sane = !line.empty() && check_attachments(line, entry.values, skeleton, file.mirror, diagnostics);
    if (sane && fresh && entry.sound) {
      ResolvedMuscle muscle = resolve_common(resolver, entry);
      muscle.description = describe(resolver, entry, entry.name.text, line, true);
      muscle.description.mesh = entry.mesh.name.given() ? entry.mesh.name.text : entry.mesh.file.text;
      muscles.push_back(std::move(muscle));
    }
    if (entry.mirror && fresh && entry.name.given()) {
      add_mirror_image(resolver, entry, sane ? std::span(line) : std::span<const PlacedAttachment>(), muscles);
    }
  }
}

}  // namespace fascicle::muscle
