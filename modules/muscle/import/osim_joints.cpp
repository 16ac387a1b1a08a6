#include "modules/muscle/import/osim_joints.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "engine/content/closest_name.hpp"
#include "modules/muscle/import/osim_functions.hpp"

namespace fascicle::muscle {
namespace {

// A joint type as OpenSim builds it: which axis each coordinate moves, in order. X, Y, Z turn; x, y, z shift.
struct JointType {
  std::string_view name;
  std::string_view axes;
};
constexpr std::array kJointTypes{
    JointType{"WeldJoint", ""},      JointType{"PinJoint", "Z"},        JointType{"SliderJoint", "x"},
    JointType{"BallJoint", "XYZ"},   JointType{"GimbalJoint", "XYZ"},   JointType{"UniversalJoint", "XY"},
    JointType{"PlanarJoint", "Zxy"}, JointType{"FreeJoint", "XYZxyz"},
};

class JointsReader {
 public:
  JointsReader(XmlFields& fields, pugi::xml_node model, OsimFrames& frames, JointModel& joints)
      : fields_(fields), model_(model), frames_(frames), joints_(joints) {}

  void read() {
    read_bodies();
    const std::vector<pugi::xml_node> nodes = elements(model_.child("JointSet").child("objects"));
    for (const pugi::xml_node node : nodes) read_coordinates(node);
    for (const pugi::xml_node node : nodes) read_joint(node);
    for (const pugi::xml_node node : elements(model_.child("ConstraintSet").child("objects"))) read_constraint(node);
    weld_loose_bodies();
    if (!fields_.diagnostics.ok()) return;
    for (const JointFault& fault : finish_joint_model(joints_, frames_.bodies())) {
      const auto& places = fault.at == JointFault::At::kBone    ? frames_.body_nodes()
                           : fault.at == JointFault::At::kJoint ? joint_nodes_
                                                                : coordinate_nodes_;
      fields_.error(places[fault.index], fault.cause, fault.remedy);
    }
  }

 private:
  void read_bodies() {
    joints_.bodies.emplace_back();
    for (std::size_t b = 1; b < frames_.bodies().size(); ++b) {
      const pugi::xml_node node = frames_.body_nodes()[b];
      BodyInertia body;
      fields_.number_in(node, "mass", 0.0, 1e9, body.mass);
      fields_.vector(node, "mass_center", body.mass_center);
      std::vector<double> inertia(6, 0.0);
      if (fields_.numbers(node, "inertia", 6, inertia)) std::copy(inertia.begin(), inertia.end(), body.inertia.begin());
      joints_.bodies.push_back(body);
    }
  }

  void read_coordinates(pugi::xml_node joint) {
    pugi::xml_node parent = joint.child("coordinates");
    if (const pugi::xml_node objects = parent.child("objects")) parent = objects;
    for (const pugi::xml_node node : elements(parent)) {
      if (std::string_view(node.name()) != "Coordinate") continue;
      JointCoordinate coordinate;
      coordinate.name = name_of(node);
      coordinate.kind = JointCoordinate::Kind::kCoupled;
      std::vector<double> range{-10.0, 10.0};  // OpenSim's default
      bool prescribed = false;
      fields_.number(node, "default_value", coordinate.default_value);
      fields_.boolean(node, "clamped", coordinate.clamped);
      fields_.boolean(node, "locked", coordinate.locked);
      fields_.boolean(node, "prescribed", prescribed);
      if (fields_.numbers(node, "range", 2, range) && range[0] > range[1]) {
        fields_.error(node.child("range"), fmt::format("the range {} to {} is empty", range[0], range[1]),
                      "give the smaller value first");
        range[1] = range[0];
      }
      coordinate.minimum = range[0];
      coordinate.maximum = range[1];
      if (coordinate.name.empty() || joints_.find_coordinate(coordinate.name) >= 0) {
        fields_.error(node,
                      coordinate.name.empty() ? "a coordinate without a name"
                                              : fmt::format("the coordinate '{}' is there already", coordinate.name),
                      "give each coordinate its own name");
      }
      if (prescribed) {
        fields_.warning(
            node, fmt::format("the coordinate '{}' is prescribed by a function, which is left out", coordinate.name),
            "drive it by a motion");
      }
      joints_.coordinates.push_back(std::move(coordinate));
      coordinate_nodes_.push_back(node);
    }
  }

