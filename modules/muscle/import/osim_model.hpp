// An OpenSim model as this project uses it: bodies and joints as a JointModel, bone geometry, muscles with their path
// points and Hill parameters. Plain data, positions in metres in the frames of the bodies, exactly as in the file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/animation/joint_model.hpp"
#include "engine/animation/scalar_function.hpp"

namespace fascicle::muscle {

// A mesh file attached to a body: vertices times `scale`, then turned (rad, body-fixed x, y, z) and moved (m).
struct OsimGeometry {
  std::int32_t body = 0;  // bone of the joint model
  std::string file;       // as in the model, without a folder most often
  glm::dvec3 scale{1.0};
  glm::dvec3 orientation{0.0};
  glm::dvec3 translation{0.0};
};

struct OsimPathPoint {
  enum class Kind { kFixed, kConditional, kMoving };

  std::string name;
  Kind kind = Kind::kFixed;
  std::int32_t body = 0;
  glm::dvec3 location{0.0};  // m, in the body's frame; of a moving point: at the coordinates' defaults
  // Conditional: active while the coordinate is within the range (OpenSim allows 1e-5 more at both ends).
  std::int32_t coordinate = -1;
  double range_min = 0.0;
  double range_max = 0.0;
  // Moving: each component as a function of a coordinate (-1: its value at 0), in the socket's frame, which
  // `frame` takes to the body's.
  std::array<std::int32_t, 3> moving_coordinates{-1, -1, -1};
  std::array<ScalarFunction, 3> moving;
  RigidTransform frame;
};

struct OsimMuscle {
  std::string name;
  std::string type;                     // Thelen2003Muscle, ...
  std::vector<OsimPathPoint> points;    // at least 2
  std::vector<std::string> wraps;       // names of the wrap objects that the path may wrap over
  std::vector<std::string> groups;
  double max_isometric_force = 1000.0;  // N; defaults are OpenSim's
  double optimal_fibre_length = 0.1;    // m
  double tendon_slack_length = 0.2;     // m
  double pennation = 0.0;               // rad, at optimal fibre length
  int line = 0;                         // in the file, for messages
  int column = 0;
};

// Listed for their names; their surfaces come with functional paths.
struct OsimWrapObject {
  std::string name;
  std::string type;  // WrapCylinder, ...
  std::int32_t body = 0;
};

struct OsimModel {
  std::string file;
  std::string name;
  std::string credits;
  JointModel joints;  // bone 0 is the model's ground
  std::vector<OsimGeometry> geometry;
  std::vector<OsimMuscle> muscles;
  std::vector<OsimWrapObject> wrap_objects;
};

// Whether a point is part of the path at these coordinates (fixed and moving points always are).
bool is_active(const OsimModel& model, const OsimPathPoint& point, std::span<const double> coordinates);
// Where it is in its body's frame (m).
glm::dvec3 location_at(const OsimModel& model, const OsimPathPoint& point, std::span<const double> coordinates);

}  // namespace fascicle::muscle
