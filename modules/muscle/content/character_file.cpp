#include "modules/muscle/content/character_file.hpp"

#include <fmt/format.h>

#include "engine/content/length_unit.hpp"
#include "modules/muscle/asset/muscle_limits.hpp"
#include "modules/muscle/content/surface_limits.hpp"

namespace fascicle::muscle {

namespace {

void read_skeleton(const JsonNode& node, CharacterFile& file, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  file.gltf = read_name(object, "gltf", false);
  file.joints = object.optional("joints");
  if (object.valid() && object.optional("gltf").exists() == file.joints.exists()) {
    node.error(context.diagnostics,
               file.joints.exists() ? "the skeleton has both 'gltf' and 'joints'"
                                    : "the skeleton has neither 'gltf' nor 'joints'",
               "give one: a glTF file whose nodes are the bones, or joints as an OpenSim import writes them");
  }
  finish_object(object, "skeleton", context);
}

void read_skin(const JsonNode& node, CharacterFile& file, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  file.skin = read_name(object, "gltf", true);
  for (const JsonNode mesh : object.optional_array("meshes", 1, 1000)) {
    NameEntry entry;
    if (mesh.read(entry.text, context.diagnostics)) {
      entry.node = mesh;
      file.skin_meshes.push_back(std::move(entry));
    }
  }
  finish_object(object, "skin", context);
}

BoneMeshEntry read_bone_mesh(const JsonNode& node, const ReadContext& context) {
  BoneMeshEntry entry;
  entry.node = node;
  JsonObject object(node, context.diagnostics);
  entry.bone = read_name(object, "bone", true);
  entry.file = read_name(object, "file", true);
  read_placement(object, entry.transform);
  float unit = 1.0f;  // m
  read_unit(object, unit);
  entry.transform.scale *= unit;
  std::size_t space = 0;
  if (object.optional_choice("space", space, {"bone", "character"})) entry.in_character_space = space == 1;
  finish_object(object, "bone_mesh", context);
  return entry;
}

void read_muscle_meshes(const JsonNode& node, CharacterFile& file, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  file.muscle_meshes = read_name(object, "file", true);
  std::size_t space = 0;
  object.optional_choice("bones_space", space, {"character"});
  read_unit(object, file.muscle_mesh_unit);
  finish_object(object, "muscle_meshes", context);
}

// [["_r", "_l"], ...]: pairs of different, non-empty name parts.
std::vector<MirrorRule::Pair> read_pairs(const JsonNode& list, const ReadContext& context) {
  std::vector<MirrorRule::Pair> pairs;
  for (const JsonNode node : list) {
    std::vector<std::string> parts;
    if (!node.require_array(context.diagnostics, 2, 2) || !node.read(parts, context.diagnostics)) continue;
    if (parts[0].empty() || parts[1].empty() || parts[0] == parts[1]) {
      node.error(context.diagnostics, fmt::format("['{}', '{}'] exchanges nothing", parts[0], parts[1]),
                 "give two different parts of names, as in [\"_r\", \"_l\"]");
      continue;
    }
    pairs.emplace_back(std::move(parts[0]), std::move(parts[1]));
  }
  return pairs;
}

void read_mirror(const JsonNode& node, MirrorRule& rule, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  if (!object.valid()) return;
  rule.node = node;
  std::size_t axis = 0;
  if (object.optional_choice("axis", axis, {"x", "y", "z"})) rule.axis = static_cast<int>(axis);
  rule.bones = read_pairs(object.require_array("bones", 1, 1000), context);
  rule.names = read_pairs(object.require_array("names", 1, 1000), context);
  finish_object(object, "mirror", context);
}

}  // namespace

void read_placement(JsonObject& object, Trs& transform) {
  Diagnostics& diagnostics = object.diagnostics();
  object.optional("translation", transform.translation, between(-100, 100));
  object.optional("rotation", transform.rotation);
  const JsonNode scale = object.optional("scale");
  glm::vec3 value(1.0f);
  if (!scale.exists() || !scale.read(value, diagnostics, between(-1000, 1000))) return;
  if (value.x == 0.0f || value.y == 0.0f || value.z == 0.0f) {
    scale.error(diagnostics, "a scale of 0 flattens the mesh", "give three factors other than 0");
  } else {
    transform.scale = value;
  }
}

void read_unit(JsonObject& object, float& unit) {
  constexpr auto name = [](std::size_t i) { return kLengthUnits[i].name; };
  std::size_t choice = 0;
  if (object.optional_choice("unit", choice, {name(0), name(1), name(2), name(3), name(4)})) {
    unit = kLengthUnits[choice].metres;
  }
}

CharacterFile read_character_file(const JsonNode& root, const ReadContext& context) {
  CharacterFile file;
  file.root = root;
  file.file = root.file();
  JsonObject object(root, context.diagnostics);
  std::string schema;
  object.optional("$schema", schema);
  object.require("version");  // its value is migrate's business
  std::string credit;  // kept in the file for those who read it
  object.optional("source", credit);
  object.optional("licence", credit);
  file.name = read_name(object, "name", true).text;
  if (const JsonNode node = object.require("skeleton"); node.exists()) read_skeleton(node, file, context);
  if (const JsonNode node = object.optional("skin"); node.exists()) read_skin(node, file, context);
  for (const JsonNode node : object.optional_array("bone_meshes", 0, 10000)) {
    file.bone_meshes.push_back(read_bone_mesh(node, context));
  }
  if (const JsonNode node = object.optional("muscle_meshes"); node.exists()) read_muscle_meshes(node, file, context);
  if (const JsonNode node = object.optional("mirror"); node.exists()) read_mirror(node, file.mirror, context);
  std::size_t space = 0;
  if (object.optional_choice("attachment_space", space, {"bone", "character"})) {
    file.positions_in_character_space = space == 1;
  }
  if (const JsonNode node = object.optional("level"); node.exists()) {
    JsonObject level(node, context.diagnostics);
    read_level(level, file.level);
    level.optional("coarser_levels", file.coarser_levels, kCoarserLevelsRange);
    finish_object(level, "level", context);
  }
  if (const JsonNode node = object.optional("fit"); node.exists()) {
    JsonObject fit(node, context.diagnostics);
    fit.optional("enabled", file.fit);
    fit.optional("supersampling", file.fit_supersampling, kSupersamplingRange);
    finish_object(fit, "fit", context);
  }
  object.optional("specific_tension", file.specific_tension, kSpecificTensionRange);
  file.collision = read_name(object, "collision", false);
  file.muscles_from = read_name(object, "muscles_from", false);
  for (const JsonNode node : object.optional_array("muscles", 0, 100000)) {
    file.muscles.push_back(read_muscle_entry(node, context));
  }
  for (const JsonNode node : object.optional_array("surface_muscles", 0, kMostSurfaceMuscles)) {
    file.surface_muscles.push_back(read_surface_muscle_entry(node, context));
  }
  finish_object(object, "character", context);
  return file;
}

}  // namespace fascicle::muscle
