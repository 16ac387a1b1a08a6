#include "modules/muscle/content/collision_file.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "modules/muscle/content/collision_limits.hpp"

namespace fascicle::muscle {

namespace {

constexpr float kThousandth = 1.0e-3f;  // ms to s, mm to m

void read_thousandths(JsonObject& object, std::string_view field, float& value, const NumberRange& range) {
  float thousandths = 0.0f;
  if (object.optional(field, thousandths, range)) value = kThousandth * thousandths;
}

void read_settings(const JsonNode& node, CollisionSettings& settings, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  object.optional("enabled", settings.enabled);
  std::size_t mode = 0;
  if (object.optional_choice("mode", mode, {"reduced", "legacy"})) {
    settings.mode = mode == 0 ? CollisionMode::kReduced : CollisionMode::kLegacy;
  }
  object.optional("substeps", settings.substeps, kSubstepsRange);
  object.optional("iterations", settings.iterations, kIterationsRange);
  read_thousandths(object, "shape_time_ms", settings.shape_time, kRelaxationRange);
  read_thousandths(object, "line_time_ms", settings.line_time, kRelaxationRange);
  read_thousandths(object, "via_time_ms", settings.via_time, kRelaxationRange);
  object.optional("smoothing", settings.smoothing, kSmoothingRange);
  read_thousandths(object, "bone_margin_mm", settings.bone_margin, kMarginRange);
  read_thousandths(object, "muscle_margin_mm", settings.muscle_margin, kMarginRange);
  read_thousandths(object, "sample_spacing_mm", settings.sample_spacing, kSampleSpacingRange);
  read_thousandths(object, "bone_voxel_mm", settings.bone_voxel, kBoneVoxelRange);
  object.optional("keep_volume", settings.keep_volume);
  finish_object(object, "settings", context);
}

MirrorEntry read_mirror_flag(JsonObject& object) {
  MirrorEntry entry;
  const JsonNode node = object.optional("mirror");
  if (node.exists() && node.read(entry.wanted, object.diagnostics())) entry.node = node;
  return entry;
}

// An end section is attached to its bone, so that a tag there would hold nothing.
void read_at(const JsonNode& node, float& at, Diagnostics& diagnostics) {
  double value = 0.0;
  if (!node.exists() || !node.read(value, diagnostics)) return;
  if (value < kPlaceRange.min || value > kPlaceRange.max) {
    const bool end = value >= 0.0 && value <= 1.0;
    node.error(diagnostics,
               end ? fmt::format("{} is an end of the muscle, whose section is attached to bone and cannot move", value)
                   : fmt::format("{} is out of range", value),
               fmt::format("give a fraction of the muscle's length, from {} (by the origin) to {} (by the insertion)",
                           kPlaceRange.min, kPlaceRange.max));
    return;
  }
  at = static_cast<float>(value);
}

void read_angle(const JsonNode& node, float& angle, Diagnostics& diagnostics) {
  double value = 0.0;
  if (!node.exists() || !node.read(value, diagnostics)) return;
  if (value < kAngleRange.min || value > kAngleRange.max) {
    const double turn = 2.0 * std::numbers::pi;
    std::string remedy = "give radians from 0 to 2 pi = 6.2832";
    if (value > kAngleRange.max && value <= 360.0) {
      remedy += fmt::format("; {} degrees are {:.4g} rad", value, value * std::numbers::pi / 180.0);
    } else if (std::abs(value) < 100.0) {
      remedy += fmt::format("; {} is {:.4g} after whole turns", value, value - turn * std::floor(value / turn));
    }
    node.error(diagnostics, fmt::format("the angle {} is out of range", value), std::move(remedy));
    return;
  }
  const float turn = 2.0f * std::numbers::pi_v<float>;
  angle = static_cast<float>(value) < turn ? static_cast<float>(value) : 0.0f;
}

PlaceEntry read_place(const JsonNode& node, const ReadContext& context) {
  PlaceEntry place;
  place.node = node;
  JsonObject object(node, context.diagnostics);
  place.muscle = read_name(object, "muscle", true);
  read_at(object.require("at"), place.at, context.diagnostics);
  read_angle(object.require("angle"), place.angle, context.diagnostics);
  finish_object(object, "place", context);
  return place;
}

// A place, or {"bone": NAME}.
PlaceEntry read_partner(const JsonNode& node, const ReadContext& context) {
  PlaceEntry place;
  place.node = node;
  JsonObject object(node, context.diagnostics);
  place.muscle = read_name(object, "muscle", false);
  const JsonNode at = object.optional("at"), angle = object.optional("angle");
  place.bone = read_name(object, "bone", false);
  const JsonNode muscle_node = object.optional("muscle"), bone_node = object.optional("bone");
  if (object.valid() && bone_node.exists() && (muscle_node.exists() || at.exists() || angle.exists())) {
    node.error(context.diagnostics, "the second end has both a bone and a place on a muscle",
               "give {\"bone\": ...}, or \"muscle\", \"at\" and \"angle\"");
  } else if (object.valid() && !bone_node.exists() && !muscle_node.exists()) {
    node.error(context.diagnostics, "the second end names neither a muscle nor a bone",
               "give {\"bone\": ...}, or \"muscle\", \"at\" and \"angle\"");
  } else if (object.valid() && muscle_node.exists()) {
    read_at(object.require("at"), place.at, context.diagnostics);
    read_angle(object.require("angle"), place.angle, context.diagnostics);
  }
  finish_object(object, "partner", context);
  return place;
}

TransversalEntry read_transversal(const JsonNode& node, const ReadContext& context) {
  const std::size_t errors_before = context.diagnostics.errors.size();
  TransversalEntry entry;
  entry.node = node;
  JsonObject object(node, context.diagnostics);
  if (const JsonNode first = object.require("first"); first.exists()) entry.first = read_place(first, context);
  if (const JsonNode second = object.require("second"); second.exists()) entry.second = read_partner(second, context);
  std::size_t choice = 0;
  if (object.optional_choice("yields", choice, {"both", "first", "second"})) {
    entry.yields_node = object.optional("yields");
    entry.yields = static_cast<Yields>(choice);
  }
  object.optional("sweeps", entry.sweeps);
  entry.mirror = read_mirror_flag(object);
  object.optional("automatic", entry.automatic);
  finish_object(object, "transversal", context);
  if (entry.second.bone.given()) {  // bones never move
    if (entry.yields_node.exists() && entry.yields != Yields::kFirst) {
      entry.yields_node.error(context.diagnostics, "the second end is a bone, which never yields",
                              "write \"first\", or leave \"yields\" out");
    }
    entry.yields = Yields::kFirst;
  }
  entry.sound = context.diagnostics.errors.size() == errors_before;
  return entry;
}

StayOutEntry read_stay_out(const JsonNode& node, const ReadContext& context) {
  const std::size_t errors_before = context.diagnostics.errors.size();
  StayOutEntry entry;
  entry.node = node;
  JsonObject object(node, context.diagnostics);
  entry.muscle = read_name(object, "muscle", true);
  object.optional("from", entry.from, kStretchRange);
  const bool to_fine = object.optional("to", entry.to, kStretchRange) || !object.optional("to").exists();
  if (to_fine && !(entry.from < entry.to)) {
    const JsonNode place = object.optional("from").exists() ? object.optional("from") : object.optional("to");
    place.error(context.diagnostics, fmt::format("no section lies from {} to {}", entry.from, entry.to),
                "let \"from\" be less than \"to\", as fractions of the muscle's length from its origin");
  }
  for (const JsonNode bone : object.require_array("bones", 1, kMostStayOutBones)) {
    NameEntry name;
    if (!bone.read(name.text, context.diagnostics)) continue;
    if (name.text.empty()) {
      bone.error(context.diagnostics, "the bone's name is empty", "give a name");
      continue;
    }
    name.node = bone;
    entry.bones.push_back(std::move(name));
  }
  entry.mirror = read_mirror_flag(object);
  object.optional("automatic", entry.automatic);
  finish_object(object, "stay_out", context);
  entry.sound = context.diagnostics.errors.size() == errors_before;
  return entry;
}

IgnoredEntry read_ignored(const JsonNode& node, const ReadContext& context) {
  const std::size_t errors_before = context.diagnostics.errors.size();
  IgnoredEntry entry;
  entry.node = node;
  JsonObject object(node, context.diagnostics);
  entry.muscle = read_name(object, "muscle", true);
  entry.other = read_name(object, "other", false);
  entry.bone = read_name(object, "bone", false);
  if (object.valid() && object.optional("other").exists() == object.optional("bone").exists()) {
    node.error(context.diagnostics,
               entry.bone.given() ? "the pair has both 'other' and 'bone'" : "the pair lacks its second part",
               "give one: \"other\", a muscle, or \"bone\"");
  }
  entry.mirror = read_mirror_flag(object);
  finish_object(object, "ignore", context);
  entry.sound = context.diagnostics.errors.size() == errors_before;
  return entry;
}

}  // namespace

CollisionFile read_collision_file(const JsonNode& root, const ReadContext& context) {
  CollisionFile file;
  file.root = root;
  JsonObject object(root, context.diagnostics);
  std::string schema;
  object.optional("$schema", schema);
  object.require("version");  // its value is migrate's business
  if (const JsonNode node = object.optional("settings"); node.exists()) read_settings(node, file.settings, context);
  for (const JsonNode node : object.optional_array("transversals", 0, kMostTags)) {
    file.transversals.push_back(read_transversal(node, context));
  }
  for (const JsonNode node : object.optional_array("stay_out", 0, kMostTags)) {
    file.stay_out.push_back(read_stay_out(node, context));
  }
  for (const JsonNode node : object.optional_array("ignore", 0, kMostTags)) {
    file.ignored.push_back(read_ignored(node, context));
  }
  finish_object(object, "collision", context);
  return file;
}

}  // namespace fascicle::muscle
