#include "engine/animation/joint_model.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

namespace fascicle {
namespace {

// Rotation about a unit axis (Rodrigues).
glm::dmat3 rotation_about(const glm::dvec3& axis, double angle) {
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  const glm::dvec3 v = (1.0 - c) * axis;
  // Columns.
  return {glm::dvec3(v.x * axis.x + c, v.x * axis.y + s * axis.z, v.x * axis.z - s * axis.y),
          glm::dvec3(v.y * axis.x - s * axis.z, v.y * axis.y + c, v.y * axis.z + s * axis.x),
          glm::dvec3(v.z * axis.x + s * axis.y, v.z * axis.y - s * axis.x, v.z * axis.z + c)};
}

// (x, y, z) -> (-z, y, x): OpenSim's axes to glTF's.
RigidTransform axis_change() {
  return {glm::dmat3(glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(-1.0, 0.0, 0.0)), {}};
}

Trs to_trs(const RigidTransform& transform) {
  Trs trs;
  trs.translation = glm::vec3(transform.translation);
  trs.rotation = glm::quat(glm::normalize(glm::quat_cast(transform.rotation)));
  return trs;
}

bool is_finite(const Trs& trs) {
  const glm::vec3& t = trs.translation;
  const glm::quat& q = trs.rotation;
  return std::isfinite(t.x + t.y + t.z) && std::isfinite(q.x + q.y + q.z + q.w);
}

double axis_value(const JointModel& model, std::span<const double> values, const JointAxis& axis) {
  if (axis.coordinate < 0) return axis.function(0.0);
  return axis.function(coordinate_value(model, values, static_cast<std::size_t>(axis.coordinate)));
}

bool find_directions(std::vector<JointAxis>& axes) {
  for (JointAxis& axis : axes) {
    const double length = glm::length(axis.axis);
    if (!std::isfinite(length) || length < 1e-9) return false;
    axis.direction = axis.axis / length;
  }
  return true;
}

// Couplings in a circle, or in chains too long for a recursive evaluation.
void find_coupling_circles(const JointModel& model, std::vector<JointFault>& faults) {
  constexpr int kLongestChain = 16;
  for (std::size_t i = 0; i < model.coordinates.size(); ++i) {
    const JointCoordinate& coordinate = model.coordinates[i];
    std::int32_t at = coordinate.driver;
    for (int steps = 0; at >= 0; ++steps, at = model.coordinates[static_cast<std::size_t>(at)].driver) {
      if (steps < kLongestChain) continue;
      faults.push_back({JointFault::At::kCoordinate, i,
                        fmt::format("the coordinate '{}' is coupled in a circle, or through more than {} others",
                                    coordinate.name, kLongestChain),
                        "let the chain of couplings end at a free coordinate"});
      break;
    }
  }
}

// The joint of each bone (bone 0 has none); reports bones without one and with several.
std::vector<std::int32_t> joints_of_bones(const JointModel& model, std::span<const std::string> bones,
                                          std::vector<JointFault>& faults) {
  std::vector<std::int32_t> joint_of(bones.size(), -1);
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const Joint& joint = model.joints[j];
    const auto child = static_cast<std::size_t>(joint.child);
    assert(joint.parent >= 0 && joint.child >= 0 && child < bones.size());
    if (child == 0) {
      faults.push_back({JointFault::At::kJoint, j,
                        fmt::format("the joint '{}' moves the ground '{}'", joint.name, bones[0]),
                        "make the ground its parent"});
    } else if (joint_of[child] >= 0) {
      faults.push_back({JointFault::At::kJoint, j,
                        fmt::format("the body '{}' is the child of two joints, '{}' and '{}'", bones[child],
                                    model.joints[static_cast<std::size_t>(joint_of[child])].name, joint.name),
                        "keep one of them: closed loops of joints are not supported"});
    } else {
      joint_of[child] = static_cast<std::int32_t>(j);
    }
  }
  for (std::size_t b = 1; b < bones.size(); ++b) {
    if (joint_of[b] >= 0) continue;
    faults.push_back({JointFault::At::kBone, b, fmt::format("the body '{}' hangs on no joint", bones[b]),
                      "add a joint whose child it is, for instance one without axes to the ground"});
  }
  return joint_of;
}

// Bones so that parents stand before children, else in the given order. Empty where joints run in a circle.
std::vector<std::int32_t> parents_first(const JointModel& model, std::span<const std::int32_t> joint_of,
                                        std::span<const std::string> bones, std::vector<JointFault>& faults) {
  std::vector<std::int32_t> order{0};
  std::vector<bool> placed(bones.size(), false);
  placed[0] = true;
  std::vector<std::int32_t> chain;
  for (std::size_t b = 1; b < bones.size(); ++b) {
    chain.clear();
    auto at = static_cast<std::int32_t>(b);
    while (!placed[static_cast<std::size_t>(at)]) {
      if (chain.size() > bones.size()) {
        faults.push_back({JointFault::At::kJoint, static_cast<std::size_t>(joint_of[b]),
                          fmt::format("the joints from the body '{}' upwards run in a circle", bones[b]),
                          "let the chain of parents end at the ground"});
        return {};
      }
      chain.push_back(at);
      at = model.joints[static_cast<std::size_t>(joint_of[static_cast<std::size_t>(at)])].parent;
    }
    for (auto bone = chain.rbegin(); bone != chain.rend(); ++bone) {
      placed[static_cast<std::size_t>(*bone)] = true;
      order.push_back(*bone);
    }
  }
  return order;
}

}  // namespace

