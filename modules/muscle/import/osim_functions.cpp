#include "modules/muscle/import/osim_functions.hpp"

#include <array>

#include <fmt/format.h>

namespace fascicle::muscle {
namespace {

constexpr int kDeepestNesting = 16;

// Everything by which OpenSim names a function, known here or not, so that an unknown one is told from a plain field.
bool is_function_name(std::string_view name) {
  const auto ends_with = [&](std::string_view end) {
    return name.size() >= end.size() && name.substr(name.size() - end.size()) == end;
  };
  return name == "Constant" || name == "Sine" || ends_with("Function") || ends_with("Spline");
}

bool read_nested(XmlFields& fields, pugi::xml_node node, int depth, ScalarFunction& out) {
  const std::string_view kind = node.name();
  std::vector<double> values;
  if (kind == "Constant") {
    double value = 0.0;
    if (!fields.number(node, "value", value)) return false;
    out = ScalarFunction::constant(value);
    return true;
  }
  if (kind == "LinearFunction") {
    values = {1.0, 0.0};
    if (!fields.numbers(node, "coefficients", 2, values)) return false;
    out = ScalarFunction::linear(values[0], values[1]);
    return true;
  }
  if (kind == "PolynomialFunction") {
    if (!fields.numbers(node, "coefficients", 0, values)) return false;
    if (values.empty() || values.size() > 32) {
      fields.error(node, fmt::format("{} coefficients", values.size()), "give 1 to 32, the highest power first");
      return false;
    }
    out = ScalarFunction::polynomial(values);
    return true;
  }
  if (kind == "SimmSpline" || kind == "NaturalCubicSpline" || kind == "natCubicSpline" ||
      kind == "PiecewiseLinearFunction") {
    std::vector<double> y;
    if (!fields.numbers(node, "x", 0, values) || !fields.numbers(node, "y", 0, y)) return false;
    if (const std::string fault = fault_of_knots(values, y); !fault.empty()) {
      fields.error(node, fault, "give at least two points, x rising, as many y as x");
      return false;
    }
    out = kind == "PiecewiseLinearFunction" ? ScalarFunction::piecewise_linear(std::move(values), std::move(y))
                                            : ScalarFunction::spline(std::move(values), std::move(y));
    return true;
  }
  if (kind == "MultiplierFunction") {
    double scale = 1.0;
    const pugi::xml_node inner = find_function(node, "function");
    if (!inner || depth >= kDeepestNesting) {
      fields.error(node, inner ? "functions are nested too deeply" : "a MultiplierFunction without a function",
                   "give it one function");
      return false;
    }
    if (!fields.number(node, "scale", scale) || !read_nested(fields, inner, depth + 1, out)) return false;
    out = out.scaled(scale);
    return true;
  }
  fields.error(
      node, fmt::format("the function {} is not supported", kind),
      "use Constant, LinearFunction, PolynomialFunction, PiecewiseLinearFunction, SimmSpline or MultiplierFunction; "
      "a SimmSpline through sampled values replaces most others");
  return false;
}

}  // namespace

pugi::xml_node find_function(pugi::xml_node owner, const char* wrapper) {
  for (const pugi::xml_node parent : std::array{owner.child(wrapper), owner}) {
    for (const pugi::xml_node child : parent.children()) {
      if (is_function_name(child.name())) return child;
    }
  }
  return {};
}

bool read_function(XmlFields& fields, pugi::xml_node node, ScalarFunction& out) {
  return read_nested(fields, node, 0, out);
}

}  // namespace fascicle::muscle
