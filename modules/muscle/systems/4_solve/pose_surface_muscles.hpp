// System, 4 solve: surface muscles that their coarse hull poses in this step (SurfaceHull::solver) get their shape from
// the pose alone (kernels/hull/pose_surface.hpp), even in a step of no length. A change from another solver, or another
// number of refinements, is blended over SurfaceHull::blend_time; a character that was put somewhere else ends that.
// One whose shape is not sound goes back to where its carriers bring it at rest, and is counted.
//
// Dynamics have no use for what they remember of such a muscle, so it is forgotten: when solve_surface_muscles takes
// over, it starts at the posed shape and from rest.
#pragma once

#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "engine/loop/frame_time.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/systems/4_solve/follow_bones.hpp"

namespace fascicle::muscle {

void pose_surface_muscles(ecs::View<const SurfaceMuscle, SurfaceState, SurfaceContacts, SurfaceHull> muscles,
                          ecs::View<const BoneMatrices> characters, Drivers drivers,
                          ecs::Resource<const FrameTime> time, ecs::Resource<const MuscleSettings> settings,
                          ecs::Resource<const CostLedger> ledger);

// What is the same for all muscles of a step.
struct PoseContext {
  Drivers drivers;
  const SurfaceKernels& surface_kernels;
  const HullKernels& hull_kernels;
  float time = 0.0f;      // s, the step's length
  bool blending = true;   // false: the pose at once, refined as SurfaceHull::settings say and not as the level does
};
// One muscle, whatever its solver. Whether it could be posed: not so without bones, or while it is not enabled.
bool pose_muscle(const PoseContext& context, const SurfaceMuscle& muscle, const BoneMatrices* bones,
                 SurfaceState& state, SurfaceContacts& contacts, SurfaceHull& hull);

}  // namespace fascicle::muscle
