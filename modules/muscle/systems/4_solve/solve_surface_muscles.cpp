#include "modules/muscle/systems/4_solve/solve_surface_muscles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include "engine/ecs/each_in_parallel.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/systems/4_solve/section_frame.hpp"
#include "modules/muscle/systems/4_solve/touch_neighbours.hpp"

namespace fascicle::muscle {
namespace {

// Of a matrix' entry (m, or 1): nearer to the identity than this it is the identity. Matrices that went through a
// skeleton and back are not exactly what they were; a muscle at rest is to stay exactly there.
constexpr double kRounding = 2.0e-6;

glm::mat4 without_rounding(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column) {
    const glm::dvec4 difference = glm::abs(m[column] - glm::dmat4(1.0)[column]);
    if (!glm::all(glm::lessThan(difference, glm::dvec4(kRounding)))) return glm::mat4(m);
  }
  return glm::mat4(1.0f);
}

bool has_bones(const SurfaceMuscle& muscle, const BoneMatrices* bones) {
  return bones != nullptr && bones->world.size() >= muscle.rest_bones.size();
}

// Where bones are in the simulation's frame, which goes with the frame bone.
void follow_bones(const SurfaceMuscle& muscle, const BoneMatrices& bones, SurfaceState& state) {
  const auto frame_bone = static_cast<std::size_t>(muscle.asset->frame_bone);
  const glm::dmat4 frame = glm::dmat4(bones.world[frame_bone]) * glm::inverse(glm::dmat4(muscle.rest_bones[frame_bone]));
  const glm::dmat4 to_frame = glm::inverse(frame);
  state.frame = glm::mat4(frame);
  for (std::size_t b = 0; b < muscle.rest_bones.size(); ++b) {
    if (b == frame_bone) continue;
    state.bones[b] = without_rounding(to_frame * glm::dmat4(bones.world[b]) *
                                      glm::inverse(glm::dmat4(muscle.rest_bones[b])));
  }
}

void advance(RigidMotion& motion, const glm::mat4& to, bool jump) {
  motion.from = jump ? to : motion.to;
  motion.to = to;
}

void follow_carriers(const SurfaceMuscle& muscle,
                     const ecs::View<const Musculature, const ActionLines, const CrossSections>& musculatures,
                     bool jump, SurfaceState& state) {
  const SurfaceAsset& asset = *muscle.asset;
  for (std::size_t i = 0; i < asset.attachments.size(); ++i) {
    advance(state.attachment_motion[i], state.bones[static_cast<std::size_t>(asset.attachments[i].bone)], jump);
  }
  for (std::size_t i = 0; i < asset.bones.size(); ++i) {
    advance(state.bone_motion[i], state.bones[static_cast<std::size_t>(asset.bones[i])], jump);
  }
  const glm::dmat4 to_frame = glm::inverse(glm::dmat4(state.frame));
  const Musculature* musculature = musculatures.try_get<const Musculature>(muscle.musculature);
  for (std::size_t c = 0; c < asset.carriers.size(); ++c) {
    const SurfaceCarrier& carrier = asset.carriers[c];
    if (carrier.bone >= 0) {
      advance(state.carrier_motion[c], state.bones[static_cast<std::size_t>(carrier.bone)], jump);
      continue;
    }
    glm::mat4 to = state.carrier_motion[c].to;  // a driver that is gone leaves it where it was
    if (musculature != nullptr && musculature->attached[muscle.driver] != 0) {
      const MuscleAsset& driver = *musculature->asset;
      const glm::mat4 now = section_frame(driver, *musculatures.try_get<const ActionLines>(muscle.musculature),
                                          *musculatures.try_get<const CrossSections>(muscle.musculature),
                                          muscle.driver, carrier.section);
      to = without_rounding(to_frame * glm::dmat4(now) *
                            glm::inverse(glm::dmat4(rest_section_frame(driver, muscle.driver, carrier.section))));
    }
    advance(state.carrier_motion[c], to, jump);
  }
}

void report_contacts(const SurfaceMuscle& muscle, const SurfaceState& state, SurfaceContacts& contacts) {
  contacts.now.clear();
  for (std::size_t b = 0; b < muscle.asset->bones.size(); ++b) {
    const BoneTouch& touch = state.scratch.touches[b];
    if (touch.vertices == 0) continue;
    const SurfacePoint& p = state.points[touch.deepest];
    contacts.now.push_back({.bone = muscle.asset->bones[b], .vertices = touch.vertices, .depth = touch.depth,
                            .place = glm::vec3(state.frame * glm::vec4(p.x, p.y, p.z, 1.0f))});
  }
}

using Muscles = ecs::View<const SurfaceMuscle, SurfaceState, SurfaceContacts>;
using Characters = ecs::View<const BoneMatrices, SurfaceNeighbours>;
using Musculatures = ecs::View<const Musculature, const ActionLines, const CrossSections>;

// One step of the system; all that its loops share.
struct Solve {
  Muscles muscles;
  Characters characters;
  Musculatures musculatures;
  const SurfaceKernels& kernels;
  float time = 0.0f;  // s
  SystemCosts costs;

