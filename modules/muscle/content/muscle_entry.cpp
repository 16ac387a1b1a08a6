// One muscle of a character file. Ranges are those of anything that walks on earth, from a mouse to an elephant,
// in SI units: a figure outside them is a slip of unit.

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "modules/muscle/content/character_file.hpp"

namespace fascicle::muscle {

namespace {

constexpr double kMaxPosition = 100.0;  // m from the bone or the character's origin
constexpr double kMaxLength = 100.0;    // m
constexpr double kMaxForce = 1e7;       // N

AttachmentEntry read_attachment(const JsonNode& node, bool is_via, const ReadContext& context) {
  AttachmentEntry entry;
  entry.node = node;
  JsonObject object(node, context.diagnostics);
  entry.bone = read_name(object, "bone", true);
  glm::vec3 position(0.0f);
  entry.position_node = object.require("position");
  if (entry.position_node.exists() &&
      entry.position_node.read(position, context.diagnostics, between(-kMaxPosition, kMaxPosition))) {
    entry.position = position;
  }
  if (is_via) object.optional("counts", entry.counts);
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
  const JsonNode fractions = object.require_array("fractions", 2, 64);
  const JsonNode radii = object.require_array("radii", 2, 64);
  object.optional("absolute", profile.absolute);
  if (fractions.exists()) fractions.read(profile.fractions, context.diagnostics, between(0, 1));
  // Relative radii are weights; absolute ones metres.
  if (radii.exists()) radii.read(profile.radii, context.diagnostics, between(0, profile.absolute ? 10 : 1e6));
  if (fractions.exists() && radii.exists()) check_profile(profile, fractions, radii, context.diagnostics);
  finish_object(object, "profile", context);
}

void read_tendon(const JsonNode& node, MuscleDescription& values, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  const bool origin = object.optional("origin", values.tendon_at_origin, between(0, 1));
  const bool insertion = object.optional("insertion", values.tendon_at_insertion, between(0, 1));
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
  if (value >= std::numbers::pi / 2) {
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

// Rest radii come from pcsa, volume, an absolute profile, or the force; volumes of the first and last need the fibre
// length as well.
void check_thickness(const MuscleDescription& values, const JsonNode& node, Diagnostics& diagnostics) {
  if (values.volume || values.profile.absolute) return;
  if (!values.pcsa && values.hill.max_isometric_force <= 0.0f) {
    node.error(diagnostics, "nothing says how thick the muscle is",
               "give max_isometric_force (N), pcsa (m^2), volume (m^3) or a profile with absolute radii (m)");
  } else if (values.hill.optimal_fibre_length <= 0.0f) {
    node.error(diagnostics, "the belly's volume follows from its cross section and its fibre length, which is missing",
               "give optimal_fibre_length (m)");
  }
}

}  // namespace

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

void read_level(JsonObject& object, std::optional<std::uint32_t>& section_vertices,
                std::optional<std::uint32_t>& longitudinal_subdivision) {
  const JsonNode node = object.optional("section_vertices");
  std::uint32_t count = 0;
  if (node.exists() && node.read(count, object.diagnostics(), between(6, 256))) {
    if (count % 2 != 0) {
      node.error(object.diagnostics(), fmt::format("{} vertices a section is odd: opposites would not exist", count),
                 fmt::format("give an even number, {} or {}", count - 1, count + 1));
    } else {
      section_vertices = count;
    }
  }
  std::uint32_t subdivision = 0;
  if (object.optional("longitudinal_subdivision", subdivision, between(0, 6))) longitudinal_subdivision = subdivision;
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
  for (const JsonNode via : object.optional_array("via", 0, 256)) {
    entry.attachments.push_back(read_attachment(via, true, context));
  }
  if (const JsonNode insertion = object.require("insertion"); insertion.exists()) {
    entry.attachments.push_back(read_attachment(insertion, false, context));
  }
  object.optional("max_isometric_force", values.hill.max_isometric_force, between(0, kMaxForce));
  object.optional("optimal_fibre_length", values.hill.optimal_fibre_length,
                  NumberRange{.min = 0, .max = kMaxLength, .above_min = true});
  object.optional("tendon_slack_length", values.hill.tendon_slack_length, between(0, kMaxLength));
  read_pennation(object, values.hill.pennation);
  object.optional("source_length", values.source_length, NumberRange{.min = 0, .max = kMaxLength, .above_min = true});
  object.optional("specific_tension", values.specific_tension, between(1e4, 1e7));
  object.optional("pcsa", values.pcsa, NumberRange{.min = 0, .max = 100, .above_min = true});
  object.optional("volume", values.volume, NumberRange{.min = 0, .max = 100, .above_min = true});
  if (const JsonNode profile = object.optional("profile"); profile.exists()) {
    read_profile(profile, values.profile, context);
  }
  if (const JsonNode tendon = object.optional("tendon"); tendon.exists()) read_tendon(tendon, values, context);
  read_level(object, entry.section_vertices, entry.longitudinal_subdivision);
  entry.mesh = read_name(object, "mesh", false);
  if (const JsonNode groups = object.optional("groups"); groups.exists()) {
    groups.read(values.groups, context.diagnostics);
  }
  finish_object(object, "muscle", context);
  // A wrong figure has its own error; what follows from it would only repeat it.
  if (context.diagnostics.errors.size() == errors_before) check_thickness(values, node, context.diagnostics);
  entry.sound = context.diagnostics.errors.size() == errors_before;
  return entry;
}

}  // namespace fascicle::muscle
