#include "modules/muscle/systems/1_drive/select_surface_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace fascicle::muscle {
namespace {

// pixels: the diagonal of its box at rest, where its frame bone has it now.
std::optional<float> size_in_picture(const SurfaceMuscle& muscle, const SurfaceHull& hull, const BoneMatrices* bones,
                                     const Viewer& viewer) {
  const auto bone = static_cast<std::size_t>(muscle.asset->frame_bone);
  if (bones == nullptr || bone >= bones->world.size() || bone >= muscle.rest_bones.size()) return std::nullopt;
  const glm::vec3 centre(bones->world[bone] * (glm::inverse(muscle.rest_bones[bone]) * glm::vec4(hull.centre, 1.0f)));
  if (!std::isfinite(centre.x + centre.y + centre.z)) return std::nullopt;
  return viewer.pixels_per_radian * muscle.asset->size / glm::distance(viewer.eye, centre);
}

std::uint32_t level_of(const SurfaceMuscle& muscle, const SurfaceHull& hull, const BoneMatrices* bones,
                       const Viewer& viewer) {
  const auto& levels = hull.asset->levels;
  if (!viewer.enabled || levels.empty()) return 0;
  if (viewer.level) return std::min(*viewer.level, static_cast<std::uint32_t>(levels.size()) - 1);
  const std::optional<float> pixels = size_in_picture(muscle, hull, bones, viewer);
  return pixels ? choose_surface_level(levels, *pixels, hull.level) : hull.level;
}

void select(const SurfaceMuscle& muscle, const BoneMatrices* bones, const Viewer& viewer, SurfaceHull& hull) {
  hull.level = level_of(muscle, hull, bones, viewer);
  SurfaceSolver solver = SurfaceSolver::kDynamic;
  std::uint32_t refinements = hull.settings.refinements;
  if (hull.level < hull.asset->levels.size()) {
    const SurfaceLevel& level = hull.asset->levels[hull.level];
    solver = level.solver;
    if (solver == SurfaceSolver::kCoarseHull) refinements = level.refinements;
  }
  solver = hull.forced.value_or(solver);
  if (solver != hull.solver) {
    ++hull.switches;
    hull.changed = true;
  } else if (refinements != hull.refinements) {
    hull.changed = true;
  }
  if (solver == SurfaceSolver::kDynamic) hull.blend_left = 0.0f;
  hull.solver = solver;
  hull.refinements = refinements;
}

}  // namespace

std::uint32_t choose_surface_level(std::span<const SurfaceLevel> levels, float pixels, std::uint32_t current) {
  const auto first_where = [&](float size) {
    for (std::uint32_t level = 0; level + 1 < levels.size(); ++level) {
      if (size >= levels[level].above_pixels) return level;
    }
    return levels.empty() ? 0u : static_cast<std::uint32_t>(levels.size()) - 1;
  };
  if (std::isnan(pixels)) return 0;
  const std::uint32_t wanted = first_where(pixels);
  if (wanted <= current) return wanted;
  return std::max(current, first_where(pixels / (1.0f - kSolverHysteresis)));
}

void select_surface_solvers(ecs::View<const SurfaceMuscle, SurfaceHull> muscles,
                            ecs::View<const BoneMatrices> characters, ecs::Resource<const Viewer> viewer) {
  muscles.each([&](const SurfaceMuscle& muscle, SurfaceHull& hull) {
    select(muscle, characters.try_get<const BoneMatrices>(muscle.character), *viewer, hull);
  });
}

}  // namespace fascicle::muscle