  SurfaceStep step_of(const SurfaceMuscle& muscle, SurfaceState& state) const {
    SurfaceStep step{.asset = muscle.asset.get(), .kernels = &kernels, .settings = muscle.settings, .step = time,
                     .attachments = state.attachment_motion, .carriers = state.carrier_motion,
                     .bones = state.bone_motion, .fields = state.fields, .rest_to_bone = state.rest_to_bone,
                     .points = state.points, .velocity = state.velocity};
    step.settings.substeps = std::max(step.settings.substeps, 1u);  // a game may have set anything
    return step;
  }

  // Where everything has moved that the muscle depends on; whether it is then to be solved.
  bool prepare(const SurfaceMuscle& muscle, SurfaceState& state, SurfaceContacts& contacts) const {
    const BoneMatrices* bones = characters.try_get<const BoneMatrices>(muscle.character);
    if (!has_bones(muscle, bones)) return false;
    const bool jump = !state.started || state.teleport_count != bones->teleport_count;
    state.teleport_count = bones->teleport_count;
    state.started = true;
    follow_bones(muscle, *bones, state);
    follow_carriers(muscle, musculatures, jump, state);
    if (jump || !state.enabled) state.volume = carry_rest_shape(step_of(muscle, state), state.scratch);
    if (!state.enabled) contacts.now.clear();
    return state.enabled && time > 0.0f;
  }

  void finish(const SurfaceMuscle& muscle, SurfaceState& state, SurfaceContacts& contacts) const {
    if (!is_sound(*muscle.asset, state.points, state.volume)) {
      state.volume = carry_rest_shape(step_of(muscle, state), state.scratch);
      ++state.fallbacks;
    }
    report_contacts(muscle, state, contacts);
  }

  // Whether it takes its substeps together with others.
  bool has_neighbours(const SurfaceMuscle& muscle) const {
    const SurfaceNeighbours* neighbours = characters.try_get<SurfaceNeighbours>(muscle.character);
    return neighbours != nullptr && !neighbours->pairs.empty() && muscle.settings.collide_with_muscles;
  }

  void alone(ecs::Entity entity, const SurfaceMuscle& muscle, SurfaceState& state, SurfaceContacts& contacts) const {
    if (has_neighbours(muscle)) return;
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
      if (!has_neighbours(muscle)) continue;
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
                           ecs::View<const Musculature, const ActionLines, const CrossSections> musculatures,
                           ecs::Resource<const FrameTime> time, ecs::Resource<const MuscleSettings> settings,
                           ecs::Resource<const CostLedger> ledger) {
  const Solve solve{muscles, characters, musculatures, surface_kernels(settings->simd), time->step,
                    ledger->system("solve_surface_muscles")};
  ecs::each_in_parallel(muscles, 1, [&](ecs::Entity entity, const SurfaceMuscle& muscle, SurfaceState& state,
                                        SurfaceContacts& contacts) { solve.alone(entity, muscle, state, contacts); });
  ecs::each_in_parallel(characters, 1, [&](const BoneMatrices&, SurfaceNeighbours& neighbours) {
    if (!neighbours.pairs.empty()) solve.together(neighbours);
  });
}

}  // namespace fascicle::muscle
