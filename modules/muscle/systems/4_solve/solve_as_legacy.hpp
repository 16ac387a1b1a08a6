// System, 4 solve: the thesis's response (legacy_response.hpp) for the musculatures that are set to it, in place of
// solve_muscles. Contacts are not reported.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/ecs/world.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/systems/4_solve/legacy_response.hpp"

namespace fascicle::muscle {

// On a musculature's entity, beside MuscleCollision.
struct LegacyCollision {
  std::vector<LegacyPlan> plans;  // by level of detail, as MuscleCollision::levels
  std::uint64_t steps = 0;        // in this mode
  LegacyOutcome last;             // of the last run
};

// A bone's own triangles.
struct LegacyBoneMesh {
  std::int32_t bone = -1;
  glm::mat4 to_bone{1.0f};
  const TriangleMesh* mesh = nullptr;
};

// By bone; null where a bone has no mesh. Several of one bone go into one tree.
std::vector<std::shared_ptr<const TriangleTree>> make_legacy_bones(std::span<const LegacyBoneMesh> meshes,
                                                                   std::size_t bone_count);

// Lets a musculature that has MuscleCollision respond in the thesis's way while its settings' mode is kLegacy. Without
// this, that mode keeps what deformation there is. `only_marked`: see make_legacy_plan.
void add_legacy_collision(ecs::World& world, ecs::Entity musculature,
                          std::vector<std::shared_ptr<const TriangleTree>> bones, bool only_marked = false);

// Runs in every kLegacyInterval-th step. Counts what it had to clamp as MuscleCollision::fallbacks, for that is where
// the thesis's method has come apart.
void solve_as_legacy(ecs::View<const Musculature, LegacyCollision, MuscleCollision, ActionLines, CrossSections>
                         musculatures,
                     ecs::View<const BoneMatrices> characters, ecs::Resource<const CostLedger> ledger);

std::size_t heap_bytes(const LegacyCollision& collision);

}  // namespace fascicle::muscle
