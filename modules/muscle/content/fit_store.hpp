// Fits kept beside a character file, so that loading need not fit again: NAME.fit.json next to NAME.character.json,
// written by `fascicle-cook fit`, JSON as the rest of content. Each muscle's entry carries a hash of everything that
// its fit depends on; an entry whose hash is another is out of date and not used. The file may be lost or broken at no
// harm: muscles are then fitted at load.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/fit/fit_muscles.hpp"

namespace fascicle::muscle {

// One muscle at one level of detail.
struct FittedLevel {
  std::uint32_t section_vertices = 0;           // |C|
  std::uint32_t longitudinal_subdivision = 0;   // LSS
  FittedMuscle fitted;                          // its fit is empty where the muscle keeps its unfitted shape
};

// One muscle at all of its character's levels, finest first.
struct MuscleFits {
  std::uint64_t inputs = 0;  // hash of what was fitted, and how
  std::vector<FittedLevel> levels;
};

// The sections as the elements of a JSON array; lengths in m.
void append_json(std::span<const SectionReport> sections, std::string& out);

using FitStore = std::map<std::string, MuscleFits>;  // by the muscle's name

// The file that holds the fits of a character file: the same name with .fit.json in place of .character.json or .json.
std::filesystem::path fit_store_of(const std::filesystem::path& character_file);

// Errors: not JSON, another version, a field missing or wrong, counts that don't agree.
Result<FitStore> parse_fit_store(std::string text, std::string file_name);
Result<FitStore> read_fit_store(const std::filesystem::path& file);

// Numbers are written so that they come back bit for bit.
std::string write_fit_store(const FitStore& store);

}  // namespace fascicle::muscle
