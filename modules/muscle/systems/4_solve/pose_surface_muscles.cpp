#include "modules/muscle/systems/4_solve/pose_surface_muscles.hpp"

#include "engine/ecs/each_in_parallel.hpp"
#include "modules/muscle/kernels/hull/blend_surface.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kRounding = 1.0e-3f;  // of a step: less time than that is left only because numbers are rounded

void place_line(const SurfaceState& state, SurfaceHull& hull) {
  for (std::size_t i = 0; i < hull.line.size(); ++i) {
    const HullLinePoint& point = hull.asset->line[i];
    const glm::mat4& carried = point.bone >= 0 ? state.bones[static_cast<std::size_t>(point.bone)]
                                               : state.carrier_motion[point.carrier].to;
    hull.line[i] = glm::vec3(carried * glm::vec4(point.rest, 1.0f));
  }
}

void pose(const PoseContext& context, const SurfaceStep& step, SurfaceState& state, SurfaceHull& hull) {
  place_line(state, hull);
  HullSettings settings = hull.settings;
  if (context.blending) settings.refinements = hull.refinements;
  hull.pose = pose_surface(step, *hull.asset, context.hull_kernels, settings, hull.line, hull.scratch);
  state.volume = hull.pose.volume;
  forget_pairs(state.scratch.itself);
  ++state.scratch.restarts;  // pairs with other muscles are found anew
}

}  // namespace

bool pose_muscle(const PoseContext& context, const SurfaceMuscle& muscle, const BoneMatrices* bones,
                 SurfaceState& state, SurfaceContacts& contacts, SurfaceHull& hull) {
  const Followed followed = follow_bones(muscle, bones, context.drivers, state);
  if (followed == Followed::kNothing) return false;
  const SurfaceStep step = make_surface_step(muscle, context.surface_kernels, context.time, state);
  if (!state.enabled) {
    state.volume = carry_rest_shape(step, state.scratch);
    contacts.now.clear();
    hull.changed = true;
    return false;
  }
  if (followed == Followed::kJump || !context.blending) {
    hull.changed = false;
    hull.blend_left = 0.0f;
  }
  const bool begins = hull.changed && hull.blend_time > 0.0f;
  if (begins) carry_along(step, state.scratch, hull.difference);
  pose(context, step, state, hull);
  if (begins) {
    hull.volume_difference = take_difference(step, state.scratch, hull.difference);
    hull.blend_left = hull.blend_time;
  }
  hull.changed = false;
  hull.blend_left -= context.time;
  if (!(hull.blend_left > kRounding * context.time)) hull.blend_left = 0.0f;
  const float share = hull.blend_time > 0.0f ? fading(hull.blend_left / hull.blend_time) : 0.0f;
  if (share > 0.0f) {
    state.volume = add_difference(step, share, hull.difference, hull.volume_difference, state.scratch,
                                  hull.scratch.touches);
  }
  if (!keep_sound(step, state)) {
    hull.blend_left = 0.0f;
    hull.changed = true;
  }
  report_touches(muscle, state, hull.scratch.touches, contacts);
  return true;
}

void pose_surface_muscles(ecs::View<const SurfaceMuscle, SurfaceState, SurfaceContacts, SurfaceHull> muscles,
                          ecs::View<const BoneMatrices> characters, Drivers drivers,
                          ecs::Resource<const FrameTime> time, ecs::Resource<const MuscleSettings> settings,
                          ecs::Resource<const CostLedger> ledger) {
  const PoseContext context{drivers, surface_kernels(settings->simd), hull_kernels(settings->simd), time->step};
  const SystemCosts costs = ledger->system("pose_surface_muscles");
  const auto pose_one = [&](ecs::Entity entity, const SurfaceMuscle& muscle, SurfaceState& state,
                            SurfaceContacts& contacts, SurfaceHull& hull) {
    if (hull.solver != SurfaceSolver::kCoarseHull) return;
    const ScopedCost timer(costs.row(entity), ScopedCost::kWhole);
    pose_muscle(context, muscle, characters.try_get<const BoneMatrices>(muscle.character), state, contacts, hull);
  };
  ecs::each_in_parallel(muscles, 1, pose_one);
}

}  // namespace fascicle::muscle
