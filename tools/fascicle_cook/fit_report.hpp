// What a fit did, for authors: as a table, a section a line, and as JSON.
#pragma once

#include <string>
#include <vector>

#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::cook {

// A character's muscles that have a mesh, fitted at their finest level, and how far the result is from the meshes.
struct FitReport {
  const muscle::CharacterAsset* character = nullptr;
  std::vector<std::size_t> muscles;               // indices of descriptions
  std::vector<muscle::FitComparison> comparisons;  // one each
};

// Compares every fitted muscle with its mesh; `only`: a muscle's name, or empty for all.
FitReport make_fit_report(const muscle::CharacterAsset& character, const std::string& only);

// A line a muscle, and a sum.
std::string to_table(const FitReport& report);
// A line a section of the muscles in the report.
std::string to_section_table(const FitReport& report);
std::string to_json(const FitReport& report);

}  // namespace fascicle::cook