  void read_joint(pugi::xml_node node) {
    Joint joint;
    joint.name = name_of(node);
    for (std::size_t j = 0; j < joints_.joints.size(); ++j) {
      if (joints_.joints[j].name != joint.name) continue;
      fields_.error(node, fmt::format("the joint '{}' is there already", joint.name), "give each joint its own name");
      break;
    }
    const std::string path = "/jointset/" + joint.name;
    const auto parent = resolve_frame(node, "socket_parent_frame", path);
    const auto child = resolve_frame(node, "socket_child_frame", path);
    read_motion_axes(node, joint);
    if (!parent || !child) return;
    joint.parent = parent->body;
    joint.parent_translation = parent->translation;
    joint.parent_orientation = parent->orientation;
    joint.child = child->body;
    joint.child_translation = child->translation;
    joint.child_orientation = child->orientation;
    joints_.joints.push_back(std::move(joint));
    joint_nodes_.push_back(node);
  }

  std::optional<OsimFrame> resolve_frame(pugi::xml_node joint, const char* socket, const std::string& path) {
    const pugi::xml_node node = joint.child(socket);
    if (node) return frames_.resolve(node, path);
    fields_.error(joint, fmt::format("the joint '{}' has no {}", name_of(joint), socket),
                  "name the frame that it joins");
    return std::nullopt;
  }

  void read_motion_axes(pugi::xml_node node, Joint& joint) {
    const std::string_view type = node.name();
    if (type == "CustomJoint") return read_spatial_transform(node, joint);
    for (const JointType& known : kJointTypes) {
      if (type != known.name) continue;
      std::vector<std::int32_t> own;
      for (std::size_t c = 0; c < coordinate_nodes_.size(); ++c) {
        if (joint_of(coordinate_nodes_[c]) == node) own.push_back(static_cast<std::int32_t>(c));
      }
      if (own.size() != known.axes.size()) {
        fields_.error(node, fmt::format("a {} with {} coordinates", type, own.size()),
                      fmt::format("give {}", known.axes.size()));
        return;
      }
      for (std::size_t i = 0; i < own.size(); ++i) add_axis(known.axes[i], own[i], joint);
      return;
    }
    fields_.error(node, fmt::format("the joint type {} is not supported", type),
                  "use a Pin, Slider, Weld, Ball, Gimbal, Universal, Planar, Free or Custom joint");
  }

  // The joint element that a coordinate stands in, through <coordinates> and perhaps <objects>.
  static pugi::xml_node joint_of(pugi::xml_node coordinate) {
    pugi::xml_node parent = coordinate.parent();
    if (std::string_view(parent.name()) == "objects") parent = parent.parent();
    return parent.parent();
  }

  void add_axis(char axis, std::int32_t coordinate, Joint& joint) {
    const bool turns = axis <= 'Z';
    const int k = turns ? axis - 'X' : axis - 'x';
    JointAxis result;
    result.axis = glm::dvec3(k == 0, k == 1, k == 2);
    result.coordinate = coordinate;
    result.function = ScalarFunction::linear(1.0, 0.0);
    auto& known = joints_.coordinates[static_cast<std::size_t>(coordinate)];
    known.kind = turns ? JointCoordinate::Kind::kRotation : JointCoordinate::Kind::kTranslation;
    (turns ? joint.rotations : joint.translations).push_back(std::move(result));
  }

  void read_spatial_transform(pugi::xml_node node, Joint& joint) {
    const pugi::xml_node transform = node.child("SpatialTransform");
    std::vector<pugi::xml_node> axes;
    for (const pugi::xml_node axis : elements(transform)) {
      if (std::string_view(axis.name()) == "TransformAxis") axes.push_back(axis);
    }
    if (axes.size() != 6) {
      fields_.error(transform ? transform : node, fmt::format("the SpatialTransform has {} axes", axes.size()),
                    "give six TransformAxis: three rotations, then three translations");
      return;
    }
    for (std::size_t i = 0; i < 6; ++i) {
      JointAxis axis;
      axis.axis = glm::dvec3(i % 3 == 0, i % 3 == 1, i % 3 == 2);
      fields_.vector(axes[i], "axis", axis.axis);
      const std::vector<std::string> names = split_words(axes[i].child_value("coordinates"));
      if (names.size() > 1) {
        fields_.error(axes[i], "an axis that depends on several coordinates", "name one coordinate");
        continue;
      }
      if (!names.empty())
        axis.coordinate = find_osim_coordinate(fields_, axes[i].child("coordinates"), names[0], joints_);
      const pugi::xml_node function = find_function(axes[i], "function");
      if (function) {
        read_function(fields_, function, axis.function);
      } else if (!names.empty()) {
        fields_.error(axes[i], fmt::format("the axis depends on '{}' but has no function", names[0]),
                      "add one, such as a LinearFunction with coefficients 1 0");
      }
      if (axis.coordinate >= 0) note_kind(joints_.coordinates[static_cast<std::size_t>(axis.coordinate)], axis, i < 3);
      // A constant axis that stays at 0 is no axis.
      if (!axis.function.is_zero()) (i < 3 ? joint.rotations : joint.translations).push_back(std::move(axis));
    }
  }

