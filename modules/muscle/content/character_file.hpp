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
#include "modules/muscle/asset/surface/surface_description.hpp"
#include "modules/muscle/content/field_log.hpp"

namespace fascicle::muscle {

// A text that names something, and where it stands. Without a node it was not given, or not as a string.
struct NameEntry {
  std::string text;
  JsonNode node;
  bool given() const { return node.exists(); }
};

// The part of a muscle's mesh where it is attached: what lies within a distance of a bone's meshes, or of the point.
struct AreaEntry {
  JsonNode node;
  NameEntry bone;        // whose meshes; not given: the attachment's own
  bool of_bone = false;  // else: of the attachment's point
  float within = 0.0f;   // m
  bool given() const { return node.exists(); }
};

struct AttachmentEntry {
  JsonNode node;
  NameEntry bone;
  std::optional<glm::vec3> position;  // m, in the bone's frame or the character's rest space; empty: wrong or missing
  JsonNode position_node;
  bool counts = true;
  AreaEntry area;
};

// A muscle's anatomical mesh: one of those in the file of "muscle_meshes", by name, or a file of its own.
struct MeshEntry {
  JsonNode node;      // as written; without a node: none
  NameEntry name;
  NameEntry file;
  float unit = 1.0f;  // m; of the file's numbers
  Trs transform;      // scaled to metres, to the rest space
  bool given() const { return node.exists(); }
};

// Level of detail: counts, or the largest distance that they may leave between the fitted surface and the mesh.
struct LevelEntry {
  std::optional<std::uint32_t> section_vertices;          // |C|
  std::optional<std::uint32_t> longitudinal_subdivision;  // LSS
  std::optional<float> max_distance;                      // m; then neither of the others
};

struct MuscleEntry {
  JsonNode node;
  NameEntry name;
  bool mirror = false;
  std::vector<AttachmentEntry> attachments;  // origin, via points, insertion
  MuscleDescription values;                  // everything but name and attachments; `where` is set
  MeshEntry mesh;
  bool fit = true;                           // false: keeps its unfitted shape, whatever its mesh
  LevelEntry level;
  bool sound = false;                        // read without an error
};

// Which vertices of a surface muscle's mesh follow a bone.
struct SurfaceAttachmentEntry {
  enum class Choice : std::uint8_t {
    kNone,      // wrong or missing
    kWithin,    // no further than `distance` from the bone's meshes
    kNear,      // no further than `distance` from `point`
    kBeyond,    // normal . p > offset
    kVertices,  // these
  };
  JsonNode node;
  NameEntry bone;
  bool origin = true;                   // else: insertion
  Choice choice = Choice::kNone;
  float distance = 0.0f;                // m
  glm::vec3 point{0.0f};                // m, in the file's attachment space
  glm::dvec3 normal{0.0, 0.0, 1.0};     // unit
  double offset = 0.0;                  // along the normal, in the unit of the plane's space
  bool plane_in_rest_space = false;     // m; else in the mesh file's own coordinates and unit
  std::vector<std::uint32_t> vertices;  // of the mesh file
};

// Fibres of a surface muscle: polylines of a file, or one written out.
struct FibresEntry {
  JsonNode node;
  NameEntry file;
  std::vector<glm::vec3> points;
  std::uint32_t head = 0;
  float unit = 1.0f;      // m; of the numbers
  bool own_unit = false;  // else the mesh's
  Trs transform;          // scaled to metres, to the rest space
};

// A point of a surface muscle's line.
struct LinePointEntry {
  JsonNode node;
  NameEntry bone;
  std::optional<glm::vec3> position;  // empty: wrong or missing
  bool in_rest_space = false;         // m; else in the mesh file's own coordinates and unit
};

// A muscle that is a deforming mesh.
struct SurfaceMuscleEntry {
  JsonNode node;
  NameEntry name;
  bool mirror = false;
  MeshEntry mesh;
  std::uint32_t piece = 0;           // of the mesh's, from 1 by falling size; 0: it is the only one
  JsonNode piece_node;
  NameEntry frame;                   // bone; not given: the first origin's
  std::vector<SurfaceAttachmentEntry> attachments;
  std::vector<FibresEntry> fibres;
  std::optional<FibreBundleSettings> inner_fibres;
  JsonNode inner_fibres_node;
  std::vector<NameEntry> bones;      // that it collides with
  bool all_bones = true;             // all with a mesh; `bones` is empty
  NameEntry driver;
  bool hide_driver = true;
  bool free = false;                 // it is attached to nothing on purpose
  SurfaceSettings settings;
  std::vector<SurfaceLevel> levels{{}};  // finest first; never empty
  JsonNode coarse_hull;              // what asks for that solver; without a node: nothing does
  HullSettings hull;
  std::vector<LinePointEntry> action_line;  // from origin to insertion; empty: not given
  JsonNode action_line_node;
  bool sound = false;                // read without an error
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
  float muscle_mesh_unit = 1.0f;          // m
  MirrorRule mirror;
  bool positions_in_character_space = false;
  LevelEntry level;
  std::uint32_t coarser_levels = 2;       // at most, for characters that are small on the screen
  bool fit = true;
  std::uint32_t fit_supersampling = 3;    // CSS
  float specific_tension = 0.0f;          // N/m^2; 0: the module's default
  NameEntry collision;                    // the collision file
  NameEntry muscles_from;                 // another character file
  std::vector<MuscleEntry> muscles;
  std::vector<SurfaceMuscleEntry> surface_muscles;
};

// Reads what it can and appends all errors. The document must outlive the answer.
CharacterFile read_character_file(const JsonNode& root, const ReadContext& context);

// Parts of it, one object each.
MuscleEntry read_muscle_entry(const JsonNode& node, const ReadContext& context);
SurfaceMuscleEntry read_surface_muscle_entry(const JsonNode& node, const ReadContext& context);
// "solver" or "levels", "hull" and "action_line" of a surface muscle; its driver and attachments are read.
void read_surface_solver(JsonObject& object, SurfaceMuscleEntry& entry, const ReadContext& context);
MeshEntry read_mesh_entry(const JsonNode& node, const ReadContext& context);
NameEntry read_name(JsonObject& object, std::string_view field, bool required);
// "level" of a character, or the same fields of a muscle.
void read_level(JsonObject& object, LevelEntry& level);
// "translation", "rotation" and "scale" of a mesh.
void read_placement(JsonObject& object, Trs& transform);
// "unit": metres a unit; unchanged where it is not given.
void read_unit(JsonObject& object, float& unit);

}  // namespace fascicle::muscle
