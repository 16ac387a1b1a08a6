// OpenSim motion and storage files (.mot, .sto): a header of `name=value` lines up to `endheader`, a line of column
// names, then a row of numbers a sample.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/animation/motion.hpp"
#include "engine/content/result.hpp"

namespace fascicle {

struct JointModel;

// Reads a motion for `model`. Columns are matched to coordinates by name, or by OpenSim's paths
// ("/jointset/hip_r/hip_flexion_r/value"; its speeds are left out). With `inDegrees=yes` rotational coordinates are
// converted to radians, and only these. Warnings: columns that are no coordinate of the model, coordinates without a
// column (they keep their defaults), row or column counts that the header states wrongly, no inDegrees (taken as no).
// Errors, each with its line: no header, no column `time` in front, no known column, a name twice, rows with too few or
// too many values, values that aren't finite numbers, times that do not rise, vectors (DataType other than double).
Result<Motion> read_motion(const std::filesystem::path& file, const JointModel& model);
Result<Motion> parse_motion(std::string_view text, const std::string& file_name, const JointModel& model);

}  // namespace fascicle