  // OpenSim calls a coordinate rotational or translational where it moves an axis one to one; the first such decides.
  static void note_kind(JointCoordinate& coordinate, const JointAxis& axis, bool turns) {
    const bool one_to_one = axis.function.kind() == ScalarFunction::Kind::kLinear &&
                            axis.function.coefficients()[0] == 1.0 && axis.function.coefficients()[1] == 0.0;
    if (coordinate.kind != JointCoordinate::Kind::kCoupled || !one_to_one) return;
    coordinate.kind = turns ? JointCoordinate::Kind::kRotation : JointCoordinate::Kind::kTranslation;
  }

  void read_constraint(pugi::xml_node node) {
    bool enforced = true;
    fields_.boolean(node, "isEnforced", enforced);
    if (!enforced) return;
    if (std::string_view(node.name()) != "CoordinateCouplerConstraint") {
      fields_.warning(node, fmt::format("the {} '{}' is left out", node.name(), name_of(node)),
                      "only CoordinateCouplerConstraint is supported");
      return;
    }
    const std::vector<std::string> drivers = split_words(node.child_value("independent_coordinate_names"));
    if (drivers.size() != 1) {
      fields_.error(node, fmt::format("a coupling with {} independent coordinates", drivers.size()), "name one");
      return;
    }
    const std::int32_t driver =
        find_osim_coordinate(fields_, node.child("independent_coordinate_names"), drivers[0], joints_);
    const pugi::xml_node dependent_node = node.child("dependent_coordinate_name");
    const std::int32_t dependent = find_osim_coordinate(
        fields_, dependent_node ? dependent_node : node, child_text(node, "dependent_coordinate_name"), joints_);
    const pugi::xml_node function = find_function(node, "coupled_coordinates_function");
    ScalarFunction coupling;
    double scale = 1.0;
    fields_.number(node, "scale_factor", scale);
    if (!function) {
      fields_.error(node, "a coupling without a function", "add coupled_coordinates_function");
      return;
    }
    if (!read_function(fields_, function, coupling) || driver < 0 || dependent < 0) return;
    JointCoordinate& coordinate = joints_.coordinates[static_cast<std::size_t>(dependent)];
    if (coordinate.driver >= 0) {
      fields_.error(node, fmt::format("the coordinate '{}' is coupled twice", coordinate.name), "keep one coupling");
      return;
    }
    coordinate.driver = driver;
    coordinate.coupling = coupling.scaled(scale);
  }

  void weld_loose_bodies() {
    if (!fields_.diagnostics.ok()) return;  // a joint that could not be read would make its body look loose
    std::vector<bool> joined(frames_.bodies().size(), false);
    for (const Joint& joint : joints_.joints) joined[static_cast<std::size_t>(joint.child)] = true;
    for (std::size_t b = 1; b < joined.size(); ++b) {
      if (joined[b]) continue;
      fields_.warning(frames_.body_nodes()[b],
                      fmt::format("the body '{}' has no joint; it is fixed to the ground", frames_.bodies()[b]),
                      "add a joint whose child it is");
      Joint joint;
      joint.name = frames_.bodies()[b] + "_to_ground";
      joint.parent = 0;
      joint.child = static_cast<std::int32_t>(b);
      joints_.joints.push_back(std::move(joint));
      joint_nodes_.push_back(frames_.body_nodes()[b]);
    }
  }

  XmlFields& fields_;
  pugi::xml_node model_;
  OsimFrames& frames_;
  JointModel& joints_;
  std::vector<pugi::xml_node> joint_nodes_;
  std::vector<pugi::xml_node> coordinate_nodes_;
};

}  // namespace

void read_osim_joints(XmlFields& fields, pugi::xml_node model, OsimFrames& frames, JointModel& joints) {
  JointsReader(fields, model, frames, joints).read();
}

std::int32_t find_osim_coordinate(XmlFields& fields, pugi::xml_node at, const std::string& text,
                                  const JointModel& joints) {
  const std::string name = text.substr(text.rfind('/') + 1);
  const std::int32_t coordinate = joints.find_coordinate(name);
  if (coordinate >= 0) return coordinate;
  std::vector<std::string> known;
  for (const JointCoordinate& each : joints.coordinates) known.push_back(each.name);
  fields.error(at, fmt::format("there is no coordinate '{}'", name), suggest_name(name, known, "coordinates"));
  return -1;
}

}  // namespace fascicle::muscle
