// A character file as it is written: every field checked by itself (kind, range, spelling), nothing looked up yet.
// Each part keeps the JSON node that it came from, so that later checks, which need the skeleton or other files, can
// quote the place. Version 1 of the format; older files pass through migrate.hpp first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/content/json_reader.hpp"
#include "modules/muscle/asset/muscle_description.hpp"
#include "modules/muscle/content/field_log.hpp"

namespace fascicle::muscle {

// A text that names something, and where it stands. Without a node it was not given, or not as a string.
struct NameEntry {
  std::string text;
  JsonNode node;
  bool given() const { return node.exists(); }
};

struct AttachmentEntry {
  JsonNode node;
  NameEntry bone;
  std::optional<glm::vec3> position;  // m, in the bone's frame or the character's rest space; empty: wrong or missing
  JsonNode position_node;
  bool counts = true;
};

struct MuscleEntry {
  JsonNode node;
  NameEntry name;
  bool mirror = false;
  std::vector<AttachmentEntry> attachments;  // origin, via points, insertion
  MuscleDescription values;                  // everything but name and attachments; `where` is set
  NameEntry mesh;
  std::optional<std::uint32_t> section_vertices;
  std::optional<std::uint32_t> longitudinal_subdivision;
  bool sound = false;                        // read without an error
};

// How names and places pass to the other side: reflection in the plane `axis` = 0 of the character's rest space, and
// pairs of name parts to exchange.
struct MirrorRule {
  JsonNode node;
  int axis = 0;
  using Pair = std::pair<std::string, std::string>;
  std::vector<Pair> bones;
  std::vector<Pair> names;
  bool given() const { return node.exists(); }
};

struct BoneMeshEntry {
  JsonNode node;
  NameEntry bone;
  NameEntry file;
  Trs transform;                    // mesh to bone, or to the rest space
  bool in_character_space = false;
};

struct CharacterFile {
  std::filesystem::path file;
  JsonNode root;
  std::string name;
  NameEntry gltf;                         // of the skeleton: one of these two is given
  JsonNode joints;
  NameEntry skin;
  std::vector<NameEntry> skin_meshes;     // empty: all that are skinned
  std::vector<BoneMeshEntry> bone_meshes;
  NameEntry muscle_meshes;
  MirrorRule mirror;
  bool positions_in_character_space = false;
  std::optional<std::uint32_t> section_vertices;
  std::optional<std::uint32_t> longitudinal_subdivision;
  float specific_tension = 0.0f;          // N/m^2; 0: the module's default
  NameEntry muscles_from;                 // another character file
  std::vector<MuscleEntry> muscles;
};

// Reads what it can and appends all errors. The document must outlive the answer.
CharacterFile read_character_file(const JsonNode& root, const ReadContext& context);

// Parts of it, one object each.
MuscleEntry read_muscle_entry(const JsonNode& node, const ReadContext& context);
NameEntry read_name(JsonObject& object, std::string_view field, bool required);
// "level" of a character, or the same two fields of a muscle: |C| even and from 6 to 256, LSS from 0 to 6.
void read_level(JsonObject& object, std::optional<std::uint32_t>& section_vertices,
                std::optional<std::uint32_t>& longitudinal_subdivision);

}  // namespace fascicle::muscle
