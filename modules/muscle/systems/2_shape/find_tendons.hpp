// System: arc length -> where the tendons end (1.4). A tendon's length is fixed; its border moves along the line as the
// line's length changes.
#pragma once

#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/components/tendons.hpp"

namespace fascicle::muscle {

void find_tendons(ecs::View<const Musculature, const CrossSections, Tendons> musculatures,
                  ecs::Resource<const MuscleSettings> settings, ecs::Resource<const CostLedger> ledger);

}  // namespace fascicle::muscle
