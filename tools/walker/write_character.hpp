// The walker's character file, from the muscle table.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/walker/muscle_table.hpp"

namespace fascicle::walker {

// False where the file cannot be written.
bool write_character(const std::filesystem::path& file, const std::vector<MuscleSpec>& muscles);

}  // namespace fascicle::walker