RigidTransform operator*(const RigidTransform& a, const RigidTransform& b) {
  return {a.rotation * b.rotation, a.rotation * b.translation + a.translation};
}

glm::dvec3 operator*(const RigidTransform& transform, const glm::dvec3& point) {
  return transform.rotation * point + transform.translation;
}

RigidTransform inverse(const RigidTransform& transform) {
  const glm::dmat3 rotation = glm::transpose(transform.rotation);
  return {rotation, -(rotation * transform.translation)};
}

glm::dmat3 rotation_from_xyz(const glm::dvec3& angles) {
  return rotation_about({1.0, 0.0, 0.0}, angles.x) * rotation_about({0.0, 1.0, 0.0}, angles.y) *
         rotation_about({0.0, 0.0, 1.0}, angles.z);
}

std::int32_t JointModel::find_coordinate(std::string_view name) const {
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (coordinates[i].name == name) return static_cast<std::int32_t>(i);
  }
  return -1;
}

std::vector<JointFault> finish_joint_model(JointModel& model, std::vector<std::string> bones) {
  assert(!bones.empty() && model.bodies.size() == bones.size());
  std::vector<JointFault> faults;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    Joint& joint = model.joints[j];
    if (!find_directions(joint.rotations) || !find_directions(joint.translations)) {
      faults.push_back({JointFault::At::kJoint, j, fmt::format("an axis of the joint '{}' has no length", joint.name),
                        "give it a direction, such as 1 0 0"});
    }
    joint.parent_frame = {rotation_from_xyz(joint.parent_orientation), joint.parent_translation};
    joint.child_frame_inverse = inverse({rotation_from_xyz(joint.child_orientation), joint.child_translation});
  }
  find_coupling_circles(model, faults);
  const std::vector<std::int32_t> joint_of = joints_of_bones(model, bones, faults);
  if (!faults.empty()) return faults;
  const std::vector<std::int32_t> order = parents_first(model, joint_of, bones, faults);
  if (!faults.empty()) return faults;

  const std::size_t count = bones.size();
  std::vector<std::int32_t> renumbered(count);
  for (std::size_t b = 0; b < count; ++b) renumbered[static_cast<std::size_t>(order[b])] = static_cast<std::int32_t>(b);
  Skeleton skeleton;
  std::vector<Joint> joints;
  std::vector<BodyInertia> bodies;
  for (const std::int32_t old : order) {
    skeleton.names.push_back(bones[static_cast<std::size_t>(old)]);
    bodies.push_back(model.bodies[static_cast<std::size_t>(old)]);
    if (old == 0) {
      skeleton.parents.push_back(-1);
      continue;
    }
    Joint joint = model.joints[static_cast<std::size_t>(joint_of[static_cast<std::size_t>(old)])];
    joint.parent = renumbered[static_cast<std::size_t>(joint.parent)];
    joint.child = renumbered[static_cast<std::size_t>(joint.child)];
    skeleton.parents.push_back(joint.parent);
    joints.push_back(std::move(joint));
  }
  model.joints = std::move(joints);
  model.bodies = std::move(bodies);

  const std::vector<double> defaults = default_coordinates(model);
  skeleton.rest_local.resize(count);
  skeleton.rest_world.resize(count);
  for (std::size_t b = 0; b < count; ++b) {
    const Trs local = to_trs(b == 0 ? axis_change() : evaluate_joint(model, defaults, b - 1));
    if (!is_finite(local)) {
      faults.push_back({JointFault::At::kBone, static_cast<std::size_t>(order[b]),
                        fmt::format("the pose of '{}' is not finite at the coordinates' defaults", skeleton.names[b]),
                        "look for very large numbers in its joint"});
    }
    skeleton.rest_local[b] = local;
  }
  const std::vector<RigidTransform> world = evaluate_bones(model, defaults);
  for (std::size_t b = 0; b < count; ++b) {
    glm::mat4 matrix = glm::mat4(glm::mat3(world[b].rotation));
    matrix[3] = glm::vec4(glm::vec3(world[b].translation), 1.0f);
    skeleton.rest_world[b] = matrix;
  }
  model.skeleton = std::make_shared<const Skeleton>(std::move(skeleton));
  return faults;
}

