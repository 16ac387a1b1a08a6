// A picture of fitted muscles for an author's eyes: the fitted surfaces, each section's stretch in the colour of its
// outcome, under their anatomical meshes as if of glass, from four sides. Needs no display.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/fit/fit_muscles.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::cook {

struct PicturedMuscle {
  const muscle::MuscleAsset* asset = nullptr;
  std::uint32_t muscle = 0;                              // drawn at rest
  const TriangleMesh* mesh = nullptr;                    // in the same space; null: none
  std::span<const muscle::SectionReport> sections = {};  // one a section; empty: not fitted, drawn grey
};

struct FitPicture {
  std::string title;                    // a single muscle's name is added
  std::vector<PicturedMuscle> muscles;  // heads of one mesh: each with that mesh, which is drawn once
  int height = 1100;                    // pixels of each of the four sides' pictures, 64..4096
};

// Green: fitted; yellow: some rays missed; orange: all did; red: the centre lies outside of the mesh; blue: the centre
// was rescued, then fitted. Each section's centre is a dot, seen through everything. The picture's head says so too.
// Errors: nothing to draw, no OpenGL here, a path that cannot be written.
Diagnostics draw_fit(const FitPicture& picture, const std::filesystem::path& png);

}  // namespace fascicle::cook
