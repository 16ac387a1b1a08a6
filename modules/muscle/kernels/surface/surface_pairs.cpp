#include "modules/muscle/kernels/surface/surface_pairs.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <tuple>

#include <glm/common.hpp>

#include "modules/muscle/kernels/surface/paired_points.hpp"
#include "modules/muscle/kernels/surface/triangle_place.hpp"

namespace fascicle::muscle {
namespace {

// Contact distances: what is no further along the surface at rest is a neighbour, unless it faces the other way.
constexpr float kNeighbourhood = 3.0f;
// Cosine between normals at rest from which on two sides face each other: of a thin sheet, or of a furrow.
constexpr float kFacesAtRest = -0.5f;
// How near two sides of a muscle may come, of their distance at rest.
constexpr float kThinnest = 0.5f;
// Contact distances: vertices deeper than this in another muscle at rest have no side of it where they belong.
constexpr float kDeepest = 4.0f;
// m: the places of two muscles that overlap at rest are rounded when they are brought into one frame.
constexpr float kRounding = 1.0e-5f;

bool near(const SurfaceRange& a, const SurfaceRange& b, float reach) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (a.lower[k] > b.upper[k] + reach || b.lower[k] > a.upper[k] + reach) return false;
  }
  return true;
}

// Whether a vector of one range and one of the other can point against each other.
bool may_face(const SurfaceRange& a, const SurfaceRange& b) {
  float least = 0.0f;
  for (std::size_t k = 0; k < 3; ++k) {
    least += std::min(std::min(a.lower[k] * b.lower[k], a.lower[k] * b.upper[k]),
                      std::min(a.upper[k] * b.lower[k], a.upper[k] * b.upper[k]));
  }
  return least < 0.0f;
}

float extent(const SurfaceRange& box) {
  return std::max({box.upper[0] - box.lower[0], box.upper[1] - box.lower[1], box.upper[2] - box.lower[2]});
}

SurfaceRange moved(const SurfaceRange& box, const glm::mat4& to) {
  const glm::vec3 lower(box.lower[0], box.lower[1], box.lower[2]), upper(box.upper[0], box.upper[1], box.upper[2]);
  const glm::vec3 middle = glm::vec3(to * glm::vec4(0.5f * (lower + upper), 1.0f)), half = 0.5f * (upper - lower);
  const glm::vec3 reach = glm::abs(glm::vec3(to[0])) * half.x + glm::abs(glm::vec3(to[1])) * half.y +
                          glm::abs(glm::vec3(to[2])) * half.z;
  SurfaceRange range;
  for (int k = 0; k < 3; ++k) {
    range.lower[static_cast<std::size_t>(k)] = middle[k] - reach[k];
    range.upper[static_cast<std::size_t>(k)] = middle[k] + reach[k];
  }
  return range;
}

bool comes_before(const SurfacePair& a, const SurfacePair& b) {
  return std::tie(a.of_second, a.vertex, a.triangle) < std::tie(b.of_second, b.vertex, b.triangle);
}

glm::vec3 rest_place(const SurfaceAsset& asset, std::uint32_t v) {
  return {asset.rest[v].x, asset.rest[v].y, asset.rest[v].z};
}

class Search {
 public:
  Search(const PairsJob& job, SurfacePairs& pairs)
      : job_(job), itself_(job.second.asset == nullptr), second_(itself_ ? job.first : job.second),
        same_frame_(itself_ || is_identity(job.second_to_first)), first_points_(job.first, glm::mat4(1.0f)),
        second_points_(second_, itself_ ? glm::mat4(1.0f) : job.second_to_first), pairs_(pairs) {
    float nearest = job.contact_distance;
    for (const PairedSurface* surface : {&job.first, &job.second}) {
      for (const float clearance : surface->clearance) {
        if (has_side(clearance)) nearest = std::max(nearest, -clearance);
      }
    }
    reach_ = nearest + job.margin;
  }

  void run() {
    if (job_.first.tree->nodes.empty() || second_.tree->nodes.empty()) return;
    if (itself_) {
      within(0);
    } else {
      between(0, 0, second_box(0));
    }
  }

  bool full() const { return full_; }

 private:
  using Node = SurfaceTree::Node;

