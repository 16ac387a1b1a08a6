// A world with one character of a few loose bones, and on them surface muscles that have a coarse hull.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "modules/muscle/add_hull.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/asset/hull/progressive_hull.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "tests/modules/muscle/systems/surface_world.hpp"

namespace fascicle::muscle {

inline constexpr SurfaceLevel kDynamicLevel{.solver = SurfaceSolver::kDynamic, .above_pixels = 200.0f};
inline constexpr SurfaceLevel kHullLevel{.solver = SurfaceSolver::kCoarseHull, .above_pixels = 0.0f, .refinements = 2};

// The ball of attached_ball, with a line from pole to pole.
inline SurfaceMuscleDescription ball_with_line(std::vector<SurfaceLevel> levels = {kHullLevel}) {
  SurfaceMuscleDescription description = attached_ball();
  description.action_line = {{.bone = 0, .position = {0.0f, 0.0f, -0.05f}},
                             {.bone = 1, .position = {0.0f, 0.0f, 0.05f}}};
  description.levels = std::move(levels);
  description.hull.vertices = 60;
  return description;
}

inline std::shared_ptr<const HullAsset> build_hull(const SurfaceAsset& surface,
                                                   const SurfaceMuscleDescription& description) {
  const auto hull = build_progressive_hull(description.mesh, {.vertices = description.hull.vertices});
  EXPECT_TRUE(hull.ok()) << to_text(hull.diagnostics());
  const auto asset = build_hull_asset(surface, description, hull->mesh);
  EXPECT_TRUE(asset.ok()) << to_text(asset.diagnostics());
  return *asset;
}

struct HullWorld : SurfaceWorld {
  using SurfaceWorld::SurfaceWorld;

  ecs::Entity add_with_hull(const SurfaceMuscleDescription& description) {
    const ecs::Entity muscle = add(description);
    add_hull(world, muscle, build_hull(asset(muscles.size() - 1), description));
    return muscle;
  }
  SurfaceHull& hull(std::size_t i = 0) { return world.get<SurfaceHull>(muscles[i]); }
  void force(SurfaceSolver solver, std::size_t i = 0) { hull(i).forced = solver; }

  std::vector<glm::vec3> points(std::size_t i = 0) {
    std::vector<glm::vec3> places;
    for (std::uint32_t v = 0; v < asset(i).vertex_count; ++v) places.push_back(point(v, i));
    return places;
  }
};

inline float furthest(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  float distance = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) distance = std::max(distance, glm::distance(a[i], b[i]));
  return distance;
}

}  // namespace fascicle::muscle
