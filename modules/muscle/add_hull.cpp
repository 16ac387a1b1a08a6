#include "modules/muscle/add_hull.hpp"

#include <algorithm>
#include <utility>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/world.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/kernels/surface/surface_normals.hpp"
#include "modules/muscle/systems/4_solve/pose_surface_muscles.hpp"

namespace fascicle::muscle {
namespace {

bool belongs(const HullAsset& hull, const SurfaceMuscle& muscle) {
  const SurfaceAsset& asset = *muscle.asset;
  return hull.weights.rows == asset.vertex_count && hull.attachments.size() == asset.attachments.size() &&
         std::all_of(hull.line.begin(), hull.line.end(), [&](const HullLinePoint& point) {
           return point.bone >= 0 ? static_cast<std::size_t>(point.bone) < muscle.rest_bones.size()
                                  : point.carrier < asset.carriers.size();
         });
}

glm::vec3 middle(const SurfaceAsset& asset) {
  glm::vec3 lower(asset.rest[0].x, asset.rest[0].y, asset.rest[0].z), upper = lower;
  for (std::uint32_t v = 0; v < asset.vertex_count; ++v) {
    const glm::vec3 p(asset.rest[v].x, asset.rest[v].y, asset.rest[v].z);
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  return 0.5f * (lower + upper);
}

}  // namespace

void add_hull(ecs::World& world, ecs::Entity muscle, std::shared_ptr<const HullAsset> hull) {
  const SurfaceMuscle* surface = world.try_get<const SurfaceMuscle>(muscle);
  if (surface == nullptr || hull == nullptr || !belongs(*hull, *surface)) return;
  SurfaceHull component;
  component.settings = hull->settings;
  component.refinements = hull->settings.refinements;
  if (!hull->levels.empty()) component.solver = hull->levels.front().solver;
  component.difference.assign(surface->asset->vertex_count, SurfacePoint{});
  component.centre = middle(*surface->asset);
  component.line.assign(hull->line.size(), glm::vec3(0.0f));
  lay_out(*surface->asset, *hull, component.scratch);
  component.asset = std::move(hull);
  if (world.try_get<SurfaceHull>(muscle) != nullptr) world.remove<SurfaceHull>(muscle);
  world.add(muscle, std::move(component));
}

bool pose_now(ecs::World& world, ecs::Entity muscle) {
  SurfaceHull* hull = world.try_get<SurfaceHull>(muscle);
  if (hull == nullptr) return false;
  const SurfaceMuscle& surface = world.get<const SurfaceMuscle>(muscle);
  SurfaceState& state = world.get<SurfaceState>(muscle);
  const SimdLevel simd = world.resource<MuscleSettings>().simd;
  const PoseContext context{world.view<const Musculature, const ActionLines, const CrossSections>(),
                            surface_kernels(simd), hull_kernels(simd), 0.0f, false};
  if (!pose_muscle(context, surface, world.try_get<const BoneMatrices>(surface.character), state,
                   world.get<SurfaceContacts>(muscle), *hull)) {
    return false;
  }
  DrawnSurface* drawn = world.try_get<DrawnSurface>(muscle);
  if (drawn != nullptr && drawn->vertices.size() == surface.asset->vertex_count) {
    write_surface_vertices(surface.asset->triangles, state.points, state.frame, drawn->vertices);
  }
  return true;
}

}  // namespace fascicle::muscle
