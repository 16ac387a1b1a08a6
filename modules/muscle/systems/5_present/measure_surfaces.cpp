#include "modules/muscle/systems/5_present/measure_surfaces.hpp"

#include "engine/ecs/each_in_parallel.hpp"
#include "modules/muscle/kernels/surface/measure_quality.hpp"

namespace fascicle::muscle {

void measure_surfaces(ecs::View<const SurfaceMuscle, const SurfaceState, SurfaceQuality> muscles) {
  ecs::each_in_parallel(muscles, 1,
                        [](const SurfaceMuscle& muscle, const SurfaceState& state, SurfaceQuality& quality) {
                          if (state.points.size() < muscle.asset->vertex_count) return;  // not spawned yet
                          measure_quality(*muscle.asset, state.points, state.bones, quality);
                        });
}

}  // namespace fascicle::muscle
