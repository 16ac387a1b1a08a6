// The thesis's own response to collisions (chapter 4), for comparison with ours: CollisionMode::kLegacy. It looks at
// tagged sections alone, and what it does stays: nothing comes back once its cause is gone, and one muscle's remedy is
// the next one's cause. The thesis ran ten muscles with 25 constraints and calls it unstable beyond.
//
// One run, each part in the tags' or sections' order and each seeing what was done before it:
//
// 1. Transversals (4.1.1). A section whose tag's depth rho_x + rho_y is larger than its radius has its centre moved
//    (4.4), where the tag says that it yields.
// 2. Ray sweeps (4.1.2) from each tagged section against its partners: the neighbouring segments' triangles of another
//    muscle, all triangles of a bone.
// 3. Vertices with a hit on an edge beside them are fixed and lose 10 % of their radius, until a later run finds them
//    free. Where it would fall below kLegacySmallestRadius the centre moves by a tenth of the opposite radius instead,
//    and also where a diagonal was hit.
// 4. The free radii inflate to the section's area at rest, by the thesis's iteration (4.5 to 4.10).
//
// The thesis leaves open what bounds all this. Here displacements and radii end at kLegacyReach, so that what is drawn
// stays finite; how often they did is counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/geometry/triangle_tree.hpp"
#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_collision.hpp"

namespace fascicle::muscle {

inline constexpr std::uint32_t kLegacyInterval = 3;          // frames: it runs in every third
inline constexpr float kLegacyShrink = 0.9f;                 // of a fixed radius, a run
inline constexpr float kLegacyPush = 0.1f;                   // of the opposite radius
inline constexpr float kLegacySmallestRadius = 1.0e-3f;      // m, eps_r
inline constexpr float kLegacyAreaTolerance = 1.0e-3f;       // of the area: the thesis's 1e-6 m^2 in a thigh
inline constexpr std::uint32_t kLegacyMostIterations = 100;  // of an inflation
inline constexpr float kLegacyReach = 1.0f;                  // m

// A section whose surface edges are rays, and what they are cast at.
struct LegacySweep {
  std::uint32_t section = 0;        // CollisionAsset's number, likewise:
  std::int32_t bone = -1;           // >= 0: this bone, else
  std::uint32_t other_section = 0;  // the surface beside this section
};

// What the response needs beside a CollisionAsset, made once from it.
struct LegacyPlan {
  std::vector<LegacySweep> sweeps;                          // by section, then bones, then other sections
  std::vector<std::shared_ptr<const TriangleTree>> bones;  // by bone, in its frame; null: no mesh
};

// In the thesis every tagged section sweeps; `only_marked`: those alone whose tags ask for it.
LegacyPlan make_legacy_plan(const CollisionAsset& asset, std::vector<std::shared_ptr<const TriangleTree>> bones,
                            bool only_marked = false);

struct LegacyOutcome {
  std::uint32_t moved = 0;       // centres, once for each move
  std::uint32_t shrunk = 0;      // radii
  std::uint32_t inflated = 0;    // sections
  std::uint32_t iterations = 0;  // of inflations, together
  std::uint32_t clamped = 0;     // displacements and radii held at kLegacyReach, or refused because not finite
};

// One run for one musculature. `bones`: to world, by bone, as many as the asset has. `lines` have the kept displacement
// in them already, and `sections` the frames of those lines (their radii are not read). Moves the lines' points, adds
// the same to `collision.offset_*`, and changes `collision.radii`. Held muscles stay as they are. Allocates nothing.
LegacyOutcome respond_as_legacy(const CollisionAsset& asset, const LegacyPlan& plan, std::span<const glm::mat4> bones,
                                const CrossSections& sections, ActionLines& lines, MuscleCollision& collision);

std::size_t heap_bytes(const LegacyPlan& plan);  // without the bones, which others share

}  // namespace fascicle::muscle
