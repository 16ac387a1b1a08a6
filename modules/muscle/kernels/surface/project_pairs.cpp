#include <algorithm>
#include <cmath>

#include "modules/muscle/kernels/surface/paired_points.hpp"
#include "modules/muscle/kernels/surface/surface_pairs.hpp"
#include "modules/muscle/kernels/surface/triangle_place.hpp"

namespace fascicle::muscle {
namespace {

// Contact distances: a way that crosses a triangle's plane no further beside it has gone through it, for what crosses
// near an edge must not slip between two triangles.
constexpr float kRim = 0.25f;

bool within_rim(const TrianglePlane& plane, const TriangleWeights& place, float rim) {
  if (place.inside()) return true;
  const glm::vec3 apart = plane.at(place) - plane.at(plane.nearest(place));
  return glm::dot(apart, apart) <= rim * rim;
}

// Keeps the memory of a pair: `height` over `under` is where the vertex is now.
void follow(const TrianglePlane& plane, float height, const TriangleWeights& under, float rim, SurfacePair& pair) {
  const bool crossed = (height >= 0.0f) != (pair.height >= 0.0f);
  if (crossed && pair.allowed >= 0.0f) {
    const float s = pair.height / (pair.height - height);
    const TriangleWeights place{pair.b2 + s * (under.b2 - pair.b2), pair.b3 + s * (under.b3 - pair.b3)};
    if (!within_rim(plane, place, rim)) pair.side = height >= 0.0f ? 1 : -1;
  }
  pair.height = height;
  pair.b2 = under.b2;
  pair.b3 = under.b3;
}

// What is too near: which way the vertex goes, how far the two must part, and where the triangle is met.
struct Meeting {
  glm::vec3 way{0.0f};  // unit
  float depth = 0.0f;   // m
  TriangleWeights place;
};

bool meets(const TrianglePlane& plane, const glm::vec3& p, float height, const TriangleWeights& under, float rim,
           const SurfacePair& pair, Meeting& meeting) {
  const float side = static_cast<float>(pair.side), own = side * height;
  if (!(own < pair.allowed)) return false;  // nor where it is no number
  meeting.way = side * plane.normal;
  meeting.depth = pair.allowed - own;
  meeting.place = under;
  if (under.inside()) return true;
  meeting.place = plane.nearest(under);
  if (own <= 0.0f) return pair.allowed >= 0.0f && within_rim(plane, under, rim);
  const glm::vec3 apart = p - plane.at(meeting.place);
  const float distance = glm::length(apart);
  if (!(distance < pair.allowed)) return false;
  meeting.way = apart / distance;
  meeting.depth = pair.allowed - distance;
  return true;
}

void push(const Meeting& meeting, const SurfacePair& pair, const std::uint32_t* corners, const PairedPoints& vertices,
          const PairedPoints& triangles) {
  const float b[3] = {1.0f - meeting.place.b2 - meeting.place.b3, meeting.place.b2, meeting.place.b3};
  const float w = vertices.inverse_mass(pair.vertex);
  float sum = w;
  for (int k = 0; k < 3; ++k) sum += b[k] * b[k] * triangles.inverse_mass(corners[k]);
  if (!(sum > 0.0f)) return;
  const glm::vec3 impulse = (meeting.depth / sum) * meeting.way;
  if (w > 0.0f) vertices.move(pair.vertex, w * impulse);
  for (int k = 0; k < 3; ++k) {
    const float share = b[k] * triangles.inverse_mass(corners[k]);
    if (share > 0.0f) triangles.move(corners[k], -share * impulse);
  }
}

}  // namespace

void project_pairs(const PairsJob& job, SurfacePairs& pairs) {
  pairs.pushed = 0;
  pairs.deepest = 0.0f;
  if (pairs.pairs.empty()) return;
  const bool itself = job.second.asset == nullptr;
  const PairedPoints first(job.first, glm::mat4(1.0f));
  const PairedPoints second(itself ? job.first : job.second, itself ? glm::mat4(1.0f) : job.second_to_first);
  const float rim = kRim * job.contact_distance;
  for (SurfacePair& pair : pairs.pairs) {
    const PairedPoints& vertices = pair.of_second != 0 ? second : first;
    const PairedPoints& triangles = pair.of_second != 0 ? first : second;
    const std::uint32_t* corners = triangles.corners(pair.triangle);
    TrianglePlane plane;
    if (!plane.set(triangles.at(corners[0]), triangles.at(corners[1]), triangles.at(corners[2]))) continue;
    const glm::vec3 p = vertices.at(pair.vertex);
    const float height = plane.height(p);
    const TriangleWeights under = plane.under(p);
    follow(plane, height, under, rim, pair);
    if (pair.side < 0 && !itself) continue;  // behind it, but before another
    Meeting meeting;
    if (!meets(plane, p, height, under, rim, pair, meeting)) continue;
    push(meeting, pair, corners, vertices, triangles);
    ++pairs.pushed;
    pairs.deepest = std::max(pairs.deepest, meeting.depth);
  }
}

}  // namespace fascicle::muscle
