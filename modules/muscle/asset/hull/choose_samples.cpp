#include "modules/muscle/asset/hull/choose_samples.hpp"

#include <algorithm>
#include <limits>

#include <meshoptimizer.h>

#include "modules/muscle/kernels/hull/mesh_volume.hpp"

namespace fascicle::muscle {

HullSamples choose_samples(const SurfaceAsset& surface) {
  HullSamples samples;
  // It keeps vertices where they are, so the coarser mesh's are samples of the finer one.
  std::vector<std::uint32_t> kept = surface.triangles;
  if (surface.vertex_count > kMostSamples) {
    const std::size_t wanted = 3 * (2 * std::size_t{kMostSamples} - 4);  // a closed mesh without holes
    kept.resize(meshopt_simplify(kept.data(), surface.triangles.data(), surface.triangles.size(), &surface.rest[0].x,
                                 surface.vertex_count, sizeof(SurfacePoint), wanted,
                                 std::numeric_limits<float>::max(), 0, nullptr));
  }
  samples.vertices = kept;
  std::ranges::sort(samples.vertices);
  samples.vertices.erase(std::ranges::unique(samples.vertices).begin(), samples.vertices.end());
  for (const std::uint32_t vertex : kept) {
    const auto at = std::ranges::lower_bound(samples.vertices, vertex) - samples.vertices.begin();
    samples.triangles.push_back(static_cast<std::uint32_t>(at));
  }
  AlignedVector<SurfacePoint> places;
  for (const std::uint32_t vertex : samples.vertices) places.push_back(surface.rest[vertex]);
  samples.volume = measure_volume(samples.triangles, places, {});
  return samples;
}

}  // namespace fascicle::muscle
