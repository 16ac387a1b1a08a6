#include "tools/fascicle_cook/fibres_play.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "engine/ecs/monotonic_clock.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/self_intersections.hpp"
#include "engine/geometry/winding_number.hpp"
#include "engine/parallel/for_range.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/add_fibres.hpp"
#include "modules/muscle/asset/fibres/surface_mesh.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/systems/5_present/measure_fibres.hpp"

namespace fascicle::cook {
namespace {

using namespace muscle;

constexpr std::size_t kChunk = 128;

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

void check(const SurfaceAsset& surface, const SurfaceState& state, const FibreBundle& bundle, std::uint64_t step,
           FibrePlay& play) {
  TriangleMesh mesh = surface_mesh(surface);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    mesh.positions[v] = {state.points[v].x, state.points[v].y, state.points[v].z};
  const WindingField winding(mesh);
  std::vector<std::uint8_t> outside(bundle.points.size(), 0);
  parallel::for_range(outside.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfacePoint& p = bundle.points[i];
      outside[i] = winding.inside({p.x, p.y, p.z}) ? 0 : 1;
    }
  });
  ++play.checked;
  const auto count = static_cast<std::size_t>(std::ranges::count(outside, std::uint8_t{1}));
  if (count == 0) return;
  const ClosestPoints nearest(mesh);
  for (std::size_t i = 0; i < outside.size(); ++i) {
    const SurfacePoint& p = bundle.points[i];
    if (outside[i]) play.furthest = std::max(play.furthest, static_cast<double>(nearest.at({p.x, p.y, p.z}).distance));
  }
  if (count <= play.outside) return;
  play.outside = count;
  play.worst_step = step;
  play.self_intersections = find_self_intersections(mesh.positions, mesh.indices).pairs;
}

}  // namespace

std::vector<FibrePlay> play_fibres(const std::shared_ptr<const SceneAsset>& scene,
                                   std::span<const MuscleFibres> muscles, std::uint64_t every) {
  game::Simulation simulation(scene, {.workers = 1, .skin_meshes = false});
  ecs::World& world = simulation.world();
  std::vector<FibrePlay> plays;
  std::vector<ecs::Entity> entities;
  std::vector<std::vector<double>> costs;  // us, by muscle, by step
  std::vector<double> step_costs;
  for (const MuscleFibres& muscle : muscles) {
    ecs::Entity found = ecs::kNoEntity;
    world.view<const SurfaceMuscle>().each([&](ecs::Entity entity, const SurfaceMuscle& spawned) {
      if (found == ecs::kNoEntity && spawned.asset == muscle.surface) found = entity;
    });
    if (found == ecs::kNoEntity) continue;
    add_fibres(world, found, muscle.bundle);
    entities.push_back(found);
    costs.emplace_back();
    plays.push_back({.muscle = muscle.surface->name});
  }
  const auto frames = static_cast<std::uint64_t>(std::max(scene->frames, 0));
  for (std::uint64_t step = 1; step <= frames; ++step) {
    const std::int64_t start = monotonic_ns();
    simulation.step();
    step_costs.push_back(1e-3 * static_cast<double>(monotonic_ns() - start));
    for (std::size_t i = 0; i < plays.size(); ++i) {
      FibrePlay& play = plays[i];
      FibreBundle& bundle = world.get<FibreBundle>(entities[i]);
      const SurfaceState& state = world.get<SurfaceState>(entities[i]);
      const std::int64_t begin = monotonic_ns();
      measure_fibre_bundle(state, bundle);  // once more, to be timed
      costs[i].push_back(1e-3 * static_cast<double>(monotonic_ns() - begin));
      ++play.steps;
      const double ratio = static_cast<double>(bundle.length_ratio_mean);
      play.least_ratio = std::min(play.least_ratio, ratio);
      play.most_ratio = std::max(play.most_ratio, ratio);
      play.last_ratio = ratio;
      if (step % every == 0) check(*world.get<SurfaceMuscle>(entities[i]).asset, state, bundle, step, play);
    }
  }
  for (std::size_t i = 0; i < plays.size(); ++i) {
    plays[i].fibres_us = median(costs[i]);
    plays[i].step_us = median(step_costs);
  }
  return plays;
}

std::string to_table(const FibrePlay& play) {
  std::string text = fmt::format("{}, {} steps\n", play.muscle, play.steps);
  const auto line = [&](std::string_view what, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "  {:<26} {}\n", what, value);
  };
  if (play.outside == 0) {
    line("points outside", fmt::format("none at {} steps checked", play.checked));
  } else {
    line("points outside", fmt::format("{} at step {}, the worst of {} checked; {:.2f} mm at most", play.outside,
                                       play.worst_step, play.checked, 1e3 * play.furthest));
    line("triangles that cross then", fmt::format("{} pairs", play.self_intersections));
  }
  line("mean length to rest",
       fmt::format("{:.4f} to {:.4f}, {:.4f} at the end", play.least_ratio, play.most_ratio, play.last_ratio));
  line("cost (us a step)", fmt::format("{:.1f}, {:.1f} % of the step's {:.1f}", play.fibres_us,
                                       play.step_us > 0.0 ? 100.0 * play.fibres_us / play.step_us : 0.0, play.step_us));
  return text;
}

}  // namespace fascicle::cook
