// Writes a joint model in the form of character files (content/schema/joints.schema.json). What is read back evaluates
// to the same bits: numbers are written in their shortest form that reads back exactly.
#pragma once

#include <span>
#include <string>

#include "engine/animation/joint_model.hpp"

namespace fascicle {

// The object, every line but the first indented by `indent` spaces more; no line break at the end.
std::string write_joint_model(const JointModel& model, int indent);

// "0.2", and "[0.1, 0, -3]": finite numbers in their shortest exact form.
std::string json_number(double value);
std::string json_list(std::span<const double> values);
std::string json_list(const glm::dvec3& vector);

}  // namespace fascicle
