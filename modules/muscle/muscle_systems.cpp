#include "modules/muscle/muscle_systems.hpp"

#include "engine/ecs/schedule.hpp"
#include "modules/muscle/systems/1_drive/drive_action_lines.hpp"
#include "modules/muscle/systems/1_drive/select_levels.hpp"
#include "modules/muscle/systems/1_drive/select_surface_solvers.hpp"
#include "modules/muscle/systems/2_shape/build_frames.hpp"
#include "modules/muscle/systems/2_shape/find_tendons.hpp"
#include "modules/muscle/systems/4_solve/pose_surface_muscles.hpp"
#include "modules/muscle/systems/4_solve/solve_as_legacy.hpp"
#include "modules/muscle/systems/4_solve/solve_muscles.hpp"
#include "modules/muscle/systems/4_solve/solve_surface_muscles.hpp"
#include "modules/muscle/systems/5_present/measure_fibres.hpp"
#include "modules/muscle/systems/5_present/measure_muscles.hpp"
#include "modules/muscle/systems/5_present/measure_surfaces.hpp"
#include "modules/muscle/systems/5_present/write_surface_muscles.hpp"
#include "modules/muscle/systems/5_present/write_surfaces.hpp"

namespace fascicle::muscle {

void add_muscle_systems(ecs::Schedule& schedule) {
  // 1 drive: the viewer's distance chooses the levels of detail, bones move the lines.
  schedule.add("select_surface_solvers", select_surface_solvers);
  schedule.add("select_levels", select_levels);
  schedule.add("drive_action_lines", drive_action_lines);
  // 2 shape: lines carry the sections.
  schedule.add("build_frames", build_frames);
  schedule.add("find_tendons", find_tendons);
  // 4 solve: what collides is found and moved apart.
  schedule.add("solve_muscles", solve_muscles);
  schedule.add("solve_as_legacy", solve_as_legacy);
  schedule.add("solve_surface_muscles", solve_surface_muscles);
  schedule.add("pose_surface_muscles", pose_surface_muscles);
  // 5 present: what others read.
  schedule.add("measure_muscles", measure_muscles);
  schedule.add("write_surfaces", write_surfaces);
  schedule.add("measure_fibres", measure_fibres);
  schedule.add("measure_surfaces", measure_surfaces);
  schedule.add("write_surface_muscles", write_surface_muscles);
}

}  // namespace fascicle::muscle
