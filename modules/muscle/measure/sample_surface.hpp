// A muscle's drawn surface cut into points a few millimetres apart. Each side of a segment between two drawn rows is a
// patch of two triangles, split as it is drawn (asset/surface_topology.hpp), with its own even grid of points.
//
// The first and the last section are attached to bone and are not sampled: points whose place along the line is nearer
// to the first or the last section than to its neighbour are left out, that is half of the first and of the last
// segment of the line, with the caps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/tendons.hpp"
#include "modules/muscle/measure/solid_tree.hpp"

namespace fascicle::muscle {

// Where each drawn row lies along the muscle's line: section k at k, a tendon section between two of them.
void find_row_places(const MuscleAsset& asset, const Tendons& tendons, std::uint32_t muscle,
                     std::vector<float>& places);

struct SampledPoint {
  glm::vec3 position{0.0f};  // m, world
  float place = 0.0f;        // along the line, in sections
};

// The patch's corners: side `side` of row `row` (its first two), then of the row after.
struct SurfacePatch {
  glm::vec3 corners[4];
  float from = 0.0f, to = 0.0f;  // the rows' places along the line
};
SurfacePatch patch_of(const MuscleSurfaceView& surface, std::span<const float> row_places, std::uint32_t row,
                      std::uint32_t side);

// Replaces `points` by the patch's, no more than `spacing` m apart along its sides, its corners among them; points on
// its second side and on the row after are left to the neighbours. Only those with first <= place <= last.
void sample_patch(const SurfacePatch& patch, float spacing, float first, float last, std::vector<SampledPoint>& points);

// The muscle's closed surface, caps included: triangles of indices that count from its own vertex 0.
std::vector<std::uint32_t> surface_triangles(const MuscleAsset& asset, std::uint32_t muscle);

}  // namespace fascicle::muscle
