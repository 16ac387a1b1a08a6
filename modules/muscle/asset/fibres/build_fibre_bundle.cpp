#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "modules/muscle/asset/fibres/bind_fibres.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "modules/muscle/asset/fibres/fibre_curves.hpp"
#include "modules/muscle/asset/fibres/fibre_faults.hpp"
#include "modules/muscle/asset/fibres/isocontour_fibres.hpp"
#include "modules/muscle/asset/fibres/pull_inside.hpp"
#include "modules/muscle/asset/fibres/surface_fibres.hpp"
#include "modules/muscle/asset/fibres/surface_mesh.hpp"

namespace fascicle::muscle {
namespace {

constexpr std::uint32_t kMostFibres = 100'000, kMostPoints = 1'000;
constexpr std::uint64_t kMostInAll = 10'000'000;
constexpr float kMostPennation = 1.5f;     // rad
constexpr double kMargin = 0.2;            // of the mean edge: how deep fibres lie under the surface at least

Diagnostics check_settings(const SurfaceAsset& surface, const FibreBundleSettings& settings) {
  Diagnostics faults;
  const auto add = [&](std::string cause, std::string remedy) {
    faults.errors.push_back(fibre_fault(surface, std::move(cause), std::move(remedy)));
  };
  if (settings.count < 1 || settings.count > kMostFibres)
    add(fmt::format("{} fibres", settings.count), fmt::format("ask for 1 to {}", kMostFibres));
  if (settings.points < 2 || settings.points > kMostPoints)
    add(fmt::format("{} points a fibre", settings.points), fmt::format("ask for 2 to {}", kMostPoints));
  if (faults.ok() && std::uint64_t{settings.count} * settings.points > kMostInAll)
    add(fmt::format("{} points in all", std::uint64_t{settings.count} * settings.points),
        fmt::format("ask for {} at most", kMostInAll));
  if (!(settings.pennation >= 0.0f && settings.pennation <= kMostPennation))
    add(fmt::format("a pennation of {:.4g} rad", static_cast<double>(settings.pennation)),
        fmt::format("give 0 to {:.4g} rad", static_cast<double>(kMostPennation)));
  if (surface.vertex_count == 0) add("the muscle has no surface", "build it first");
  return faults;
}

}  // namespace

Result<std::shared_ptr<const FibreBundleAsset>> build_fibre_bundle(const SurfaceAsset& surface,
                                                                   const FibreBundleSettings& settings) {
  if (Diagnostics faults = check_settings(surface, settings); !faults.ok()) return faults;
  Result<FibreCurves> fibres = settings.method == FibreMethod::kSurface ? make_surface_fibres(surface, settings)
                                                                        : make_isocontour_fibres(surface, settings);
  if (!fibres) return fibres.diagnostics();

  const TriangleMesh mesh = surface_mesh(surface);
  const PulledPoints pulled = pull_inside(mesh, kMargin * static_cast<double>(surface.mean_edge), fibres->points);
  if (pulled.failed > 0)
    return fibre_fault(surface, fmt::format("{} points of fibres cannot be brought inside the muscle", pulled.failed),
                       "mend the mesh where it passes through itself, or ask for fewer points");
  auto bundle = std::make_shared<FibreBundleAsset>();
  bundle->settings = settings;
  bundle->surface_vertices = surface.vertex_count;
  bundle->count = static_cast<std::uint32_t>(fibres->head.size());
  bundle->points_per_fibre = fibres->points_per_fibre;
  bundle->head = std::move(fibres->head);
  bundle->pulled_in = pulled.outside;
  bundle->most_pulled = pulled.furthest;
  bundle->bindings = bind_fibres(mesh, fibres->points);
  // At rest as the bindings give them, so that a surface at rest has fibres of exactly their rest lengths.
  std::vector<SurfacePoint> places(fibres->points.size());
  bundle->rest_length.resize(bundle->count);
  place_fibres({bundle->bindings, bundle->points_per_fibre, surface.rest, places, bundle->rest_length});
  for (const SurfacePoint& p : places) bundle->rest_points.emplace_back(p.x, p.y, p.z);
  if (std::ranges::any_of(bundle->rest_length, [](float length) { return !(length > 0.0f); }))
    return fibre_fault(surface, "a fibre has no length", "attach areas that lie apart");
  return Result<std::shared_ptr<const FibreBundleAsset>>(std::move(bundle), std::move(fibres.diagnostics()));
}

}  // namespace fascicle::muscle
