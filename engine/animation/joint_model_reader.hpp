// Joint models in character files: `"skeleton": { "joints": { ... } }`. content/schema/joints.schema.json documents
// every field; joint_model_writer.hpp writes the same form.
#pragma once

#include "engine/animation/joint_model.hpp"
#include "engine/content/json_reader.hpp"
#include "engine/content/result.hpp"

namespace fascicle {

// Reads the object {"ground", "bodies", "coordinates", "joints"}. Errors: missing or unknown fields, unknown bodies and
// coordinates (with the nearest known name), names twice, a body with no joint or two, joints or couplings in a circle,
// axes of no length, knots that do not rise, a range that is empty or leaves the default out where it is clamped.
Result<JointModel> read_joint_model(const JsonNode& node);

}  // namespace fascicle