  bool has_side(float clearance) const { return clearance > -kDeepest * job_.contact_distance; }

  SurfaceRange second_box(std::uint32_t n) const {
    const SurfaceRange& box = second_.boxes->boxes[n];
    return same_frame_ ? box : moved(box, job_.second_to_first);
  }

  bool may_face(std::uint32_t a, std::uint32_t b) const {
    return muscle::may_face(job_.first.boxes->normal_ranges[a], job_.first.boxes->normal_ranges[b]);
  }

  // Of one muscle: all below a node among each other.
  void within(std::uint32_t n) {
    if (!may_face(n, n)) return;
    const Node& node = job_.first.tree->nodes[n];
    if (node.count > 0) {
      leaf_vertices(node, node, first_points_, first_points_, job_.first.boxes->boxes[n], false);
      return;
    }
    within(n + 1);
    within(node.right);
    between(n + 1, node.right, second_box(node.right));
  }

  void between(std::uint32_t a, std::uint32_t b, const SurfaceRange& box_b) {
    const SurfaceRange& box_a = job_.first.boxes->boxes[a];
    if (!near(box_a, box_b, reach_)) return;
    if (itself_ && !may_face(a, b)) return;
    const Node &node_a = job_.first.tree->nodes[a], &node_b = second_.tree->nodes[b];
    if (node_a.count > 0 && node_b.count > 0) {
      leaf_vertices(node_a, node_b, first_points_, second_points_, box_b, false);
      leaf_vertices(node_b, node_a, second_points_, first_points_, box_a, !itself_);
    } else if (node_b.count > 0 || (node_a.count == 0 && extent(box_a) >= extent(box_b))) {
      between(a + 1, b, box_b);
      between(node_a.right, b, box_b);
    } else {
      between(a, b + 1, second_box(b + 1));
      between(a, node_b.right, second_box(node_b.right));
    }
  }

