#include "modules/muscle/measure/points_inside.hpp"

#include <algorithm>

#include "engine/geometry/finite.hpp"
#include "engine/parallel/for_range.hpp"

namespace fascicle::muscle {
namespace {

constexpr std::size_t kPointsPerChunk = 256;

glm::vec3 place(const SurfacePoint& point) { return {point.x, point.y, point.z}; }

TriangleMesh mesh_of(const SurfaceAsset& asset) {
  TriangleMesh mesh;
  mesh.indices = asset.triangles;
  for (std::uint32_t v = 0; v < asset.vertex_count; ++v) mesh.positions.push_back(place(asset.rest[v]));
  return mesh;
}

}  // namespace

InsideMeter::InsideMeter(std::shared_ptr<const SurfaceAsset> asset)
    : asset_(std::move(asset)), tree_(mesh_of(*asset_)), places_(asset_->vertex_count) {}

PointsOutside InsideMeter::measure(std::span<const SurfacePoint> surface, std::span<const SurfacePoint> points) {
  for (std::size_t v = 0; v < places_.size(); ++v) places_[v] = place(surface[v]);
  tree_.move(places_);
  std::vector<PointsOutside> found(parallel::chunk_count(points.size(), kPointsPerChunk));
  parallel::for_range(points.size(), kPointsPerChunk, [&](std::size_t begin, std::size_t end) {
    PointsOutside& outside = found[begin / kPointsPerChunk];
    for (std::size_t i = begin; i < end; ++i) {
      const glm::vec3 point = place(points[i]);
      const bool finite = is_finite(point);
      if (finite && tree_.windings(point) > 0) continue;
      ++outside.count;
      if (finite) outside.furthest = std::max(outside.furthest, tree_.distance_beyond(point, outside.furthest));
    }
  });
  PointsOutside result;
  for (const PointsOutside& chunk : found) {
    result.count += chunk.count;
    result.furthest = std::max(result.furthest, chunk.furthest);
  }
  return result;
}

}  // namespace fascicle::muscle
