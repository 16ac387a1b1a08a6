#include "engine/animation/joint_model_reader.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "engine/content/closest_name.hpp"

namespace fascicle {
namespace {

constexpr NumberRange kSane = between(-1e9, 1e9);
constexpr std::size_t kMostBodies = 4096;

bool read_vector(const JsonNode& node, glm::dvec3& out, Diagnostics& diagnostics) {
  std::vector<double> values;
  if (!node.exists() || !node.read(values, diagnostics, kSane)) return false;
  if (values.size() != 3) {
    node.error(diagnostics, fmt::format("{} numbers", values.size()), "give three: x, y, z");
    return false;
  }
  out = {values[0], values[1], values[2]};
  return true;
}

class JointModelReader {
 public:
  explicit JointModelReader(const JsonNode& node) : node_(node) {}

  Result<JointModel> read() {
    JsonObject object(node_, diagnostics_);
    std::string ground = "ground";
    object.optional("ground", ground);
    bones_.push_back(ground);
    bone_nodes_.push_back(node_);
    model_.bodies.emplace_back();
    for (const JsonNode body : object.require_array("bodies", 0, kMostBodies)) read_body(body);
    const JsonNode coordinates = object.require_array("coordinates", 0, kMostBodies);
    for (const JsonNode coordinate : coordinates) read_coordinate(coordinate);
    for (const JsonNode coordinate : coordinates) read_coupling(coordinate);
    for (const JsonNode joint : object.require_array("joints", 0, kMostBodies)) read_joint(joint);
    object.finish();
    if (!diagnostics_.ok()) return std::move(diagnostics_);
    for (const JointFault& fault : finish_joint_model(model_, bones_)) {
      const auto& nodes = fault.at == JointFault::At::kBone    ? bone_nodes_
                          : fault.at == JointFault::At::kJoint ? joint_nodes_
                                                               : coordinate_nodes_;
      nodes[fault.index].error(diagnostics_, fault.cause, fault.remedy);
    }
    if (!diagnostics_.ok()) return std::move(diagnostics_);
    return Result<JointModel>(std::move(model_), std::move(diagnostics_));
  }

 private:
  void read_body(const JsonNode& node) {
    JsonObject object(node, diagnostics_);
    std::string name;
    BodyInertia body;
    object.require("name", name);
    object.optional("mass", body.mass, at_least(0.0));
    read_vector(object.optional("mass_center"), body.mass_center, diagnostics_);
    std::vector<double> inertia;
    if (const JsonNode found = object.optional("inertia"); found.exists() && found.read(inertia, diagnostics_, kSane)) {
      if (inertia.size() == 6) {
        std::copy(inertia.begin(), inertia.end(), body.inertia.begin());
      } else {
        found.error(diagnostics_, fmt::format("{} numbers", inertia.size()), "give six: xx, yy, zz, xy, xz, yz");
      }
    }
    object.finish();
    if (std::find(bones_.begin(), bones_.end(), name) != bones_.end()) {
      node.error(diagnostics_, fmt::format("the body '{}' is there already", name), "give each body its own name");
    }
    bones_.push_back(name);
    bone_nodes_.push_back(node);
    model_.bodies.push_back(body);
  }

  void read_coordinate(const JsonNode& node) {
    JsonObject object(node, diagnostics_);
    JointCoordinate coordinate;
    object.require("name", coordinate.name);
    std::size_t kind = 0;
    object.optional_choice("kind", kind, {"rotation", "translation", "coupled"});
    coordinate.kind = static_cast<JointCoordinate::Kind>(kind);
    const JsonNode default_node = object.optional("default");
    const bool default_known =
        !default_node.exists() || default_node.read(coordinate.default_value, diagnostics_, kSane);
    std::vector<double> range;
    const JsonNode range_node = object.require("range");
    bool range_known = range_node.exists() && range_node.read(range, diagnostics_, kSane);
    if (range_known && (range.size() != 2 || range[0] > range[1])) {
      range_node.error(diagnostics_, "this is not a range", "give two numbers, the smaller first");
      range_known = false;
    }
    if (range_known) {
      coordinate.minimum = range[0];
      coordinate.maximum = range[1];
    }
    object.optional("clamped", coordinate.clamped);
    // The rest pose is built at the defaults: one that the clamp would move is never the pose of the joint.
    if (coordinate.clamped && default_known && range_known &&
        (coordinate.default_value < range[0] || coordinate.default_value > range[1])) {
      (default_node.exists() ? default_node : range_node)
          .error(diagnostics_,
                 fmt::format("the default {} of a clamped coordinate lies outside its range, {} to {}",
                             coordinate.default_value, range[0], range[1]),
                 default_node.exists() ? "give a default in the range, widen the range, or leave out \"clamped\""
                                       : "give a \"default\" in the range (left out: 0), or leave out \"clamped\"");
    }
    object.optional("locked", coordinate.locked);
    object.optional("coupled_to");
    object.finish();
    if (model_.find_coordinate(coordinate.name) >= 0) {
      node.error(diagnostics_, fmt::format("the coordinate '{}' is there already", coordinate.name),
                 "give each coordinate its own name");
    }
    model_.coordinates.push_back(std::move(coordinate));
    coordinate_nodes_.push_back(node);
    coordinate_names_.push_back(model_.coordinates.back().name);
  }

  void read_coupling(const JsonNode& node) {
    const JsonNode coupling = node.member("coupled_to");
    if (!coupling.exists()) return;
    JsonObject object(coupling, diagnostics_);
    const auto index = static_cast<std::size_t>(std::find(coordinate_nodes_.begin(), coordinate_nodes_.end(), node) -
                                                coordinate_nodes_.begin());
    JointCoordinate& coordinate = model_.coordinates[index];
    coordinate.driver = read_coordinate_name(object.require("coordinate"));
    read_function(object.require("function"), coordinate.coupling);
    object.finish();
  }

