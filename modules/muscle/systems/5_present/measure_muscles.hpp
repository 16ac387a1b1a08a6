// System: what gameplay and statistics want to know of the muscles as they are: lengths (1.1), volume, mass, PCSA and
// force (1.6), the insertion tendon's end (1.4).
#pragma once

#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_detail.hpp"
#include "modules/muscle/components/muscle_measures.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/components/tendons.hpp"

namespace fascicle::muscle {

struct MtuKernels;

// Volume, and what follows from it, is what the finest level would have: a muscle is not weaker for being further away.
void measure_muscles(
    ecs::View<const Musculature, const ActionLines, const CrossSections, const Tendons, MuscleMeasures> musculatures,
    ecs::View<const MuscleDetail> details, ecs::Resource<const MuscleSettings> settings,
    ecs::Resource<const CostLedger> ledger);

// The same for one muscle of one musculature; its volume is `volume_scale` times that of its surface.
void measure_muscle(const Musculature& musculature, const ActionLines& lines, const CrossSections& sections,
                    const Tendons& tendons, const MtuKernels& kernels, std::uint32_t muscle, MuscleMeasures& measures,
                    float volume_scale = 1.0f);

}  // namespace fascicle::muscle
