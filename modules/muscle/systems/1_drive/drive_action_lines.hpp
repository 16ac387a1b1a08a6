// System: bones -> action lines (1.1). A muscle one of whose bones is missing or not finite is held: it keeps its last
// finite line (at first the rest shape) and is counted, so that no number that is not finite ever leaves.
#pragma once

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/components/musculature.hpp"

namespace fascicle::muscle {

void drive_action_lines(ecs::View<const Musculature, ActionLines> musculatures,
                        ecs::View<const BoneMatrices> characters, ecs::Resource<const MuscleSettings> settings,
                        ecs::Resource<const CostLedger> ledger);

}  // namespace fascicle::muscle
