#include "modules/muscle/systems/4_solve/solve_surface_muscles.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "engine/ecs/each_in_parallel.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/systems/4_solve/touch_neighbours.hpp"

namespace fascicle::muscle {
namespace {

using Muscles = ecs::View<const SurfaceMuscle, SurfaceState, SurfaceContacts>;
using Characters = ecs::View<const BoneMatrices, SurfaceNeighbours>;
using Hulls = ecs::View<const SurfaceHull>;

// One step of the system; all that its loops share.
struct Solve {
  Muscles muscles;
  Characters characters;
  Drivers drivers;
  Hulls hulls;
  const SurfaceKernels& kernels;
  float time = 0.0f;  // s
  SystemCosts costs;

  SurfaceStep step_of(const SurfaceMuscle& muscle, SurfaceState& state) const {
    return make_surface_step(muscle, kernels, time, state);
  }

  // Posed by its hull in this step (pose_surface_muscles.hpp), so nothing here may move it.
  bool is_posed(ecs::Entity entity) const {
    const SurfaceHull* hull = hulls.try_get<const SurfaceHull>(entity);
    return hull != nullptr && hull->solver == SurfaceSolver::kCoarseHull;
  }

  // Where everything has moved that the muscle depends on; whether it is then to be solved.
  bool prepare(const SurfaceMuscle& muscle, SurfaceState& state, SurfaceContacts& contacts) const {
    const Followed followed =
        follow_bones(muscle, characters.try_get<const BoneMatrices>(muscle.character), drivers, state);
    if (followed == Followed::kNothing) return false;
    if (followed == Followed::kJump || !state.enabled) {
      state.volume = carry_rest_shape(step_of(muscle, state), state.scratch);
    }
    if (!state.enabled) contacts.now.clear();
    return state.enabled && time > 0.0f;
  }

  void finish(const SurfaceMuscle& muscle, SurfaceState& state, SurfaceContacts& contacts) const {
    keep_sound(step_of(muscle, state), state);
    report_touches(muscle, state, state.scratch.touches, contacts);
  }

  // Whether it takes its substeps together with others.
  bool has_neighbours(const SurfaceMuscle& muscle) const {
    const SurfaceNeighbours* neighbours = characters.try_get<SurfaceNeighbours>(muscle.character);
    return neighbours != nullptr && !neighbours->pairs.empty() && muscle.settings.collide_with_muscles;
  }

  void alone(ecs::Entity entity, const SurfaceMuscle& muscle, SurfaceState& state, SurfaceContacts& contacts) const {
    if (is_posed(entity) || has_neighbours(muscle)) return;
    const ScopedCost timer(costs.row(entity), ScopedCost::kWhole);
    if (!prepare(muscle, state, contacts)) return;
    state.volume = step_surface(step_of(muscle, state), state.scratch);
    finish(muscle, state, contacts);
  }

  // Calls f(muscle, step, state) for the muscles that are solved, side by side; `touching`: only where one may touch
  // another, or only where not.
  template <class F>
  void each_solved(SurfaceNeighbours& neighbours, std::uint32_t substeps, std::optional<bool> touching, F&& f) const {
    parallel::for_range(neighbours.muscles.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (neighbours.solved[i] == 0) continue;
        if (touching.has_value() && *touching != (neighbours.solved[i] == 2)) continue;
        const ScopedCost timer(costs.row(neighbours.muscles[i]), ScopedCost::kWhole);
        const SurfaceMuscle& muscle = muscles.get<SurfaceMuscle>(neighbours.muscles[i]);
        SurfaceState& state = muscles.get<SurfaceState>(neighbours.muscles[i]);
        SurfaceStep step = step_of(muscle, state);
        step.settings.substeps = substeps;
        f(muscle, step, state);
      }
    });
  }

  // Pairs one after the other: two may share a muscle.
  template <class F>
  void each_pair(SurfaceNeighbours& neighbours, F&& f) const {
    for (NeighbourPair& pair : neighbours.pairs) {
      if (neighbours.solved[pair.first] == 0 || neighbours.solved[pair.second] == 0) continue;
      const ecs::Entity first = neighbours.muscles[pair.first], second = neighbours.muscles[pair.second];
      const ScopedCost timer(costs.row(first), ScopedCost::kWhole);
      f(TouchingMuscle{&muscles.get<SurfaceMuscle>(first), &muscles.get<SurfaceState>(first)},
        TouchingMuscle{&muscles.get<SurfaceMuscle>(second), &muscles.get<SurfaceState>(second)}, pair);
    }
  }

