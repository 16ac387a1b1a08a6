#include "modules/muscle/content/surface_hulls.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/parallel/for_range.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/asset/surface/check_surface.hpp"
#include "modules/muscle/content/surface_limits.hpp"

namespace fascicle::muscle {

namespace {

// What is wrong with a hull, or to be known of it. A stored one no longer tells how it came about, so all of it is said
// here at each load: in the same words, and in the file's unit.
Diagnostics judge(const SurfaceMuscleDescription& muscle, const ProgressiveHull& hull) {
  Diagnostics found;
  const HullSettings& asked = muscle.hull;
  const std::size_t vertices = hull.mesh.positions.size();
  if (vertices <= asked.vertices) return found;
  const bool bounded = asked.error > 0.0f;
  const std::string which =
      bounded ? fmt::format("a hull no further than {:.4g} mm away", 1000.0f * asked.error) : std::string("its hull");
  const auto most = static_cast<std::size_t>(kHullVerticesRange.max);
  if (vertices > most) {
    found.errors.push_back(fault_of(
        muscle, "hull", fmt::format("{} needs {} vertices, and the solver takes {} at most", which, vertices, most),
        bounded ? "give a larger \"error_mm\"" : "smooth the mesh, or give \"solver\": \"dynamic\""));
  } else {
    found.warnings.push_back(fault_of(
        muscle, "hull",
        fmt::format("{} needs {} vertices, more than the {} asked for", which, vertices, asked.vertices),
        bounded ? "ask for more \"vertices\", or give a larger \"error_mm\""
                : fmt::format("ask for {} \"vertices\" or more", vertices)));
  }
  return found;
}

// From the store, or made; empty, with an error, where there is none to work with.
std::optional<ProgressiveHull> find_hull(const SurfaceMuscleDescription& muscle, const HullStore& store,
                                         Diagnostics& diagnostics) {
  const HullTarget target = hull_target(muscle);
  std::optional<ProgressiveHull> hull;
  const auto stored = store.find(muscle.name);
  if (stored != store.end() && stored->second.inputs == hull_inputs(muscle.mesh, target)) {
    hull = stored->second.hull;
  } else {
    auto built = build_progressive_hull(muscle.mesh, target);
    if (!built) {
      for (Diagnostic& fault : built.diagnostics().errors) {  // it knows neither the muscle nor its file
        diagnostics.errors.push_back(fault_of(muscle, "hull", std::move(fault.cause), std::move(fault.remedy)));
      }
      return std::nullopt;
    }
    hull = std::move(*built);
  }
  Diagnostics found = judge(muscle, *hull);
  if (!found.ok()) hull.reset();
  diagnostics.append(std::move(found));
  return hull;
}

}  // namespace

bool uses_hull(const SurfaceMuscleDescription& muscle) {
  return std::ranges::any_of(muscle.levels,
                             [](const SurfaceLevel& level) { return level.solver == SurfaceSolver::kCoarseHull; });
}

HullTarget hull_target(const SurfaceMuscleDescription& muscle) {
  return {.vertices = muscle.hull.vertices, .error = muscle.hull.error};
}

void build_hulls(const HullStore& store, CharacterAsset& asset, Diagnostics& diagnostics) {
  const std::size_t count = asset.surface_descriptions.size();
  asset.hulls.assign(count, nullptr);
  std::vector<Diagnostics> found(count);
  parallel::for_range(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfaceMuscleDescription& muscle = asset.surface_descriptions[i];
      if (!asset.surface_muscles[i] || !uses_hull(muscle)) continue;
      const std::optional<ProgressiveHull> hull = find_hull(muscle, store, found[i]);
      if (!hull) continue;
      auto built = build_hull_asset(*asset.surface_muscles[i], muscle, hull->mesh, asset.muscles.get());
      if (built) asset.hulls[i] = *built;
      found[i].append(std::move(built.diagnostics()));
    }
  });
  for (Diagnostics& each : found) diagnostics.append(std::move(each));
}

}  // namespace fascicle::muscle