  // Own vertices of one leaf against the triangles of another, whose box is `box`.
  void leaf_vertices(const Node& of, const Node& against, const PairedPoints& vertices, const PairedPoints& triangles,
                     const SurfaceRange& box, bool of_second) {
    const SurfaceTree& vertex_tree = of_second ? *second_.tree : *job_.first.tree;
    const SurfaceTree& triangle_tree = of_second || itself_ ? *job_.first.tree : *second_.tree;
    const std::span<const float> clearances = of_second ? second_.clearance : job_.first.clearance;
    std::array<std::uint32_t, 3 * kSurfaceLeaf> numbers;
    std::array<glm::vec3, 3 * kSurfaceLeaf> places;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < of.own; ++i) {
      const std::uint32_t v = vertex_tree.vertices[of.first_vertex + i];
      if (!clearances.empty() && !has_side(clearances[v])) continue;
      const glm::vec3 p = vertices.at(v);
      const SurfaceRange point{{p.x, p.y, p.z, 0.0f}, {p.x, p.y, p.z, 0.0f}};
      if (!near(point, box, reach_)) continue;
      numbers[count] = v;
      places[count++] = p;
    }
    for (std::uint32_t i = 0; count > 0 && i < against.count; ++i) {
      const std::uint32_t t = triangle_tree.triangles[against.first + i];
      const std::uint32_t* corners = triangles.corners(t);
      TrianglePlane plane;
      if (!plane.set(triangles.at(corners[0]), triangles.at(corners[1]), triangles.at(corners[2]))) continue;
      for (std::size_t k = 0; k < count; ++k) {
        if (itself_ && (!faces(numbers[k], t) || is_corner(numbers[k], corners))) continue;
        const float clearance = clearances.empty() ? job_.contact_distance : clearances[numbers[k]];
        test(numbers[k], places[k], t, plane, clearance, vertices, triangles, of_second);
      }
    }
  }

  bool faces(std::uint32_t v, std::uint32_t t) const {
    const SurfaceNormal &a = job_.first.boxes->vertex_normals[v], &b = job_.first.boxes->triangle_normals[t];
    return a.x * b.x + a.y * b.y + a.z * b.z < 0.0f;
  }

  static bool is_corner(std::uint32_t v, const std::uint32_t* corners) {
    return v == corners[0] || v == corners[1] || v == corners[2];
  }

  void test(std::uint32_t v, const glm::vec3& p, std::uint32_t t, const TrianglePlane& plane, float clearance,
            const PairedPoints& vertices, const PairedPoints& triangles, bool of_second) {
    const float reach = std::max(job_.contact_distance, -clearance) + job_.margin;
    const float height = plane.height(p);
    if (!(std::abs(height) <= reach)) return;
    const TriangleWeights under = plane.under(p);
    if (!under.inside()) {
      const glm::vec3 apart = p - plane.at(plane.nearest(under));
      if (!(glm::dot(apart, apart) <= reach * reach)) return;
    }
    const std::uint32_t* corners = triangles.corners(t);
    if (vertices.inverse_mass(v) + triangles.inverse_mass(corners[0]) + triangles.inverse_mass(corners[1]) +
            triangles.inverse_mass(corners[2]) <= 0.0f) {
      return;
    }
    SurfacePair pair;
    pair.vertex = v;
    pair.triangle = t;
    pair.of_second = of_second ? 1 : 0;
    const auto known = std::lower_bound(pairs_.last.begin(), pairs_.last.end(), pair, comes_before);
    if (known != pairs_.last.end() && !comes_before(pair, *known)) {
      pair = *known;
    } else {
      if (!meet(clearance, pair)) return;
      pair.height = height;
      pair.b2 = under.b2;
      pair.b3 = under.b3;
      pair.side = height >= 0.0f || pair.allowed < 0.0f ? 1 : -1;
    }
    if (pairs_.pairs.size() < pairs_.capacity) {
      pairs_.pairs.push_back(pair);
    } else {
      full_ = true;
    }
  }

  // How near the two may come, by how they lie at rest; false where they are neighbours.
  bool meet(float clearance, SurfacePair& pair) const {
    pair.allowed = job_.contact_distance;
    const bool deep = !itself_ && clearance < 0.0f;
    if (!itself_) pair.allowed = std::min(pair.allowed, deep ? clearance - kRounding : std::max(clearance - kRounding, 0.0f));
    if (!itself_ && !deep) return true;
    const SurfaceAsset& of = pair.of_second != 0 ? *second_.asset : *job_.first.asset;
    const SurfaceAsset& against = pair.of_second != 0 ? *job_.first.asset : *second_.asset;
    const std::uint32_t* corners = &against.triangles[3 * std::size_t{pair.triangle}];
    TrianglePlane plane;
    if (!plane.set(rest_place(against, corners[0]), rest_place(against, corners[1]), rest_place(against, corners[2]))) {
      return false;
    }
    const glm::vec3 p = rest_place(of, pair.vertex);
    if (deep) {
      // Some other part of the muscle may be nearer to it at rest than this triangle, on either side of its plane.
      pair.allowed = std::min(pair.allowed, plane.height(p) - kRounding);
      return true;
    }
    const float distance = glm::length(p - plane.at(plane.nearest(plane.under(p))));
    const float facing = glm::dot(job_.first.tree->rest_normals[pair.vertex], plane.normal);
    if (distance < kNeighbourhood * job_.contact_distance && facing > kFacesAtRest) return false;
    pair.allowed = std::min(pair.allowed, kThinnest * distance);
    return true;
  }

  const PairsJob& job_;
  bool itself_;
  const PairedSurface& second_;
  bool same_frame_;
  PairedPoints first_points_, second_points_;
  SurfacePairs& pairs_;
  float reach_ = 0.0f;  // m
  bool full_ = false;
};

}  // namespace

void lay_out_pairs(std::size_t capacity, SurfacePairs& pairs) {
  pairs = {};
  pairs.capacity = capacity;
  pairs.pairs.reserve(capacity);
  pairs.last.reserve(capacity);
}

std::size_t usual_pair_capacity(std::size_t vertex_count) { return 1024 + 4 * vertex_count; }

void find_pairs(const PairsJob& job, SurfacePairs& pairs) {
  assert(job.contact_distance > 0.0f && job.first.asset != nullptr);
  std::swap(pairs.pairs, pairs.last);
  pairs.pairs.clear();
  Search search(job, pairs);
  search.run();
  std::sort(pairs.pairs.begin(), pairs.pairs.end(), comes_before);
  if (search.full()) ++pairs.overflows;
}

}  // namespace fascicle::muscle
