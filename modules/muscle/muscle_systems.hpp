// The muscle module's systems, in frame order. `add_muscle_systems` is the one ordered list.
#pragma once

namespace fascicle::ecs {
class Schedule;
}

namespace fascicle::muscle {

// Registers, after whatever writes BoneMatrices: select_surface_solvers, select_levels, drive_action_lines,
// build_frames, find_tendons, solve_muscles, solve_as_legacy, solve_surface_muscles, pose_surface_muscles,
// measure_muscles, write_surfaces, measure_fibres, measure_surfaces, write_surface_muscles. The world must have been
// given its settings by prepare_muscles (spawn_muscles.hpp).
void add_muscle_systems(ecs::Schedule& schedule);

}  // namespace fascicle::muscle
