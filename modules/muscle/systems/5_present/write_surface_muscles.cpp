#include "modules/muscle/systems/5_present/write_surface_muscles.hpp"

#include "engine/ecs/each_in_parallel.hpp"
#include "modules/muscle/kernels/surface/surface_normals.hpp"

namespace fascicle::muscle {

void write_surface_muscles(ecs::View<const SurfaceMuscle, const SurfaceState, DrawnSurface> muscles,
                           ecs::Resource<const CostLedger> ledger) {
  const SystemCosts costs = ledger->system("write_surface_muscles");
  const auto write = [&](ecs::Entity entity, const SurfaceMuscle& muscle, const SurfaceState& state,
                         DrawnSurface& drawn) {
    const SurfaceAsset& asset = *muscle.asset;
    if (drawn.vertices.size() != asset.vertex_count || state.points.size() < asset.vertex_count) return;
    const ScopedCost cost(costs.row(entity), ScopedCost::kWhole);
    write_surface_vertices(asset.triangles, state.points, state.frame, drawn.vertices);
  };
  ecs::each_in_parallel(muscles, 1, write);
}

}  // namespace fascicle::muscle
