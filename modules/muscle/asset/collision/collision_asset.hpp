// What the collision of one character's muscles needs to know and never changes while they move: where surfaces are
// sampled, which pairs may touch, how deep they are in each other at rest, where the tags are. One per level of detail,
// shared by all characters of an asset; `build_collision_asset` makes it.
//
// Sections are numbered muscle after muscle (`first_section`), rows of samples likewise (`first_row`). A row lies on a
// section (weight 0) or between two; its samples lie on the drawn triangles, on each of the |C| meridians and, where
// these are far apart, between them. Rows nearer to a muscle's end than to the section beside it have no samples: muscles grow out of bones there.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/collision/bone_field.hpp"
#include "modules/muscle/asset/collision/collision_description.hpp"

namespace fascicle::muscle {

struct MuscleAsset;

struct CollisionSection {
  std::uint32_t muscle = 0, section = 0;  // of the asset
  std::uint32_t slot = 0, first_radius = 0, count = 0;  // of its centre, of its radii, |C|
  std::uint32_t bone = 0;    // carries most of a_k: its displacement is kept in this bone's frame
  bool end = false;          // the muscle's first or last: attached, never moves
  bool via = false;          // at a via point
  float rest_area = 0.0f;    // m^2
  float belly = 1.0f;        // 0: tendon, of constant area; 1: belly, of constant volume
};

struct SampleRow {
  std::uint32_t section = 0;       // number of the section at or before it
  float weight = 0.0f;             // 0 at that section, towards 1 at the next
  std::uint32_t first_sample = 0, sample_count = 0;
};

// A place in a row: from meridian `vertex` towards the next.
struct SurfaceSample {
  std::uint16_t vertex = 0;
  std::uint16_t fraction = 0;  // of 65536
};
inline constexpr float kSampleFraction = 1.0f / 65536.0f;
inline constexpr std::uint32_t kMaxRowSamples = 512;

// How a sample hangs on the vertices (section, vertex), (section, vertex + 1), (section + 1, vertex),
// (section + 1, vertex + 1): weights of the drawn triangle that it lies in, whose diagonal joins the first and last.
struct SampleWeights {
  float of[4];
};
inline SampleWeights sample_weights(float along, float around) {
  if (around >= along) return {{1.0f - around, around - along, 0.0f, along}};
  return {{1.0f - along, 0.0f, along - around, around}};
}

// Overlaps at rest of a row's samples with another muscle: these depths are allowed.
struct RestOverlap {
  std::uint32_t other = 0;         // muscle
  std::uint32_t first_depth = 0;   // a depth a sample of the row, m, in CollisionAsset::rest_depths
};

// How two muscles meet.
enum PairKind : std::uint8_t {
  kNeverTouch = 0,
  kTouch = 1,
  kInterpenetrate = 2,  // they are deep in each other at rest: no side of either is where the other came from
};

// A tag at this level of detail.
struct Transversal {
  std::uint32_t section = 0, vertex = 0;
  std::int32_t bone = -1;                 // >= 0: then `point` in its frame is the other end
  std::uint32_t other_section = 0, other_vertex = 0;
  glm::vec3 point{0.0f};                  // m
  float rest_depth = 0.0f;                // m: measured at rest, allowed for
  bool first_yields = true, second_yields = true;
  bool sweeps = false;
  std::uint32_t tag = 0;                  // index in CollisionDescription::transversals
};

inline constexpr std::uint32_t kNoDepths = 0xffffffffu;
inline constexpr float kNeverTouches = 3.0e38f;

struct CollisionAsset {
  std::shared_ptr<const MuscleAsset> muscles;
  std::vector<std::uint32_t> first_section;        // by muscle, and one more: their number
  std::vector<CollisionSection> sections;
  std::vector<std::uint32_t> first_row;            // by muscle, and one more
  std::vector<SampleRow> rows;
  std::vector<SurfaceSample> samples;              // row after row
  std::vector<float> rest_line;                    // m, by muscle: length of the drawn line at rest
  std::vector<float> rest_belly;                   // m, by muscle: of its part that is no tendon

  std::uint32_t bone_count = 0;                    // matrices that the character must have
  std::vector<std::int32_t> bones;                 // those that have a field
  std::vector<std::shared_ptr<const BoneField>> fields;  // of `bones`
  std::vector<std::uint8_t> row_touches_bone;      // row * bones + place in `bones`: 1
  std::vector<std::uint32_t> row_bone_depths;      // likewise: the first of the row's depths in rest_depths, or kNoDepths
  std::vector<float> centre_bone_depths;           // section * bones + place: m, how deep a_k is at rest
  std::vector<std::uint8_t> muscles_touch;         // muscle * muscles + other: PairKind
  std::vector<std::uint32_t> first_overlap;        // by row, and one more
  std::vector<RestOverlap> overlaps;               // by row, others in order
  std::vector<float> rest_depths;                  // m, >= 0

  std::vector<Transversal> transversals;
};

// The asset's rest pose is where `rest_bones` (by bone) put it. `fields` by bone, null where a bone has none. Tags on
// end sections move to the section beside. None of the inputs can be wrong where the content's reader took them.
std::shared_ptr<const CollisionAsset> build_collision_asset(std::shared_ptr<const MuscleAsset> muscles,
                                                            const CollisionDescription& description,
                                                            std::span<const std::shared_ptr<const BoneField>> fields,
                                                            std::span<const glm::mat4> rest_bones);

// The rest place of vertex i of section k of muscle m (m).
glm::vec3 rest_vertex(const MuscleAsset& muscles, std::uint32_t m, std::uint32_t k, std::uint32_t i);

// The section and vertex at a tag's place.
struct TaggedVertex {
  std::uint32_t section = 0, vertex = 0;  // section by its number in its muscle
};
TaggedVertex find_tagged_vertex(const MuscleAsset& muscles, const SectionTag& tag);

std::size_t heap_bytes(const CollisionAsset& asset);

}  // namespace fascicle::muscle
