// System: sections, radii and tendons -> the surfaces that are drawn and read by games (1.3 to 1.5), and how far each
// row lies from a tendon's border. The last muscle system of a frame.
#pragma once

#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/components/tendons.hpp"

namespace fascicle::muscle {

void write_surfaces(
    ecs::View<const Musculature, const ActionLines, const CrossSections, const Tendons, MuscleSurfaces> musculatures,
    ecs::Resource<const MuscleSettings> settings, ecs::Resource<const CostLedger> ledger);

// The rows' tendon coordinates of one musculature.
void write_rows(const MuscleAsset& asset, const CrossSections& sections, const Tendons& tendons,
                MuscleSurfaces& surfaces);

}  // namespace fascicle::muscle
