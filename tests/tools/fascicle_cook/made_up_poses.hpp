// A run of a muscle that its coarse hull posed, made up: two vertices of a muscle 0.2 m large, between a bone that stays
// and one that turns about x.
#pragma once

#include <memory>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "tools/fascicle_cook/surface_run.hpp"

namespace fascicle::cook {

inline SurfacePose made_up_pose(double angle) {
  const glm::mat4 turned(glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(1.0, 0.0, 0.0)));
  return {.bones = {glm::mat4(1.0f), turned},
          .shape = {{0.0f, 0.0f, 0.0f}, {0.1f, static_cast<float>(angle), 0.0f}},
          .residuals = {1e-2f, 1e-4f, 1e-6f},
          .refined = {1e-3f}};
}

// A step a pose, by its angle (rad): without faults.
inline SurfaceMuscleRun made_up_run(const std::vector<double>& angles) {
  auto asset = std::make_shared<muscle::SurfaceAsset>();
  asset->name = "calf & <co>";
  asset->size = 0.2f;
  asset->attachments = {{0, true, 1}, {1, false, 1}};
  asset->attached.resize(2);
  SurfaceMuscleRun run;
  run.asset = asset;
  run.bones = {"pelvis", "femur"};
  run.attached_at_insertion = 1;
  run.hull_vertices = 300;
  for (const double angle : angles) {
    SurfaceStepFigures& step = run.steps.emplace_back();
    step.posed = 1.0;
    step.iterations = 3.0;
    step.residual = 1e-6;
    run.poses.push_back(made_up_pose(angle));
  }
  return run;
}

}  // namespace fascicle::cook
