// What the subcommands share: finding a character by name, and saying what is wrong.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/content/result.hpp"

namespace fascicle::cook {

// A character's file from its name in the content folder ("walker"), or from a path. Errors: there is none; the nearest
// name is suggested.
Result<std::filesystem::path> find_character(const std::string& name_or_path);

// What read_mesh takes, where the input names a mesh file (`data:` in front stands for the data folder) rather than a
// character.
std::optional<std::string> as_mesh_reference(const std::string& input);

// The names of kLengthUnits, for options.
std::vector<std::string> length_unit_names();

// Errors and warnings, a line each, to the error stream.
void print_diagnostics(const Diagnostics& diagnostics);

}  // namespace fascicle::cook
