// System, 4 solve: collision of a musculature's muscles with bones and each other. Finds contacts, moves centres and
// radii (kernels/collision/solve_collision.hpp), falls back to the skinned rest shape where that diverged, and tells
// games what touches.
#pragma once

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "engine/loop/frame_time.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/collision_scratch.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/components/tendons.hpp"

namespace fascicle::muscle {

void solve_muscles(ecs::View<const Musculature, MuscleCollision, MuscleContacts, ActionLines, CrossSections> musculatures,
                   ecs::View<const BoneMatrices> characters, ecs::Resource<const FrameTime> time,
                   ecs::Resource<const CollisionScratch> scratch, ecs::Resource<const CostLedger> ledger);

}  // namespace fascicle::muscle
