#include <fmt/format.h>

#include "modules/muscle/asset/hull/hull_asset.hpp"

namespace fascicle::muscle {

Result<std::shared_ptr<const HullAsset>> build_hull_asset(const SurfaceAsset& surface,
                                                          const SurfaceMuscleDescription& description,
                                                          const TriangleMesh& hull, const MuscleAsset*) {
  auto asset = std::make_shared<HullAsset>();
  asset->settings = description.hull;
  asset->levels = description.levels;
  asset->rest = hull.positions;
  asset->triangles = hull.indices;
  for (const ActionLinePoint& point : description.action_line) {
    asset->line.push_back({.rest = point.position, .bone = point.bone, .carrier = 0});
  }
  static_cast<void>(surface);
  return std::shared_ptr<const HullAsset>(std::move(asset));
}

}  // namespace fascicle::muscle
