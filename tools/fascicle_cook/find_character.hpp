// What the subcommands share: finding a character by name, and saying what is wrong.
#pragma once

#include <filesystem>
#include <string>

#include "engine/content/result.hpp"

namespace fascicle::cook {

// A character's file from its name in the content folder ("walker"), or from a path. Errors: there is none; the nearest
// name is suggested.
Result<std::filesystem::path> find_character(const std::string& name_or_path);

// Errors and warnings, a line each, to the error stream.
void print_diagnostics(const Diagnostics& diagnostics);

}  // namespace fascicle::cook
