#include "modules/muscle/add_fibres.hpp"

#include <utility>

#include "engine/ecs/world.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "modules/muscle/components/surface_muscle.hpp"

namespace fascicle::muscle {

void add_fibres(ecs::World& world, ecs::Entity muscle, std::shared_ptr<const FibreBundleAsset> bundle) {
  const SurfaceMuscle* surface = world.try_get<const SurfaceMuscle>(muscle);
  if (surface == nullptr || bundle == nullptr || surface->asset->vertex_count != bundle->surface_vertices) return;
  FibreBundle fibres;
  fibres.points.reserve(bundle->rest_points.size());
  for (const glm::vec3& p : bundle->rest_points) fibres.points.push_back({p.x, p.y, p.z, 0.0f});
  fibres.length = bundle->rest_length;
  fibres.asset = std::move(bundle);
  world.add(muscle, std::move(fibres));
}

}  // namespace fascicle::muscle