  void read_joint(const JsonNode& node) {
    JsonObject object(node, diagnostics_);
    Joint joint;
    object.require("name", joint.name);
    joint.parent = read_bone_name(object.require("parent"));
    joint.child = read_bone_name(object.require("child"));
    read_frame(object.optional("parent_frame"), joint.parent_translation, joint.parent_orientation);
    read_frame(object.optional("child_frame"), joint.child_translation, joint.child_orientation);
    for (const JsonNode axis : object.optional_array("rotations", 0, 3)) joint.rotations.push_back(read_axis(axis));
    for (const JsonNode axis : object.optional_array("translations", 0, 3))
      joint.translations.push_back(read_axis(axis));
    object.finish();
    model_.joints.push_back(std::move(joint));
    joint_nodes_.push_back(node);
  }

  void read_frame(const JsonNode& node, glm::dvec3& translation, glm::dvec3& orientation) {
    if (!node.exists()) return;
    JsonObject object(node, diagnostics_);
    read_vector(object.optional("translation"), translation, diagnostics_);
    read_vector(object.optional("orientation"), orientation, diagnostics_);
    object.finish();
  }

  JointAxis read_axis(const JsonNode& node) {
    JsonObject object(node, diagnostics_);
    JointAxis axis;
    read_vector(object.require("axis"), axis.axis, diagnostics_);
    if (const JsonNode name = object.optional("coordinate"); name.exists()) {
      axis.coordinate = read_coordinate_name(name);
      axis.function = ScalarFunction::linear(1.0, 0.0);
    }
    if (const JsonNode function = object.optional("function"); function.exists()) {
      read_function(function, axis.function);
    } else if (axis.coordinate < 0 && object.valid()) {
      node.error(diagnostics_, "an axis with neither a coordinate nor a function",
                 "name a coordinate, or leave the axis out");
    }
    object.finish();
    return axis;
  }

  void read_function(const JsonNode& node, ScalarFunction& out) {
    if (!node.exists()) return;
    if (node.is_number()) {
      double value = 0.0;
      if (node.read(value, diagnostics_, kSane)) out = ScalarFunction::constant(value);
      return;
    }
    JsonObject object(node, diagnostics_);
    if (!object.valid()) return;
    const JsonNode linear = object.optional("linear");
    const JsonNode polynomial = object.optional("polynomial");
    const JsonNode spline = object.optional("spline");
    const JsonNode pieces = object.optional("piecewise_linear");
    object.finish();
    if (linear.exists() + polynomial.exists() + spline.exists() + pieces.exists() != 1) {
      node.error(diagnostics_, "a function is a number or has one of linear, polynomial, spline, piecewise_linear",
                 "give exactly one of them");
      return;
    }
    std::vector<double> values;
    if (linear.exists() && linear.read(values, diagnostics_, kSane)) {
      if (values.size() == 2) {
        out = ScalarFunction::linear(values[0], values[1]);
      } else {
        linear.error(diagnostics_, fmt::format("{} numbers", values.size()), "give two: slope, value at 0");
      }
    }
    if (polynomial.exists() && polynomial.read(values, diagnostics_, kSane)) {
      if (!values.empty() && values.size() <= 32) {
        out = ScalarFunction::polynomial(values);
      } else {
        polynomial.error(diagnostics_, fmt::format("{} coefficients", values.size()),
                         "give 1 to 32, the highest power first");
      }
    }
    if (spline.exists()) read_knots(spline, true, out);
    if (pieces.exists()) read_knots(pieces, false, out);
  }

  void read_knots(const JsonNode& node, bool smooth, ScalarFunction& out) {
    JsonObject object(node, diagnostics_);
    std::vector<double> x;
    std::vector<double> y;
    const bool read_x = object.require("x", x);
    const bool read_y = object.require("y", y);
    object.finish();
    if (!read_x || !read_y) return;
    if (const std::string fault = fault_of_knots(x, y); !fault.empty()) {
      node.error(diagnostics_, fault, "give at least two points, x rising, as many y as x");
      return;
    }
    out = smooth ? ScalarFunction::spline(std::move(x), std::move(y))
                 : ScalarFunction::piecewise_linear(std::move(x), std::move(y));
  }

  std::int32_t read_coordinate_name(const JsonNode& node) {
    std::string name;
    if (!node.exists() || !node.read(name, diagnostics_)) return -1;
    const std::int32_t index = model_.find_coordinate(name);
    if (index < 0) {
      node.error(diagnostics_, fmt::format("unknown coordinate '{}'", name),
                 suggest_name(name, coordinate_names_, "coordinates"));
    }
    return index;
  }

  // 0, the ground, where it is wrong; an error has then been appended.
  std::int32_t read_bone_name(const JsonNode& node) {
    std::string name;
    if (!node.exists() || !node.read(name, diagnostics_)) return 0;
    const auto found = std::find(bones_.begin(), bones_.end(), name);
    if (found != bones_.end()) return static_cast<std::int32_t>(found - bones_.begin());
    node.error(diagnostics_, fmt::format("unknown body '{}'", name), suggest_name(name, bones_, "bodies"));
    return 0;
  }

  JsonNode node_;
  Diagnostics diagnostics_;
  JointModel model_;
  std::vector<std::string> bones_;
  std::vector<std::string> coordinate_names_;
  std::vector<JsonNode> bone_nodes_;
  std::vector<JsonNode> joint_nodes_;
  std::vector<JsonNode> coordinate_nodes_;
};

}  // namespace

Result<JointModel> read_joint_model(const JsonNode& node) { return JointModelReader(node).read(); }

}  // namespace fascicle