double coordinate_value(const JointModel& model, std::span<const double> values, std::size_t index) {
  const JointCoordinate& coordinate = model.coordinates[index];
  double value = values[index];
  if (coordinate.driver >= 0) {
    value = coordinate.coupling(coordinate_value(model, values, static_cast<std::size_t>(coordinate.driver)));
  } else if (coordinate.locked) {
    value = coordinate.default_value;
  } else if (coordinate.clamped) {
    value = std::clamp(value, coordinate.minimum, coordinate.maximum);
  }
  return std::isfinite(value) ? value : coordinate.default_value;
}

RigidTransform evaluate_joint(const JointModel& model, std::span<const double> values, std::size_t index) {
  const Joint& joint = model.joints[index];
  RigidTransform moved;
  for (const JointAxis& axis : joint.rotations) {
    moved.rotation = moved.rotation * rotation_about(axis.direction, axis_value(model, values, axis));
  }
  for (const JointAxis& axis : joint.translations)
    moved.translation += axis_value(model, values, axis) * axis.direction;
  return joint.parent_frame * moved * joint.child_frame_inverse;
}

std::vector<RigidTransform> evaluate_bones(const JointModel& model, std::span<const double> values) {
  assert(values.size() == model.coordinates.size());
  std::vector<RigidTransform> world(model.joints.size() + 1);
  world[0] = axis_change();
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    world[j + 1] = world[static_cast<std::size_t>(model.joints[j].parent)] * evaluate_joint(model, values, j);
  }
  return world;
}

void pose_joints(const JointModel& model, std::span<const double> values, std::span<Trs> local) {
  assert(values.size() == model.coordinates.size() && local.size() == model.joints.size() + 1);
  const Skeleton& skeleton = *model.skeleton;
  local[0] = skeleton.rest_local[0];
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const Trs pose = to_trs(evaluate_joint(model, values, j));
    local[j + 1] = is_finite(pose) ? pose : skeleton.rest_local[j + 1];
  }
}

std::vector<double> default_coordinates(const JointModel& model) {
  std::vector<double> values;
  for (const JointCoordinate& coordinate : model.coordinates) values.push_back(coordinate.default_value);
  return values;
}

}  // namespace fascicle
