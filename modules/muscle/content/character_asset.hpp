// A character as the game uses it: skeleton, clips, skins and bone meshes from a glTF file or an OpenSim model, and
// the muscles of its content file, mirrored, checked and built. Immutable, shared by all characters made from it.
//
// `load_character` reads NAME.character.json (content/schema/character.schema.json documents every field) and every
// file that it names. All errors of all those files come back in one go, each with file, line, column, JSON pointer,
// cause and remedy; `fascicle-check` runs nothing else.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/collision/collision_description.hpp"
#include "modules/muscle/asset/muscle_description.hpp"
#include "modules/muscle/asset/surface/surface_description.hpp"
#include "modules/muscle/content/fit_store.hpp"

namespace fascicle {
struct Clip;
struct JointModel;
struct Skeleton;
struct SkinAsset;
struct TriangleMesh;
}  // namespace fascicle

namespace fascicle::muscle {

class BoneField;
struct CollisionAsset;
struct FibreBundleAsset;
struct HullAsset;
struct MuscleAsset;
struct MuscleLevels;
struct SurfaceAsset;

// What becomes of muscles that have an anatomical mesh.
enum class FitMode {
  kStored,  // the fit stored beside the character file, where it is up to date; else fitted now
  kFresh,   // fitted now
  kNone,    // the unfitted shape
};

// What becomes of surface muscles that the coarse-hull solver may pose.
enum class HullMode {
  kStored,  // the hull stored beside the character file, where it is up to date; else made now
  kFresh,   // made now
  kNone,    // no hull: nothing is posed by one
};

struct LoadOptions {
  std::filesystem::path data_folder = {};  // what `data:` stands for; empty: find_data_folder()
  // Level of detail for all muscles, in place of what the file says.
  std::optional<std::uint32_t> section_vertices = std::nullopt;          // |C|, even, >= 6
  std::optional<std::uint32_t> longitudinal_subdivision = std::nullopt;  // LSS, 0..6
  FitMode fit = FitMode::kStored;
  HullMode hulls = HullMode::kStored;
  bool bone_fields = true;  // for the collision of muscles; false: none are made
};

// A rigid mesh that follows one bone: `transform` takes its vertices to the bone's frame (m).
struct BoneMesh {
  std::int32_t bone = -1;
  glm::mat4 transform{1.0f};
  std::shared_ptr<const TriangleMesh> mesh;
};

// The other side of the body, by the character's mirror rule.
struct MirrorMap {
  int axis = -1;  // of the reflection; -1: the character has no rule, and the lists are empty
  // By description and by bone: its image, itself where it lies on both sides, -1 where there is none.
  std::vector<std::int32_t> muscles, bones;
};

struct CharacterAsset {
  std::string name;
  std::shared_ptr<const Skeleton> skeleton;
  std::vector<std::shared_ptr<const Clip>> clips;      // of the glTF file; none for a joint skeleton
  std::shared_ptr<const JointModel> joints;            // null for a glTF skeleton
  std::vector<BoneMesh> bone_meshes;
  std::vector<std::shared_ptr<const SkinAsset>> skins;
  std::vector<MuscleDescription> descriptions;         // in file order; a mirrored muscle follows its original
  std::shared_ptr<const MuscleAsset> muscles;          // the finest level; null where the file has none
  std::shared_ptr<const MuscleLevels> levels;          // all levels of detail; null where the file has none
  std::vector<MuscleFits> fits;                        // by description; empty where none was asked for
  // Anatomical meshes by the muscle's name, in the character's rest space (m). Heads of one mesh share the object.
  std::map<std::string, std::shared_ptr<const TriangleMesh>> muscle_meshes;
  // Muscles that are deforming meshes, beside those above: in file order, a mirror image after its original.
  std::vector<SurfaceMuscleDescription> surface_descriptions;
  std::vector<std::shared_ptr<const SurfaceAsset>> surface_muscles;  // by surface description
  std::vector<std::shared_ptr<const FibreBundleAsset>> fibre_bundles;  // likewise: inner fibres; null: it has none
  std::vector<std::shared_ptr<const HullAsset>> hulls;  // likewise: coarse hulls; null: no level of it uses one
  // By description: 1 where a surface muscle that it drives is shown in its place, so that its own surface is not
  // drawn. It is posed, solved and measured all the same. Empty where there is no surface muscle.
  std::vector<std::uint8_t> hidden_muscles;
  MirrorMap mirror;
  CollisionDescription collision;                      // enabled and without tags where the file names none
  // By bone of the skeleton: how far a point is from it; null where a bone has no mesh.
  std::vector<std::shared_ptr<const BoneField>> bone_fields;
  std::vector<std::shared_ptr<const CollisionAsset>> collision_levels;  // by level of detail
  std::vector<std::filesystem::path> files;            // everything that was read, the character file first
};

Result<std::shared_ptr<const CharacterAsset>> load_character(const std::filesystem::path& file,
                                                             const LoadOptions& options = {});

}  // namespace fascicle::muscle
