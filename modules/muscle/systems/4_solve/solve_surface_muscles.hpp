// System, 4 solve: surface muscles follow their bones, or the musculotendon units that carry them, and are refined by
// position based dynamics (kernels/surface/step_surface.hpp). One that diverges goes back to where its carriers bring
// its rest shape, and is counted. Muscles of one character that may touch each other go together, substep by substep.
#pragma once

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "engine/loop/frame_time.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/components/surface_neighbours.hpp"

namespace fascicle::muscle {

void solve_surface_muscles(ecs::View<const SurfaceMuscle, SurfaceState, SurfaceContacts> muscles,
                           ecs::View<const BoneMatrices, SurfaceNeighbours> characters,
                           ecs::View<const Musculature, const ActionLines, const CrossSections> musculatures,
                           ecs::Resource<const FrameTime> time, ecs::Resource<const MuscleSettings> settings,
                           ecs::Resource<const CostLedger> ledger);

}  // namespace fascicle::muscle
