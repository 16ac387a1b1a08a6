// The 24 musculotendon units of a side: published attachment points and Hill parameters, and how the walker's own
// muscle meshes are shaped around them.
#pragma once

#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace fascicle::walker {

// Why a point stands on an action line.
enum class PointKind {
  kPublished,    // origin, insertion, fixed via points, and the conditional point that is kept always on
  kConditional,  // published, active in part of the range only: always on here, left out of the counts
  kExtra,        // the walker's own: keeps the line off bone; left out of the counts
};

struct PathPoint {
  std::string bone;
  glm::vec3 position{0.0f};  // m, in the bone's frame, glTF axes
  PointKind kind = PointKind::kPublished;
};

// How the mesh is swept along the belly curve, which follows the action line but is free to bulge away from bone and
// neighbours. Fractions are of the curve's length from the origin; directions are in OpenSim axes (x forward, y up,
// z right); lengths in mm.
struct BellyShape {
  float begin = 0.1f, peak = 0.45f, end = 0.8f;        // where the belly starts, is thickest, and ends
  float aspect = 2.0f;                                 // width over thickness of the belly
  float wrap = 0.8f;                                   // rad, how far the width bends around what lies beneath
  float skew = 0.2f;                                   // -1..1, one edge thicker than the other
  float lift = 0.4f;                                   // thicknesses between bone and the belly's middle
  float origin_width = 4.0f, origin_thickness = 2.0f;  // half width and thickness of the end sections
  float insertion_width = 3.0f, insertion_thickness = 2.0f;
  glm::vec3 outward_origin{1.0f, 0.0f, 0.0f};     // the thickness points this way at the origin ...
  glm::vec3 outward_insertion{1.0f, 0.0f, 0.0f};  // ... and this way at the insertion
  glm::vec3 origin_shift{0.0f};                   // of the curve against the action line: where two lines share a
  glm::vec3 middle_shift{0.0f};                   // place their meshes lie side by side; a straight line between two
  glm::vec3 tendon_shift{0.0f};                   // points passes beside the tendon, which joints hold down
  glm::vec3 insertion_shift{0.0f};
};

struct MuscleSpec {
  std::string name;                   // right side
  float max_isometric_force = 0.0f;   // N
  float optimal_fibre_length = 0.0f;  // m
  float tendon_slack_length = 0.0f;   // m
  float pennation = 0.0f;             // rad
  std::vector<PathPoint> path;        // origin, via points in order, insertion
  BellyShape belly;

  float volume() const;  // m^3, of the belly: F / sigma * l_Fo, sigma = 61 N/cm^2
};

const std::vector<MuscleSpec>& muscle_table();

// Points in the character's rest space.
std::vector<glm::vec3> rest_path(const MuscleSpec& muscle);
// Length (m) of the published path at rest: its own extras left out.
float published_length(const MuscleSpec& muscle);

}  // namespace fascicle::walker
