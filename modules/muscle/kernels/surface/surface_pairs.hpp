// Contacts of surface muscles with themselves and with each other: vertices against triangles.
//
// Once a step `find_pairs` goes through the trees of boxes and lists the vertices and triangles that can come to touch
// before the next; in each substep `project_pairs` pushes those apart that have come too near, vertex and triangle
// sharing by their inverse masses:
//   C = side n . (v - q) - allowed >= 0,   d lambda = -C / (w_v + sum b_i^2 w_i)
// q = sum b_i p_i is the triangle's point nearest to v, n its normal or, beyond its rim, the direction from q to v.
//
// Which side. A pair remembers on which side of its triangle the vertex belongs, from step to step. The side changes
// only where the vertex' way past the triangle leads round it: one that crosses the plane within the triangle has gone
// through, however fast, and is brought back. Of a muscle itself both sides count, the inner one where a thin muscle is
// pressed flat. Of another muscle only the outer one does: a vertex that is behind a triangle without having come
// through it is before another.
//
// What is near at rest may be. Of one muscle, a vertex and a triangle that lie near to each other along the surface are
// no pair; two sides of a thin sheet are one, and may come half as near as they are at rest (`allowed`), so that a
// muscle can become thinner as it is drawn out. Of two muscles that overlap at rest, a vertex may be as deep as it is.
//
// Pairs are sorted by vertex and triangle and projected in this order (Gauss-Seidel), so the result depends on nothing
// but the places. Nothing is allocated after `lay_out_pairs`.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/asset/surface/surface_tree.hpp"
#include "modules/muscle/kernels/surface/surface_boxes.hpp"

namespace fascicle::muscle {

struct SurfacePair {
  std::uint32_t vertex = 0, triangle = 0;
  float allowed = 0.0f;            // m: the nearest that they may come; negative: how deep the vertex may be
  // Where the vertex was at the last substep against the triangle: over p_1 + b_2 (p_2 - p_1) + b_3 (p_3 - p_1).
  float height = 0.0f;             // m, along the normal
  float b2 = 0.0f, b3 = 0.0f;
  std::int8_t side = 1;            // of the triangle that the vertex belongs on: 1 outside, -1 inside
  std::uint8_t of_second = 0;      // the vertex is of the second muscle and the triangle of the first
};

// Of one muscle with itself, or of two.
struct SurfacePairs {
  std::vector<SurfacePair> pairs;  // of this step
  std::vector<SurfacePair> last;   // of the step before
  std::size_t capacity = 0;        // pairs there is room for
  std::uint64_t overflows = 0;     // steps that wanted more: lay_out_pairs' `capacity` is too small
  float spare = -1.0f;             // m: how much nearer anything may still come until pairs must be found anew
  std::uint32_t pushed = 0;        // by the last project_pairs
  float deepest = 0.0f;            // m: the furthest that it pushed
};

// Makes room, forgets all pairs.
void lay_out_pairs(std::size_t capacity, SurfacePairs& pairs);
// For meshes of this many vertices in all.
std::size_t usual_pair_capacity(std::size_t vertex_count);

struct PairedSurface {
  const SurfaceAsset* asset = nullptr;
  const SurfaceTree* tree = nullptr;
  const SurfaceBoxes* boxes = nullptr;   // as place_boxes left them at the step's start; project_pairs does not read it
  std::span<SurfacePoint> points;        // m, in the muscle's own frame; find_pairs only reads them
  std::span<const float> clearance;      // m, from the other muscle at rest, by vertex (find_rest_clearance with a
                                         // reach of contact_distance or more); empty: far from it, or the same
};

struct PairsJob {
  PairedSurface first;
  PairedSurface second;                  // asset is null: `first` with itself
  glm::mat4 second_to_first{1.0f};       // rigid, between the muscles' frames; the identity is quicker
  float contact_distance = 0.0f;         // m, > 0
  float margin = 0.0f;                   // m: how much nearer a vertex and a triangle may come during a step
};

// Lists the pairs of this step. What has been paired keeps its memory.
void find_pairs(const PairsJob& job, SurfacePairs& pairs);

// The same only when it is time. `nearer` (m): how much nearer a vertex and a triangle may come during this step; the
// margin is chosen here, so that pairs serve for some steps where things are slow, and for good where all is at rest.
// What comes nearer in a step than the margin ever is (half as much again as the contact distance) may be missed.
// Boxes are placed when they are needed and have not been in this step; `first_boxes` and `second_boxes` (null: with
// itself) are the job's own.
void keep_pairs(const PairsJob& job, float nearer, SurfaceBoxes& first_boxes, SurfaceBoxes* second_boxes,
                SurfacePairs& pairs);

// After the muscles have been put elsewhere: no pair is remembered.
void forget_pairs(SurfacePairs& pairs);

// Pushes apart what is too near, once. With no pair in reach it returns at once.
void project_pairs(const PairsJob& job, SurfacePairs& pairs);

}  // namespace fascicle::muscle
