#include "tools/fascicle_cook/surface_revisit.hpp"

#include <algorithm>

#include "engine/animation/joint_systems.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "tools/fascicle_cook/surface_switches.hpp"

namespace fascicle::cook {
namespace {

using namespace muscle;

constexpr std::uint64_t kRevisits = 5;  // poses that are taken again

// Nothing plays any more: characters stand as they are told to.
void hold(game::Simulation& simulation, const Coordinates& coordinates) {
  for (std::size_t i = 0; i < std::min(coordinates.size(), simulation.characters().size()); ++i) {
    const ecs::Entity entity = simulation.characters()[i].entity;
    if (auto* player = simulation.world().try_get<MotionPlayer>(entity)) player->motion = nullptr;
    if (auto* pose = simulation.world().try_get<CoordinatePose>(entity)) pose->values = coordinates[i];
  }
}

// One step at that pose, and how far muscles are from what they were in the run.
void visit(const std::vector<Coordinates>& by_step, std::uint64_t step, Revisit how, game::Simulation& simulation,
           SurfaceRun& run) {
  hold(simulation, by_step[step - 1]);
  simulation.step();
  const ecs::World& world = simulation.world();
  if (run.options.solver == SolverSwitch::kFrozen) follow_frames(simulation.world());
  std::size_t next = 0;
  world.view<const SurfaceMuscle>().each([&](ecs::Entity entity, const SurfaceMuscle& muscle) {
    if (next == run.muscles.size()) return;
    SurfaceMuscleRun& made = run.muscles[next++];
    if (made.poses.size() < step || made.steps[step - 1].posed == 0.0) return;
    const ShapeDifference d = compare_shapes(*muscle.asset, made.poses[step - 1].shape,
                                             shape_of(*muscle.asset, world.get<SurfaceState>(entity)));
    made.revisits.push_back({step, how, d.largest, d.mean, world.get<SurfaceHull>(entity).scratch.residuals});
  });
}

void iterate_further(ecs::World& world) {
  world.view<SurfaceHull>().each([](SurfaceHull& hull) {
    hull.settings.iterations *= kTimesIterations;
    hull.settings.tolerance = 0.0f;
  });
}

bool complete(const Coordinates& coordinates) {
  return std::none_of(coordinates.begin(), coordinates.end(), [](const auto& values) { return values.empty(); });
}

}  // namespace

Coordinates read_coordinates(const game::Simulation& simulation) {
  Coordinates coordinates;
  for (const game::SpawnedCharacter& character : simulation.characters()) {
    const auto* pose = simulation.world().try_get<CoordinatePose>(character.entity);
    coordinates.push_back(pose == nullptr ? std::vector<double>{} : pose->values);
  }
  return coordinates;
}

void revisit(const std::shared_ptr<const SceneAsset>& scene, const std::vector<Coordinates>& by_step,
             game::Simulation& simulation, SurfaceRun& run) {
  const bool any_posed = std::any_of(run.muscles.begin(), run.muscles.end(), [](const SurfaceMuscleRun& muscle) {
    return std::any_of(muscle.steps.begin(), muscle.steps.end(), [](const auto& s) { return s.posed != 0.0; });
  });
  if (!any_posed || !std::all_of(by_step.begin(), by_step.end(), complete)) return;
  const std::uint64_t count = by_step.size(), visits = std::min(kRevisits, count);
  for (std::uint64_t i = 0; i < visits; ++i) {
    const std::uint64_t step = count - i * count / visits;
    // The run has just been at its last pose.
    if (i > 0) visit(by_step, step, Revisit::kAfterOthers, simulation, run);
    for (const Revisit how : {Revisit::kFirst, Revisit::kIterated}) {
      game::Simulation fresh(scene, simulation_options(run.options));
      switch_off(run.options, fresh.world());
      if (how == Revisit::kIterated) iterate_further(fresh.world());
      visit(by_step, step, how, fresh, run);
    }
  }
}

}  // namespace fascicle::cook
