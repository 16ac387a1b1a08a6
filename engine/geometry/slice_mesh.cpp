#include "engine/geometry/slice_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace fascicle {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// The piece of the slice inside one triangle. It starts on the edge that goes down through the plane, so that the
// mesh's inside lies to its left.
struct Segment {
  std::uint32_t triangle;
  std::array<std::uint64_t, 2> edges;      // where it starts and ends: (lower vertex << 32) | higher vertex
  std::array<std::uint32_t, 2> junctions;  // the edges' numbers among all that are cut
};

// All segment ends on one edge of the mesh: two where the mesh is sound.
struct Junction {
  std::uint64_t edge;
  std::uint32_t first, count;  // in the list of ends
};

// A segment's end: segment * 2, + 1 for where it ends.
using End = std::uint32_t;

class Slicer {
 public:
  Slicer(const TriangleMesh& mesh, const SlicePlane& plane) : mesh_(mesh), plane_(plane) {
    find_sides();
    find_segments();
    join_segments();
    used_.assign(segments_.size(), 0);
  }

  std::vector<SliceLoop> loops() {
    std::vector<SliceLoop> loops;
    // Chains first, from their ends, or they would be begun in their middle.
    for (const Junction& junction : junctions_) {
      if (junction.count % 2 == 1) follow(ends_[junction.first], loops);
    }
    for (std::uint32_t s = 0; s < segments_.size(); ++s) follow(2 * s, loops);
    std::ranges::sort(loops, {}, [](const SliceLoop& loop) {
      return std::ranges::min(loop.triangles);
    });
    return loops;
  }

 private:
  void find_sides() {
    const glm::dvec3 normal = glm::cross(plane_.u, plane_.v);
    heights_.resize(mesh_.positions.size());
    for (std::size_t i = 0; i < heights_.size(); ++i) {
      heights_[i] = glm::dot(glm::dvec3(mesh_.positions[i]) - plane_.origin, normal);
    }
  }

  void find_segments() {
    for (std::uint32_t t = 0; 3 * std::size_t{t} + 2 < mesh_.indices.size(); ++t) {
      const std::array<std::uint32_t, 3> corners = {mesh_.indices[3 * t], mesh_.indices[3 * t + 1],
                                                    mesh_.indices[3 * t + 2]};
      const std::array<double, 3> h = {heights_[corners[0]], heights_[corners[1]], heights_[corners[2]]};
      const int above = (h[0] >= 0.0) + (h[1] >= 0.0) + (h[2] >= 0.0);
      if (above == 0 || above == 3 || !std::isfinite(h[0] + h[1] + h[2])) continue;
      Segment segment{t, {}, {}};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        if ((h[i] >= 0.0) == (h[j] >= 0.0)) continue;
        const std::uint64_t low = std::min(corners[i], corners[j]), high = std::max(corners[i], corners[j]);
        segment.edges[h[i] >= 0.0 ? 0 : 1] = low << 32 | high;
      }
      segments_.push_back(segment);
    }
  }

  void join_segments() {
    ends_.resize(2 * segments_.size());
    for (End end = 0; end < ends_.size(); ++end) ends_[end] = end;
    std::ranges::sort(ends_, [&](End a, End b) { return edge(a) != edge(b) ? edge(a) < edge(b) : a < b; });
    for (std::uint32_t i = 0; i < ends_.size(); ++i) {
      if (i == 0 || edge(ends_[i]) != edge(ends_[i - 1])) junctions_.push_back({edge(ends_[i]), i, 0});
      junctions_.back().count += 1;
      segments_[ends_[i] / 2].junctions[ends_[i] % 2] = static_cast<std::uint32_t>(junctions_.size() - 1);
    }
  }

  std::uint64_t edge(End end) const { return segments_[end / 2].edges[end % 2]; }

  // The end of an unused segment that continues from `end`: rather a start after an end, as in a sound mesh.
  End continuation(End end) const {
    const Junction& junction = junctions_[segments_[end / 2].junctions[end % 2]];
    End found = kNone;
    for (std::uint32_t i = junction.first; i < junction.first + junction.count; ++i) {
      if (used_[ends_[i] / 2] != 0) continue;
      if (ends_[i] % 2 != end % 2) return ends_[i];
      if (found == kNone) found = ends_[i];
    }
    return found;
  }

  // Walks from a segment's end along unused segments until none continues.
  void follow(End from, std::vector<SliceLoop>& loops) {
    if (used_[from / 2] != 0) return;
    SliceLoop loop;
    double forward = 0.0;  // length walked the segments' way, less length walked against it
    const std::uint64_t first_edge = edge(from);
    glm::dvec2 here = point_on(first_edge);
    loop.points.push_back(here);
    End far = kNone;
    for (End near = from; near != kNone; near = continuation(far)) {
      used_[near / 2] = 1;
      far = near ^ 1u;
      const glm::dvec2 next = point_on(edge(far));
      forward += (near % 2 == 0 ? 1.0 : -1.0) * glm::distance(here, next);
      loop.triangles.push_back(segments_[near / 2].triangle);
      loop.points.push_back(next);
      here = next;
      if (edge(far) == first_edge) break;
    }
    loop.closed = edge(far) == first_edge;
    if (loop.closed) loop.points.pop_back();
    if (forward < 0.0) {
      // A closed loop keeps its first point, so that segment i still starts at point i.
      std::reverse(loop.points.begin() + (loop.closed ? 1 : 0), loop.points.end());
      std::ranges::reverse(loop.triangles);
    }
    measure_loop(loop);
    if (loop.perimeter > 0.0) loops.push_back(std::move(loop));
  }

  // The same for both triangles of an edge, bit for bit.
  glm::dvec2 point_on(std::uint64_t edge) const {
    const auto low = static_cast<std::uint32_t>(edge >> 32), high = static_cast<std::uint32_t>(edge);
    const double s = heights_[low] / (heights_[low] - heights_[high]);
    const glm::dvec3 a = mesh_.positions[low], b = mesh_.positions[high];
    const glm::dvec3 offset = a + s * (b - a) - plane_.origin;
    return {glm::dot(offset, plane_.u), glm::dot(offset, plane_.v)};
  }

  const TriangleMesh& mesh_;
  const SlicePlane& plane_;
  std::vector<double> heights_;  // m above the plane, by vertex
  std::vector<Segment> segments_;
  std::vector<End> ends_;
  std::vector<Junction> junctions_;
  std::vector<char> used_;
};

}  // namespace

