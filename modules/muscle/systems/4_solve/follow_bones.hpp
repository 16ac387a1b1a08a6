// What both solvers of surface muscles do at the beginning and at the end of a step: bones and carriers followed into
// the simulation's frame, jumps told from movement, the step that kernels take, a shape that went wrong put back,
// contacts with bones reported.
#pragma once

#include <span>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/view.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/kernels/surface/step_surface.hpp"

namespace fascicle::muscle {

using Drivers = ecs::View<const Musculature, const ActionLines, const CrossSections>;

enum class Followed {
  kNothing,  // the character has no bones, too few, or some that are no matrices: the muscle stays as it is
  kMovement,
  kJump,     // the muscle's first step, or its character was put somewhere else
};

// Brings the state's frame, bones and motions to where bones and carriers are now. `bones` may be null.
Followed follow_bones(const SurfaceMuscle& muscle, const BoneMatrices* bones, const Drivers& drivers,
                      SurfaceState& state);

// `time`: s, the step's length.
SurfaceStep make_surface_step(const SurfaceMuscle& muscle, const SurfaceKernels& kernels, float time,
                              SurfaceState& state);

// A shape that is not sound goes back to where its carriers bring it at rest, and is counted. Whether it was sound.
bool keep_sound(const SurfaceStep& step, SurfaceState& state);

// `touches`: by bone that it collides with.
void report_touches(const SurfaceMuscle& muscle, const SurfaceState& state, std::span<const BoneTouch> touches,
                    SurfaceContacts& contacts);

}  // namespace fascicle::muscle
