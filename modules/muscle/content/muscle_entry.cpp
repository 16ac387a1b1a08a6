// One muscle of a character file. Ranges: modules/muscle/asset/muscle_limits.hpp.

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "modules/muscle/asset/check_descriptions.hpp"
#include "modules/muscle/asset/muscle_limits.hpp"
#include "modules/muscle/content/character_file.hpp"

namespace fascicle::muscle {

namespace {

constexpr float kMillimetre = 1.0e-3f;  // m

AreaEntry read_area(const JsonNode& node, const ReadContext& context) {
  AreaEntry area;
  JsonObject object(node, context.diagnostics);
  float distance = 0.0f;
  const bool of_bone = object.optional("within_mm", distance, kAreaRange);
  const bool of_point = object.optional("radius_mm", distance, kAreaRange);
  area.bone = read_name(object, "bone", false);
  if (object.valid() && object.optional("within_mm").exists() == object.optional("radius_mm").exists()) {
    node.error(context.diagnostics, of_bone ? "the area has both 'within_mm' and 'radius_mm'" : "the area has no size",
               "give one: \"within_mm\", the mesh's distance from the bone, or \"radius_mm\", from this point");
  } else if (of_point && area.bone.given()) {
    area.bone.node.error(context.diagnostics, "'bone' means nothing beside 'radius_mm'",
                         "leave it out, or give \"within_mm\"");
  } else if (of_bone || of_point) {
    area.node = node;
    area.of_bone = of_bone;
    area.within = kMillimetre * distance;
  }
  finish_object(object, "area", context);
  return area;
}

AttachmentEntry read_attachment(const JsonNode& node, bool is_via, const ReadContext& context) {
  AttachmentEntry entry;
  entry.node = node;
  JsonObject object(node, context.diagnostics);
  entry.bone = read_name(object, "bone", true);
  glm::vec3 position(0.0f);
  entry.position_node = object.require("position");
  if (entry.position_node.exists() &&
      entry.position_node.read(position, context.diagnostics, kPositionRange)) {
    entry.position = position;
  }
  if (is_via) {
    object.optional("counts", entry.counts);
  } else if (const JsonNode area = object.optional("area"); area.exists()) {
    entry.area = read_area(area, context);
  }
  finish_object(object, is_via ? "via" : "attachment", context);
  return entry;
}

void check_profile(const RadiusProfile& profile, const JsonNode& fractions, const JsonNode& radii,
                   Diagnostics& diagnostics) {
  if (fractions.size() != profile.fractions.size() || radii.size() != profile.radii.size()) return;  // wrong already
  for (std::size_t i = 1; i < profile.fractions.size(); ++i) {
    if (profile.fractions[i] > profile.fractions[i - 1]) continue;
    fractions.element(i).error(diagnostics,
                               fmt::format("the fractions don't rise: {} follows {}", profile.fractions[i],
                                           profile.fractions[i - 1]),
                               "order them from origin (0) to insertion (1), each larger than the one before");
  }
  if (profile.fractions.size() != profile.radii.size()) {
    radii.error(diagnostics,
                fmt::format("{} radii stand against {} fractions", profile.radii.size(), profile.fractions.size()),
                "give one radius for each fraction");
  }
  bool any = false;
  for (const float radius : profile.radii) any = any || radius > 0.0f;
  if (!any && !profile.radii.empty()) {
    radii.error(diagnostics, "all radii are 0", "give at least one a positive radius");
  }
}

void read_profile(const JsonNode& node, RadiusProfile& profile, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  const JsonNode fractions = object.require_array("fractions", kFewestProfilePoints, kMostProfilePoints);
  const JsonNode radii = object.require_array("radii", kFewestProfilePoints, kMostProfilePoints);
  object.optional("absolute", profile.absolute);
  if (fractions.exists()) fractions.read(profile.fractions, context.diagnostics, kFractionRange);
  // Relative radii are weights; absolute ones metres.
  const NumberRange& range = profile.absolute ? kRadiusRange : kRelativeRadiusRange;
  if (radii.exists()) radii.read(profile.radii, context.diagnostics, range);
  if (fractions.exists() && radii.exists()) check_profile(profile, fractions, radii, context.diagnostics);
  finish_object(object, "profile", context);
}

void read_tendon(const JsonNode& node, MuscleDescription& values, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  const bool origin = object.optional("origin", values.tendon_at_origin, kFractionRange);
  const bool insertion = object.optional("insertion", values.tendon_at_insertion, kFractionRange);
  finish_object(object, "tendon", context);
  const float sum = values.tendon_at_origin + values.tendon_at_insertion;
  if ((origin || insertion) && sum > 1.0f) {
    node.error(context.diagnostics,
               fmt::format("the two tendons take {} of the tendon's length", sum),
               "let origin and insertion add up to 1 at most (left out: 0 and 0.5)");
  }
}

void read_pennation(JsonObject& object, float& pennation) {
  const JsonNode node = object.optional("pennation");
  double value = 0.0;
  if (!node.exists() || !node.read(value, object.diagnostics(), at_least(0))) return;
  if (static_cast<float>(value) >= kRightAngle) {
    std::string remedy = "give radians, at least 0 and less than pi/2 = 1.5708";
    if (value > std::numbers::pi && value < 90.0) {
      remedy += fmt::format("; {} degrees are {:.4g} rad", value, value * std::numbers::pi / 180.0);
    }
    node.error(object.diagnostics(), fmt::format("the pennation angle {} is a right angle or more", value),
               std::move(remedy));
    return;
  }
  pennation = static_cast<float>(value);
}

}  // namespace

MeshEntry read_mesh_entry(const JsonNode& node, const ReadContext& context) {
  MeshEntry entry;
  if (node.is_string()) {
    if (!node.read(entry.name.text, context.diagnostics)) return entry;
    if (entry.name.text.empty()) {
      node.error(context.diagnostics, "'mesh' is empty", "give a name");
      return entry;
    }
    entry.name.node = entry.node = node;
    return entry;
  }
  if (!node.is_object()) {
    node.error(context.diagnostics, "'mesh' is neither a name nor an object",
               "name a mesh of \"muscle_meshes\", or give {\"file\": \"soleus.stl\", \"unit\": \"mm\"}");
    return entry;
  }
  JsonObject object(node, context.diagnostics);
  entry.file = read_name(object, "file", true);
  read_unit(object, entry.unit);
  read_placement(object, entry.transform);
  finish_object(object, "mesh", context);
  if (entry.file.given()) entry.node = node;
  return entry;
}

NameEntry read_name(JsonObject& object, std::string_view field, bool required) {
  NameEntry entry;
  const JsonNode node = required ? object.require(field) : object.optional(field);
  if (!node.exists() || !node.read(entry.text, object.diagnostics())) return entry;
  if (entry.text.empty()) {
    node.error(object.diagnostics(), fmt::format("'{}' is empty", field), "give a name");
    return entry;
  }
  entry.node = node;
  return entry;
}

void read_level(JsonObject& object, LevelEntry& level) {
  const JsonNode node = object.optional("section_vertices");
  std::uint32_t count = 0;
  if (node.exists() && node.read(count, object.diagnostics(), kSectionVerticesRange)) {
    if (count % 2 != 0) {
      node.error(object.diagnostics(), fmt::format("{} vertices a section is odd: opposites would not exist", count),
                 fmt::format("give an even number, {} or {}", count - 1, count + 1));
    } else {
      level.section_vertices = count;
    }
  }
  std::uint32_t subdivision = 0;
  if (object.optional("longitudinal_subdivision", subdivision, kSubdivisionRange)) {
    level.longitudinal_subdivision = subdivision;
  }
  float distance = 0.0f;
  if (object.optional("max_distance_mm", distance, kMaxDistanceRange)) {
    if (level.section_vertices || level.longitudinal_subdivision) {
      object.optional("max_distance_mm")
          .error(object.diagnostics(), "'max_distance_mm' chooses the level, and it is given too",
                 "leave out \"section_vertices\" and \"longitudinal_subdivision\", or this");
    } else {
      level.max_distance = kMillimetre * distance;
    }
  }
}

MuscleEntry read_muscle_entry(const JsonNode& node, const ReadContext& context) {
  const std::size_t errors_before = context.diagnostics.errors.size();
  MuscleEntry entry;
  entry.node = node;
  entry.values.where = node.where();
  JsonObject object(node, context.diagnostics);
  MuscleDescription& values = entry.values;
  entry.name = read_name(object, "name", true);
  object.optional("mirror", entry.mirror);
  if (const JsonNode origin = object.require("origin"); origin.exists()) {
    entry.attachments.push_back(read_attachment(origin, false, context));
  }
  for (const JsonNode via : object.optional_array("via", 0, kMostViaPoints)) {
    entry.attachments.push_back(read_attachment(via, true, context));
  }
  if (const JsonNode insertion = object.require("insertion"); insertion.exists()) {
    entry.attachments.push_back(read_attachment(insertion, false, context));
  }
  // A wrong figure has its own error, as has a misspelled field; that the thickness then misses it needs none.
  bool thickness_known = true;
  const auto count_errors = [&] { return context.diagnostics.errors.size(); };
  const auto read_thickness = [&](std::string_view field, auto& value, const NumberRange& range) {
    const std::size_t before = count_errors();
    object.optional(field, value, range);
    thickness_known = thickness_known && count_errors() == before;
  };
  read_thickness("max_isometric_force", values.hill.max_isometric_force, kForceRange);
  read_thickness("optimal_fibre_length", values.hill.optimal_fibre_length, kFibreLengthRange);
  object.optional("tendon_slack_length", values.hill.tendon_slack_length, kTendonLengthRange);
  read_pennation(object, values.hill.pennation);
  object.optional("source_length", values.source_length, kSourceLengthRange);
  object.optional("specific_tension", values.specific_tension, kSpecificTensionRange);
  read_thickness("pcsa", values.pcsa, kPcsaRange);
  read_thickness("volume", values.volume, kVolumeRange);
  if (const JsonNode profile = object.optional("profile"); profile.exists()) {
    const std::size_t before = count_errors();
    read_profile(profile, values.profile, context);
    thickness_known = thickness_known && count_errors() == before;
  }
  if (const JsonNode tendon = object.optional("tendon"); tendon.exists()) read_tendon(tendon, values, context);
  read_level(object, entry.level);
  if (const JsonNode mesh = object.optional("mesh"); mesh.exists()) entry.mesh = read_mesh_entry(mesh, context);
  object.optional("fit", entry.fit);
  if (const JsonNode groups = object.optional("groups"); groups.exists()) {
    groups.read(values.groups, context.diagnostics);
  }
  const std::size_t before_finish = count_errors();
  finish_object(object, "muscle", context);
  if (thickness_known && object.valid() && count_errors() == before_finish) {
    const std::optional<MissingThickness> missing = find_missing_thickness(values);
    if (missing) node.error(context.diagnostics, missing->cause, missing->remedy);
  }
  entry.sound = context.diagnostics.errors.size() == errors_before;
  return entry;
}

}  // namespace fascicle::muscle