  // A character's muscles that may touch each other, by the most substeps that one of them asks for.
  void together(SurfaceNeighbours& neighbours) const {
    std::uint32_t substeps = 1;
    for (std::size_t i = 0; i < neighbours.muscles.size(); ++i) {
      const ecs::Entity entity = neighbours.muscles[i];
      neighbours.solved[i] = 0;
      if (!muscles.contains(entity)) continue;
      const SurfaceMuscle& muscle = muscles.get<SurfaceMuscle>(entity);
      if (is_posed(entity) || !has_neighbours(muscle)) continue;
      if (!prepare(muscle, muscles.get<SurfaceState>(entity), muscles.get<SurfaceContacts>(entity))) continue;
      neighbours.solved[i] = 1;
      substeps = std::max(substeps, muscle.settings.substeps);
    }
    each_solved(neighbours, substeps, {}, [](const SurfaceMuscle&, const SurfaceStep& step, SurfaceState& state) {
      begin_step(step, state.scratch);
    });
    each_pair(neighbours, find_touching);
    for (const NeighbourPair& pair : neighbours.pairs) {
      if (neighbours.solved[pair.first] == 0 || neighbours.solved[pair.second] == 0 || pair.pairs.pairs.empty()) continue;
      neighbours.solved[pair.first] = neighbours.solved[pair.second] = 2;
    }
    each_solved(neighbours, substeps, false, [](const SurfaceMuscle&, const SurfaceStep& step, SurfaceState& state) {
      for (std::uint32_t i = 0; i < step.settings.substeps; ++i) {
        move_and_constrain(step, i, state.scratch);
        finish_substep(step, i, state.scratch);
      }
    });
    for (std::uint32_t i = 0; i < substeps; ++i) {
      each_solved(neighbours, substeps, true, [i](const SurfaceMuscle&, const SurfaceStep& step, SurfaceState& state) {
        move_and_constrain(step, i, state.scratch);
      });
      const double fraction = static_cast<double>(i + 1) / substeps;
      each_pair(neighbours, [fraction](const TouchingMuscle& first, const TouchingMuscle& second, NeighbourPair& pair) {
        push_apart(first, second, fraction, pair);
      });
      each_solved(neighbours, substeps, true, [i](const SurfaceMuscle&, const SurfaceStep& step, SurfaceState& state) {
        finish_substep(step, i, state.scratch);
      });
    }
    each_solved(neighbours, substeps, {}, [](const SurfaceMuscle&, const SurfaceStep& step, SurfaceState& state) {
      state.volume = end_step(step, state.scratch);
    });
    for (std::size_t i = 0; i < neighbours.muscles.size(); ++i) {
      if (neighbours.solved[i] == 0) continue;
      finish(muscles.get<SurfaceMuscle>(neighbours.muscles[i]), muscles.get<SurfaceState>(neighbours.muscles[i]),
             muscles.get<SurfaceContacts>(neighbours.muscles[i]));
    }
  }
};

}  // namespace

void solve_surface_muscles(ecs::View<const SurfaceMuscle, SurfaceState, SurfaceContacts> muscles,
                           ecs::View<const BoneMatrices, SurfaceNeighbours> characters,
                           Drivers drivers, ecs::View<const SurfaceHull> hulls,
                           ecs::Resource<const FrameTime> time, ecs::Resource<const MuscleSettings> settings,
                           ecs::Resource<const CostLedger> ledger) {
  const Solve solve{muscles, characters, drivers, hulls, surface_kernels(settings->simd), time->step,
                    ledger->system("solve_surface_muscles")};
  ecs::each_in_parallel(muscles, 1, [&](ecs::Entity entity, const SurfaceMuscle& muscle, SurfaceState& state,
                                        SurfaceContacts& contacts) { solve.alone(entity, muscle, state, contacts); });
  ecs::each_in_parallel(characters, 1, [&](const BoneMatrices&, SurfaceNeighbours& neighbours) {
    if (!neighbours.pairs.empty()) solve.together(neighbours);
  });
}

}  // namespace fascicle::muscle
