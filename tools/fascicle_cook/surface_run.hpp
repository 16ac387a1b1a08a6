// A scene's surface muscles played through its animation and measured at every step (4.3): what `fascicle-cook surface`
// prints, checks and plots. Muscles that are posed by their coarse hulls (4.5) are brought to some of their poses again,
// after others and as the first: the shape may not depend on that.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/content/scene_asset.hpp"

namespace fascicle::muscle {
struct SurfaceState;
}

namespace fascicle::cook {

enum class SolverSwitch {
  kOn,
  kOff,     // muscles are only carried by their bones
  kFrozen,  // they stay as they are at rest
};

struct SurfaceRunOptions {
  std::uint64_t frames = 0;  // steps; 0: the scene's
  int workers = 1;
  SolverSwitch solver = SolverSwitch::kOn;
  std::uint32_t substeps_times = 1;  // those of the scene: its stiffness should not hang on them
  // Parts of it that are switched off alone.
  bool edges = true, angles = true, volume = true, bones = true, direction = true;
  std::optional<muscle::SurfaceSolver> forced = {};  // of muscles that have the choice; none: as their level says
  bool keep_poses = false;   // SurfaceMuscleRun::poses of all muscles
};

// One step of one muscle. Lengths in mm, angles in rad; all are doubles so that tables may list them by member.
struct SurfaceStepFigures {
  double volume_ratio = 1.0;
  double edge_mean = 1.0, edge_abs_mean = 0.0, edge_min = 1.0, edge_max = 1.0;
  double edge_p5 = 1.0, edge_p50 = 1.0, edge_p95 = 1.0;
  double dihedral_mean = 0.0, dihedral_max = 0.0, angle_max = 0.0;
  double folded = 0.0, turned = 0.0;         // edges (SurfaceQuality)
  double rest_distance_max = 0.0;
  double attachment_error_max = 0.0;
  double bone_depth_max = 0.0;               // triangles at attached vertices and their neighbours left out
  double bone_depth_beside = 0.0;            // those that touch neighbours
  double fibre_mean = 1.0, fibre_min = 1.0, fibre_max = 1.0;  // length to rest
  double fibres_outside = 0.0;               // points of fibres that are outside of the muscle
  double fibre_furthest = 0.0;               // of these from its surface
  double fallbacks = 0.0;                    // so far
  double step_ms = 0.0;                      // of the whole simulation
  // Of the coarse hull's solver.
  double posed = 0.0;                        // 1: by it, in this step
  double iterations = 0.0;
  double converged = 1.0;                    // 0: it has not
  double residual = 0.0;                     // of the last iteration: its largest move, of the muscle's size
  double pose_ms = 0.0;                      // of the system that poses all muscles
};

// What a muscle was in one step.
struct SurfacePose {
  std::vector<glm::mat4> bones;              // rest space -> simulation's frame
  std::vector<glm::vec3> shape;              // m, by vertex, simulation's frame
  std::vector<float> residuals, refined;     // by iteration: as in HullScratch
};

// A pose of the run, taken a second time.
enum class Revisit {
  kAfterOthers,  // in the same simulation
  kFirst,        // as the first step of a new one
  kIterated,     // likewise, with kTimesIterations and no tolerance: has it converged?
};
inline constexpr std::uint32_t kTimesIterations = 4;
struct SurfaceRevisit {
  std::uint64_t step = 0;                    // whose pose it was
  Revisit how = Revisit::kAfterOthers;
  double largest = 0.0, mean = 0.0;          // how far vertices are from where they were, of the muscle's size
  std::vector<float> residuals = {};         // by iteration: as in HullScratch
};

inline constexpr std::uint64_t kFlexedStep = 100;  // of the published scenes: the end of the flexion

struct SurfaceMuscleRun {
  std::shared_ptr<const muscle::SurfaceAsset> asset;
  muscle::SurfaceSettings settings;                // that it ran with
  std::vector<std::string> bones;                  // by attachment: its bone's name
  std::size_t attached_at_insertion = 0;           // vertices
  std::vector<SurfaceStepFigures> steps;           // from step 1
  std::vector<glm::vec3> flexed;                   // m, by vertex, at kFlexedStep; empty: the run ended before
  std::vector<double> fibre_rest;                  // mm, by fibre; empty: it has none
  std::vector<std::vector<double>> fibre_ratios;   // by fibre, by step: its length to rest
  std::size_t hull_vertices = 0;                   // 0: it has no hull
  muscle::HullSettings hull;                       // that it ran with
  std::vector<SurfacePose> poses;                  // by step; empty: it has no hull, and nobody asked
  std::vector<SurfaceRevisit> revisits;            // of poses that its hull made
};

struct SurfaceRun {
  std::string scene, simd;
  SurfaceRunOptions options;
  float step_hz = 0.0f;
  std::vector<SurfaceMuscleRun> muscles;
};

// A scene without surface muscles gives an empty list.
SurfaceRun run_surfaces(const std::shared_ptr<const muscle::SceneAsset>& scene, const SurfaceRunOptions& options);

// Its vertices now, m, simulation's frame.
std::vector<glm::vec3> shape_of(const muscle::SurfaceAsset& asset, const muscle::SurfaceState& state);

// How far the vertices of two shapes of one muscle are from each other, as parts of its size; not a number where they
// are not as many. A muscle that is attached to nothing may have slid as a whole: that is no shape.
struct ShapeDifference {
  double largest = 0.0, mean = 0.0;
};
ShapeDifference compare_shapes(const muscle::SurfaceAsset& asset, const std::vector<glm::vec3>& one,
                               const std::vector<glm::vec3>& other);

}  // namespace fascicle::cook
