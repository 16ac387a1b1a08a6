// System, 4 solve: surface muscles follow their bones, or the musculotendon units that carry them, and are refined by
// position based dynamics (kernels/surface/step_surface.hpp). One that diverges goes back to where its carriers bring
// its rest shape, and is counted. Muscles of one character that may touch each other go together, substep by substep.
// Those that their coarse hull poses (pose_surface_muscles.hpp) are left alone, and touch no others.
#pragma once

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "engine/loop/frame_time.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/components/surface_neighbours.hpp"
#include "modules/muscle/systems/4_solve/follow_bones.hpp"

namespace fascicle::muscle {

void solve_surface_muscles(ecs::View<const SurfaceMuscle, SurfaceState, SurfaceContacts> muscles,
                           ecs::View<const BoneMatrices, SurfaceNeighbours> characters,
                           Drivers drivers, ecs::View<const SurfaceHull> hulls,
                           ecs::Resource<const FrameTime> time, ecs::Resource<const MuscleSettings> settings,
                           ecs::Resource<const CostLedger> ledger);

}  // namespace fascicle::muscle
