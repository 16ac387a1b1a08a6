#include "modules/muscle/systems/5_present/measure_fibres.hpp"

#include <cstddef>

#include "engine/ecs/each_in_parallel.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "modules/muscle/kernels/surface/place_fibres.hpp"

namespace fascicle::muscle {

void measure_fibre_bundle(const SurfaceState& state, FibreBundle& bundle) {
  const FibreBundleAsset& asset = *bundle.asset;
  if (asset.count == 0 || state.points.size() < asset.surface_vertices) return;
  place_fibres({asset.bindings, asset.points_per_fibre, state.points, bundle.points, bundle.length});
  double sum = 0.0;
  for (std::size_t f = 0; f < asset.count; ++f)
    sum += static_cast<double>(bundle.length[f]) / static_cast<double>(asset.rest_length[f]);
  bundle.length_ratio_mean = static_cast<float>(sum / asset.count);
}

void measure_fibres(ecs::View<const SurfaceState, FibreBundle> muscles) {
  ecs::each_in_parallel(muscles, 1,
                        [](const SurfaceState& state, FibreBundle& bundle) { measure_fibre_bundle(state, bundle); });
}

}  // namespace fascicle::muscle