SlicePlane plane_across(const glm::dvec3& origin, const glm::dvec3& normal) {
  const double length = glm::length(normal);
  const glm::dvec3 n = length > 0.0 && std::isfinite(length) ? normal / length : glm::dvec3(0, 0, 1);
  const glm::dvec3 side = std::abs(n.x) <= std::abs(n.y) && std::abs(n.x) <= std::abs(n.z) ? glm::dvec3(1, 0, 0)
                          : std::abs(n.y) <= std::abs(n.z)                                 ? glm::dvec3(0, 1, 0)
                                                                                           : glm::dvec3(0, 0, 1);
  const glm::dvec3 u = glm::normalize(side - glm::dot(side, n) * n);
  return {origin, u, glm::cross(n, u)};
}

void measure_loop(SliceLoop& loop) {
  loop.area = loop.perimeter = 0.0;
  loop.centroid = {};
  if (loop.points.empty()) return;
  // Measured from the first point, so that a loop far from the plane's origin loses no digits.
  const glm::dvec2 from = loop.points[0];
  glm::dvec2 of_area(0.0), of_curve(0.0);
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    const bool closing = i + 1 == loop.points.size();
    const glm::dvec2 a = loop.points[i] - from, b = loop.points[closing ? 0 : i + 1] - from;
    const double twice = a.x * b.y - a.y * b.x;
    loop.area += 0.5 * twice;
    of_area += twice / 6.0 * (a + b);
    if (closing && !loop.closed) continue;
    const double length = glm::distance(a, b);
    loop.perimeter += length;
    of_curve += 0.5 * length * (a + b);
  }
  // Below this the area is rounding alone, and the quotient would be anywhere.
  const bool thin = !(std::abs(loop.area) > 1e-12 * loop.perimeter * loop.perimeter);
  if (!thin) {
    loop.centroid = from + of_area / loop.area;
  } else if (loop.perimeter > 0.0) {
    loop.centroid = from + of_curve / loop.perimeter;
  } else {
    loop.centroid = from;
  }
}

std::vector<SliceLoop> slice_mesh(const TriangleMesh& mesh, const SlicePlane& plane) {
  return Slicer(mesh, plane).loops();
}

}  // namespace fascicle
