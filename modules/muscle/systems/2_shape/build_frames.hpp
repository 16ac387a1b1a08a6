// System: action lines and bones -> cross-section frames, arc length and twist (1.2). A jump of the character (its
// BoneMatrices' teleport_count) ends the unwrapping of the twist. Held muscles keep their frames.
#pragma once

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/components/musculature.hpp"

namespace fascicle::muscle {

void build_frames(ecs::View<const Musculature, const ActionLines, CrossSections> musculatures,
                  ecs::View<const BoneMatrices> characters, ecs::Resource<const MuscleSettings> settings,
                  ecs::Resource<const CostLedger> ledger);

}  // namespace fascicle::muscle
