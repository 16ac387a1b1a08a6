// A skeleton driven by generalized coordinates, as biomechanical models have it: each bone hangs on its parent by a
// joint whose rotations and translations are functions of named coordinates (a knee's translation is a spline of its
// angle). Evaluated in double precision, it writes the same `LocalPose` that a glTF animation writes, so that
// everything downstream is alike.
//
// The pose of a child bone in its parent bone (OpenSim's order):
//
//     X = F_parent * [ R(axis1, f1) R(axis2, f2) R(axis3, f3) | sum axis_k g_k ] * inverse(F_child)
//
// F: the joint's frames, fixed to the two bones; rotations are about axes carried along by the ones before; the
// translation is expressed in the parent's joint frame. A function's coordinate may be coupled to another, locked at
// its default, or clamped to its range.
//
// The root bone is the model's ground. Its rest rotation takes OpenSim's axes (x forward, y up, z right) to glTF's
// (y up, z forward, x left): (x, y, z) -> (-z, y, x), once; every other bone keeps the model's own frame, so that
// positions on bones are the model's own figures.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "engine/animation/scalar_function.hpp"
#include "engine/animation/skeleton.hpp"

namespace fascicle {

// Rotation and translation (m) in double precision.
struct RigidTransform {
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation{0.0};
};
RigidTransform operator*(const RigidTransform& a, const RigidTransform& b);
glm::dvec3 operator*(const RigidTransform& transform, const glm::dvec3& point);
RigidTransform inverse(const RigidTransform& transform);

// Body-fixed rotation about x, then the turned y, then the turned z (rad): OpenSim's "orientation".
glm::dmat3 rotation_from_xyz(const glm::dvec3& angles);

struct JointCoordinate {
  // What its value measures: rad, m, or (coupled) neither alone, as it moves no axis one to one.
  enum class Kind { kRotation, kTranslation, kCoupled };

  std::string name;
  Kind kind = Kind::kRotation;
  double default_value = 0.0;
  double minimum = 0.0;  // of its range; enforced where clamped
  double maximum = 0.0;
  bool clamped = false;
  bool locked = false;           // stays at its default
  std::int32_t driver = -1;      // the coordinate that it is coupled to, or -1
  ScalarFunction coupling;       // of the driver's value
};

// One axis of a joint: how far (rad or m) as a function of a coordinate; coordinate -1: the function's value at 0.
struct JointAxis {
  glm::dvec3 axis{1.0, 0.0, 0.0};       // as written, of any length
  std::int32_t coordinate = -1;
  ScalarFunction function;
  glm::dvec3 direction{1.0, 0.0, 0.0};  // the axis at unit length; made by `finish_joint_model`
};

struct Joint {
  std::string name;
  std::int32_t parent = -1;  // bones
  std::int32_t child = -1;
  // The joint's frames in the bones' frames, as written: position (m) and orientation (rad, body-fixed x, y, z).
  glm::dvec3 parent_translation{0.0};
  glm::dvec3 parent_orientation{0.0};
  glm::dvec3 child_translation{0.0};
  glm::dvec3 child_orientation{0.0};
  std::vector<JointAxis> rotations;     // 0..3, in the order in which they apply
  std::vector<JointAxis> translations;  // 0..3
  // Made by `finish_joint_model`.
  RigidTransform parent_frame;
  RigidTransform child_frame_inverse;
};

struct BodyInertia {
  double mass = 0.0;                     // kg
  glm::dvec3 mass_center{0.0};           // m, in the bone's frame
  std::array<double, 6> inertia{};       // kg m^2: xx yy zz xy xz yz about the mass centre
};

struct JointModel {
  std::shared_ptr<const Skeleton> skeleton;    // bone 0 is the ground; rest = the coordinates' defaults
  std::vector<BodyInertia> bodies;             // one a bone
  std::vector<JointCoordinate> coordinates;
  std::vector<Joint> joints;                   // joints[i].child == i + 1

  std::int32_t find_coordinate(std::string_view name) const;  // index, or -1
};

// A fault that `finish_joint_model` found, and the joint, coordinate or bone (as numbered by the caller) it is at.
struct JointFault {
  enum class At { kBone, kJoint, kCoordinate };
  At at = At::kBone;
  std::size_t index = 0;
  std::string cause;
  std::string remedy;
};

// Makes a model whole whose `bodies`, `coordinates` and `joints` (in any order, frames as written) the caller has
// filled in: sorts the bones `bones` (0: the ground) so that parents stand before children, sorts and renumbers joints
// and bodies to match, and makes frames, axis directions and the skeleton at rest. Where it returns faults the model is
// unusable: a // bone with no joint or with two, a cycle, an axis of no length, a coupling that runs in circles.
std::vector<JointFault> finish_joint_model(JointModel& model, std::vector<std::string> bones);

// The value that coordinate `index` really has when the free ones are set to `values` (one a coordinate, rad or m):
// a locked one its default, a coupled one its function, a clamped one within its range. Not finite: the default.
double coordinate_value(const JointModel& model, std::span<const double> values, std::size_t index);

// The pose of joint `index`'s child in its parent.
RigidTransform evaluate_joint(const JointModel& model, std::span<const double> values, std::size_t index);

// All bones to the character's space (glTF axes), in double precision: for checks and tools.
std::vector<RigidTransform> evaluate_bones(const JointModel& model, std::span<const double> values);

// Writes all bones' local poses. `local` has one entry a bone; the root's is its constant axis change.
void pose_joints(const JointModel& model, std::span<const double> values, std::span<Trs> local);

// The defaults of all coordinates.
std::vector<double> default_coordinates(const JointModel& model);

}  // namespace fascicle
