// Muscles posed by their coarse hulls beside the same muscles by dynamics (4.5), at the same poses and from several
// sides, for the eyes of who looks for faults: faces that are inside out are magenta. Needs no display.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "engine/content/result.hpp"
#include "modules/muscle/content/scene_asset.hpp"
#include "tools/fascicle_cook/surface_poses.hpp"
#include "tools/fascicle_cook/surface_run.hpp"

namespace fascicle::cook {

struct BesidePicture {
  std::shared_ptr<const muscle::SceneAsset> scene, beside;
  SurfaceRunOptions options, beside_options;
  std::vector<PosePair> pairs;        // at most four are shown, from the least angle to the largest
  int sides = 3;                      // round the muscles, from the scene's camera on
  int width = 300, height = 300;      // pixels of one picture
};

// A pair of columns a pose, a row a side. Errors: nothing to draw, no OpenGL here, a path that cannot be written.
Diagnostics draw_beside(const BesidePicture& picture, const std::filesystem::path& png);

// Of these pairs the nearest to angles spread evenly from the least to the largest: `count`, or all where there are
// fewer.
std::vector<PosePair> spread_pairs(const std::vector<PosePair>& pairs, std::size_t count = 3);

}  // namespace fascicle::cook
