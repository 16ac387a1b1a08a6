// System: surface muscles' points -> the vertices and normals that are drawn and read by games, in world space. After
// `solve_surface_muscles`; `write_surfaces` does the same for musculotendon units.
#pragma once

#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "modules/muscle/components/surface_muscle.hpp"

namespace fascicle::muscle {

// DrawnSurface::vertices has asset->vertex_count elements, as spawned; one of another size is passed over.
void write_surface_muscles(ecs::View<const SurfaceMuscle, const SurfaceState, DrawnSurface> muscles,
                           ecs::Resource<const CostLedger> ledger);

}  // namespace fascicle::muscle
