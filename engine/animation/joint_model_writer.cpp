#include "engine/animation/joint_model_writer.hpp"

#include <span>

#include <fmt/format.h>

#include "engine/content/quote_json.hpp"

namespace fascicle {

std::string json_number(double value) { return fmt::format("{}", value == 0.0 ? 0.0 : value); }  // no "-0"

std::string json_list(std::span<const double> values) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) text += (i == 0 ? "" : ", ") + json_number(values[i]);
  return text + "]";
}

std::string json_list(const glm::dvec3& vector) {
  return fmt::format("[{}, {}, {}]", json_number(vector.x), json_number(vector.y), json_number(vector.z));
}

namespace {

std::string function_text(const ScalarFunction& function) {
  const auto knots = [&](const char* kind) {
    return fmt::format("{{ \"{}\": {{ \"x\": {},\n@\"y\": {} }} }}", kind, json_list(function.x()),
                       json_list(function.y()));
  };
  switch (function.kind()) {
    case ScalarFunction::Kind::kConstant:
      return json_number(function.coefficients()[0]);
    case ScalarFunction::Kind::kLinear:
      return fmt::format("{{ \"linear\": {} }}", json_list(function.coefficients()));
    case ScalarFunction::Kind::kPolynomial:
      return fmt::format("{{ \"polynomial\": {} }}", json_list(function.coefficients()));
    case ScalarFunction::Kind::kPiecewiseLinear:
      return knots("piecewise_linear");
    case ScalarFunction::Kind::kSpline:
      return knots("spline");
  }
  return {};
}

bool is_identity(const ScalarFunction& function) {
  return function.kind() == ScalarFunction::Kind::kLinear && function.coefficients()[0] == 1.0 &&
         function.coefficients()[1] == 0.0;
}

// Builds the text line by line; '@' after a line break stands for a continuation's indent.
class JointModelWriter {
 public:
  JointModelWriter(const JointModel& model, int indent) : model_(model), indent_(static_cast<std::size_t>(indent)) {}

  std::string write() {
    const Skeleton& skeleton = *model_.skeleton;
    text_.push_back('{');
    line(1, fmt::format("\"ground\": {},", quote_json(skeleton.names[0])));
    line(1, "\"bodies\": [");
    for (std::size_t b = 1; b < skeleton.size(); ++b) line(2, body(b) + comma(b + 1 == skeleton.size()));
    line(1, "],");
    line(1, "\"coordinates\": [");
    for (std::size_t c = 0; c < model_.coordinates.size(); ++c) {
      line(2, coordinate(model_.coordinates[c]) + comma(c + 1 == model_.coordinates.size()));
    }
    line(1, "],");
    line(1, "\"joints\": [");
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      write_joint(model_.joints[j]);
      text_ += comma(j + 1 == model_.joints.size());
    }
    line(1, "]");
    line(0, "}");
    return text_;
  }

 private:
  static const char* comma(bool last) { return last ? "" : ","; }

  void line(std::size_t depth, std::string content) {
    const std::string indent(indent_ + 2 * depth, ' ');
    for (std::size_t at = content.find('@'); at != std::string::npos; at = content.find('@', at)) {
      if (at == 0 || content[at - 1] != '\n') {
        ++at;
        continue;
      }
      content.replace(at, 1, indent + "    ");
    }
    text_ += "\n" + indent + content;
  }

  std::string body(std::size_t b) const {
    const BodyInertia& inertia = model_.bodies[b];
    std::string content = fmt::format("{{ \"name\": {}", quote_json(model_.skeleton->names[b]));
    if (inertia.mass != 0.0) content += fmt::format(", \"mass\": {}", json_number(inertia.mass));
    if (inertia.mass_center != glm::dvec3(0.0)) content += ", \"mass_center\": " + json_list(inertia.mass_center);
    if (inertia.inertia != std::array<double, 6>{}) content += ", \"inertia\": " + json_list(inertia.inertia);
    return content + " }";
  }

  std::string coordinate(const JointCoordinate& c) const {
    static constexpr const char* kKinds[] = {"rotation", "translation", "coupled"};
    std::string content = fmt::format("{{ \"name\": {}, \"kind\": \"{}\", \"default\": {}, \"range\": [{}, {}]",
                                      quote_json(c.name), kKinds[static_cast<std::size_t>(c.kind)],
                                      json_number(c.default_value), json_number(c.minimum), json_number(c.maximum));
    if (c.clamped) content += ", \"clamped\": true";
    if (c.locked) content += ", \"locked\": true";
    if (c.driver >= 0) {
      content += fmt::format(",\n@\"coupled_to\": {{ \"coordinate\": {}, \"function\": {} }}",
                             quote_json(model_.coordinates[static_cast<std::size_t>(c.driver)].name),
                             function_text(c.coupling));
    }
    return content + " }";
  }

  void write_joint(const Joint& joint) {
    const auto& names = model_.skeleton->names;
    line(2, fmt::format("{{ \"name\": {}, \"parent\": {}, \"child\": {}", quote_json(joint.name),
                        quote_json(names[static_cast<std::size_t>(joint.parent)]),
                        quote_json(names[static_cast<std::size_t>(joint.child)])));
    write_frame("parent_frame", joint.parent_translation, joint.parent_orientation);
    write_frame("child_frame", joint.child_translation, joint.child_orientation);
    write_axes("rotations", joint.rotations);
    write_axes("translations", joint.translations);
    text_ += " }";
  }

  void write_frame(const char* name, const glm::dvec3& translation, const glm::dvec3& orientation) {
    const bool moved = translation != glm::dvec3(0.0);
    const bool turned = orientation != glm::dvec3(0.0);
    if (!moved && !turned) return;
    std::string content;
    if (moved) content = "\"translation\": " + json_list(translation);
    if (turned) content += std::string(moved ? ", " : "") + "\"orientation\": " + json_list(orientation);
    text_ += ",";
    line(3, fmt::format("\"{}\": {{ {} }}", name, content));
  }

  // An axis that never moves is left out.
  void write_axes(const char* name, const std::vector<JointAxis>& axes) {
    std::vector<std::string> lines;
    for (const JointAxis& axis : axes) {
      if (axis.function.is_zero()) continue;
      std::string content = "{ \"axis\": " + json_list(axis.axis);
      if (axis.coordinate >= 0) {
        const JointCoordinate& driver = model_.coordinates[static_cast<std::size_t>(axis.coordinate)];
        content += ", \"coordinate\": " + quote_json(driver.name);
      }
      if (axis.coordinate < 0 || !is_identity(axis.function))
        content += ", \"function\": " + function_text(axis.function);
      lines.push_back(content + " }");
    }
    if (lines.empty()) return;
    text_ += ",";
    line(3, fmt::format("\"{}\": [", name));
    for (std::size_t i = 0; i < lines.size(); ++i) line(4, lines[i] + comma(i + 1 == lines.size()));
    text_ += " ]";
  }

  const JointModel& model_;
  std::size_t indent_;
  std::string text_;
};

}  // namespace

std::string write_joint_model(const JointModel& model, int indent) { return JointModelWriter(model, indent).write(); }

}  // namespace fascicle
