// System: how large a surface muscle is in the picture -> the level of detail of its shape, and with it the solver:
// position based dynamics, or its coarse hull. Only muscles with a SurfaceHull have a choice. A change to the hull is
// blended by pose_surface_muscles; one back is none, for dynamics go on from the shape that they find.
//
// A muscle whose bones are not all there keeps its level.
#pragma once

#include <cstdint>
#include <span>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "modules/muscle/components/muscle_detail.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"

namespace fascicle::muscle {

void select_surface_solvers(ecs::View<const SurfaceMuscle, SurfaceHull> muscles,
                            ecs::View<const BoneMatrices> characters, ecs::Resource<const Viewer> viewer);

// A muscle becomes coarser where it is this much smaller in the picture than its level asks for, finer as soon as it is
// as large as the finer level asks for; so one that stands at a border does not change to and fro.
inline constexpr float kSolverHysteresis = 0.1f;

// The level for a muscle that is `pixels` large and has `current`. Sizes that are no numbers choose the finest; no
// levels at all are one.
std::uint32_t choose_surface_level(std::span<const SurfaceLevel> levels, float pixels, std::uint32_t current);

}  // namespace fascicle::muscle
