#include "modules/muscle/kernels/surface/surface_pairs.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <tuple>

#include <glm/common.hpp>

#include "modules/muscle/kernels/surface/paired_points.hpp"
#include "modules/muscle/kernels/surface/surface_range.hpp"
#include "modules/muscle/kernels/surface/triangle_place.hpp"

namespace fascicle::muscle {
namespace {

using namespace FASCICLE_ISA;

// Contact distances: what is no further along the surface at rest is a neighbour, unless it faces the other way.
constexpr float kNeighbourhood = 3.0f;
// Cosine between normals at rest from which on two sides face each other: of a thin sheet, or of a furrow.
constexpr float kFacesAtRest = -0.5f;
// Cosine between normals from which on a vertex and a triangle of one muscle may meet: surfaces meet face to face, and
// along a surface that only bends normals differ by less.
constexpr float kFaces = -0.5f;
// How near two sides of a muscle may come, of their distance at rest.
constexpr float kThinnest = 0.5f;
// Contact distances: vertices deeper than this in another muscle at rest have no side of it where they belong.
constexpr float kDeepest = 4.0f;
// Contact distances beside a triangle at which it counts, beside half of the margin.
constexpr float kBeside = 0.25f;
// Contact distances: margins. And for how many steps like the present one they are to do where that is not too wide.
constexpr float kWidestMargin = 1.5f, kNarrowestMargin = 0.4f, kStepsAhead = 3.0f;
// Of the reach: heights that are worked out in another order round differently.
constexpr float kSlack = 1.01f;
// m: the places of two muscles that overlap at rest are rounded when they are brought into one frame.
constexpr float kRounding = 1.0e-5f;

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
    keep_touching();
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

  static bool touches(const SurfacePair& pair) {
    return static_cast<float>(pair.side) * pair.height < pair.allowed;
  }

  // What was pressed may be so crumpled that it no longer faces what presses it: it stays paired without being found.
  void keep_touching() {
    for (const SurfacePair& pair : pairs_.last) {
      if (!touches(pair)) continue;
      const PairedPoints& vertices = pair.of_second != 0 ? second_points_ : first_points_;
      const PairedPoints& triangles = pair.of_second != 0 ? first_points_ : second_points_;
      const std::uint32_t* corners = triangles.corners(pair.triangle);
      const glm::vec3 p = vertices.at(pair.vertex);
      TrianglePlane plane;
      TriangleWeights under;
      if (!plane.set(triangles.at(corners[0]), triangles.at(corners[1]), triangles.at(corners[2]))) continue;
      if (over(plane, p, plane.height(p), reach_, under)) add(pair);
    }
  }

  bool has_side(float clearance) const { return clearance > -kDeepest * job_.contact_distance; }

  SurfaceRange second_box(std::uint32_t n) const {
    const SurfaceRange& box = second_.boxes->boxes[n];
    return same_frame_ ? box : moved(box, job_.second_to_first);
  }

  bool may_face(std::uint32_t a, std::uint32_t b) const {
    const AlignedVector<SurfaceRange>& ranges = job_.first.boxes->normal_ranges;
    return least_dot(load_range(ranges[a]), load_range(ranges[b])) < kFaces;
  }

  // Of one muscle: all below a node among each other.
  void within(std::uint32_t n) {
    if (!may_face(n, n)) return;
    const Node& node = job_.first.tree->nodes[n];
    if (node.count > 0) {
      leaf_of_itself(node, n);
      return;
    }
    within(n + 1);
    within(node.right);
    between(n + 1, node.right, second_box(node.right));
  }

  void between(std::uint32_t a, std::uint32_t b, const SurfaceRange& box_b) {
    const SurfaceRange& box_a = job_.first.boxes->boxes[a];
    if (!near(load_range(box_a), load_range(box_b), reach_)) return;
    if (itself_ && !may_face(a, b)) return;
    const Node &node_a = job_.first.tree->nodes[a], &node_b = second_.tree->nodes[b];
    if (node_a.count > 0 && node_b.count > 0) {
      if (itself_) {
        leaf_of_itself(node_a, b);
        leaf_of_itself(node_b, a);
      } else {
        leaf_of_other(node_a, node_b, box_b, false);
        leaf_of_other(node_b, node_a, box_a, true);
      }
    } else if (node_b.count > 0 || (node_a.count == 0 && extent(box_a) >= extent(box_b))) {
      between(a + 1, b, box_b);
      between(node_a.right, b, box_b);
    } else {
      between(a, b + 1, second_box(b + 1));
      between(a, node_b.right, second_box(node_b.right));
    }
  }

  // Own vertices of one leaf of the muscle against the triangles of another leaf, four at once.
  void leaf_of_itself(const Node& of, std::uint32_t node) {
    const SurfaceTree& tree = *job_.first.tree;
    const SurfaceBoxes& boxes = *job_.first.boxes;
    const Node& against = tree.nodes[node];
    const WideRange bounds = load_range(boxes.boxes[node]), facing = load_range(boxes.normal_ranges[node]);
    for (std::uint32_t i = 0; i < of.own; ++i) {
      const SurfacePoint& point = boxes.own_points[of.first_vertex + i];
      const glm::vec3 p(point.x, point.y, point.z);
      if (!near(point_range(p), bounds, reach_)) continue;
      const std::uint32_t v = tree.vertices[of.first_vertex + i];
      const SurfaceRange& normals = boxes.vertex_normals[v];
      if (!(least_dot(load_range(normals), facing) < kFaces)) continue;
      for (std::uint32_t first = 0; first < against.count; first += kPlaneLanes) {
        std::uint32_t meeting = may_meet(p, normals, against.first + first);
        if (against.count - first < kPlaneLanes) meeting &= (1u << (against.count - first)) - 1u;
        for (std::uint32_t lane = 0; meeting != 0; ++lane, meeting >>= 1) {
          if ((meeting & 1u) != 0) test_itself(v, p, tree.triangles[against.first + first + lane]);
        }
      }
    }
  }

  // Bits of the four triangles from `place` on: the point is not too high above the plane, and they may face.
  std::uint32_t may_meet(const glm::vec3& p, const SurfaceRange& normals, std::uint32_t place) const {
    const SurfaceBoxes& boxes = *job_.first.boxes;
    const FourLanes x = load<4>(&boxes.plane_x[place]), y = load<4>(&boxes.plane_y[place]),
                    z = load<4>(&boxes.plane_z[place]), plane = load<4>(&boxes.plane_height[place]);
    const FourLanes height = p.x * x + p.y * y + p.z * z - plane;
    const auto least = [&normals](std::size_t k, FourLanes n) {
      return lesser(normals.lower[k] * n, normals.upper[k] * n);
    };
    const FourLanes facing = least(0, x) + least(1, y) + least(2, z), reach = broadcast<4>(kSlack * reach_);
    const WideInt<4> mask = (facing < broadcast<4>(kFaces)) & (height < reach) & (broadcast<4>(0.0f) - reach < height);
    return static_cast<std::uint32_t>(_mm_movemask_ps((__m128)mask.v));
  }

  void test_itself(std::uint32_t v, const glm::vec3& p, std::uint32_t t) {
    const std::uint32_t* corners = first_points_.corners(t);
    if (v == corners[0] || v == corners[1] || v == corners[2]) return;
    const std::span<const SurfacePoint> points = job_.first.points;
    WideRange box = point_range(first_points_.at(corners[0]));
    for (std::size_t k = 1; k < 3; ++k) include(box, load<4>(&points[corners[k]].x));
    if (!near(point_range(p), box, reach_)) return;
    TrianglePlane plane;
    if (!plane.set(first_points_.at(corners[0]), first_points_.at(corners[1]), first_points_.at(corners[2]))) return;
    test(v, p, t, plane, job_.contact_distance, first_points_, first_points_, false);
  }

  // Own vertices of one muscle's leaf against the triangles of the other's, whose box is `box`.
  void leaf_of_other(const Node& of, const Node& against, const SurfaceRange& box, bool of_second) {
    const PairedSurface &vertex_surface = of_second ? second_ : job_.first;
    const PairedSurface &triangle_surface = of_second ? job_.first : second_;
    const PairedPoints &vertices = of_second ? second_points_ : first_points_;
    const PairedPoints &triangles = of_second ? first_points_ : second_points_;
    std::array<std::uint32_t, 3 * kSurfaceLeaf> numbers;
    std::array<glm::vec3, 3 * kSurfaceLeaf> places;
    std::size_t count = 0;
    const WideRange bounds = load_range(box);
    for (std::uint32_t i = 0; i < of.own; ++i) {
      const std::uint32_t v = vertex_surface.tree->vertices[of.first_vertex + i];
      if (!has_side(clearance_of(vertex_surface, v))) continue;
      const glm::vec3 p = vertices.at(v);
      if (!near(point_range(p), bounds, reach_)) continue;
      numbers[count] = v;
      places[count++] = p;
    }
    for (std::uint32_t i = 0; count > 0 && i < against.count; ++i) {
      const std::uint32_t t = triangle_surface.tree->triangles[against.first + i];
      const std::uint32_t* corners = triangles.corners(t);
      const glm::vec3 a = triangles.at(corners[0]), b = triangles.at(corners[1]), c = triangles.at(corners[2]);
      WideRange bounds_of_triangle = point_range(a);
      include(bounds_of_triangle, point_range(b));
      include(bounds_of_triangle, point_range(c));
      TrianglePlane plane;
      bool placed = false;
      for (std::size_t k = 0; k < count; ++k) {
        if (!near(point_range(places[k]), bounds_of_triangle, reach_)) continue;
        if (!placed && !plane.set(a, b, c)) break;
        placed = true;
        test(numbers[k], places[k], t, plane, clearance_of(vertex_surface, numbers[k]), vertices, triangles, of_second);
      }
    }
  }

  float clearance_of(const PairedSurface& surface, std::uint32_t v) const {
    return surface.clearance.empty() ? job_.contact_distance : surface.clearance[v];
  }

  static WideRange point_range(const glm::vec3& p) {
    const float of[4] = {p.x, p.y, p.z, 0.0f};
    return {load<4>(of), load<4>(of)};
  }

  void test(std::uint32_t v, const glm::vec3& p, std::uint32_t t, const TrianglePlane& plane, float clearance,
            const PairedPoints& vertices, const PairedPoints& triangles, bool of_second) {
    SurfacePair pair;
    pair.vertex = v;
    pair.triangle = t;
    pair.of_second = of_second ? 1 : 0;
    TriangleWeights under;
    const float height = plane.height(p);
    const float reach = std::max(job_.contact_distance, -clearance) + job_.margin;
    if (!over(plane, p, height, reach, under)) return;
    const std::uint32_t* corners = triangles.corners(t);
    if (vertices.inverse_mass(v) + triangles.inverse_mass(corners[0]) + triangles.inverse_mass(corners[1]) +
            triangles.inverse_mass(corners[2]) <= 0.0f) {
      return;
    }
    const auto known = std::lower_bound(pairs_.last.begin(), pairs_.last.end(), pair, comes_before);
    if (known != pairs_.last.end() && !comes_before(pair, *known)) {
      if (touches(*known)) return;  // kept already
      pair = *known;
    } else {
      if (!meet(clearance, pair)) return;
      pair.height = height;
      pair.b2 = under.b2;
      pair.b3 = under.b3;
      pair.side = height >= 0.0f || pair.allowed < 0.0f ? 1 : -1;
    }
    if (pair.side < 0 && !itself_) return;  // behind it, but before another
    if (static_cast<float>(pair.side) * height <= pair.allowed + job_.margin) add(pair);
  }

  // Above or below the triangle, or so near beside it that it may be there before the step is over. (Further beside
  // it some neighbour is nearer.)
  bool over(const TrianglePlane& plane, const glm::vec3& p, float height, float reach, TriangleWeights& under) const {
    if (!(std::abs(height) <= reach)) return false;
    under = plane.under(p);
    if (under.inside()) return true;
    const glm::vec3 beside = plane.at(under) - plane.at(plane.nearest(under));
    const float square = glm::dot(beside, beside), most = 0.5f * job_.margin + kBeside * job_.contact_distance;
    return square <= most * most && square + height * height <= reach * reach;
  }

  void add(const SurfacePair& pair) {
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
    if (deep) pair.allowed = clearance - kRounding;
    if (!deep && clearance < job_.contact_distance) pair.allowed = std::max(clearance - kRounding, 0.0f);
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
    const float facing =
        least_dot(load_range(job_.first.tree->rest_normals[pair.vertex]), point_range(plane.normal));
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

std::size_t usual_pair_capacity(std::size_t vertex_count) { return 1024 + 8 * vertex_count; }

void find_pairs(const PairsJob& job, SurfacePairs& pairs) {
  assert(job.contact_distance > 0.0f && job.first.asset != nullptr);
  std::swap(pairs.pairs, pairs.last);
  pairs.pairs.clear();
  Search search(job, pairs);
  search.run();
  std::sort(pairs.pairs.begin(), pairs.pairs.end(), comes_before);
  if (search.full()) ++pairs.overflows;
}

void keep_pairs(const PairsJob& job, float nearer, SurfaceBoxes& first_boxes, SurfaceBoxes* second_boxes,
                SurfacePairs& pairs) {
  pairs.spare -= nearer;
  if (pairs.spare >= 0.0f) return;
  // Half of the contact distance may be used up before something is pushed that was not found.
  const float most = kWidestMargin * job.contact_distance, credit = 0.5f * job.contact_distance;
  const float ahead = kStepsAhead * nearer - credit;
  PairsJob now = job;
  now.margin = std::clamp(ahead <= most ? ahead : nearer - credit, kNarrowestMargin * job.contact_distance, most);
  if (!first_boxes.placed) place_boxes(*job.first.tree, *job.first.asset, job.first.points, first_boxes);
  if (second_boxes != nullptr && !second_boxes->placed) {
    place_boxes(*job.second.tree, *job.second.asset, job.second.points, *second_boxes);
  }
  find_pairs(now, pairs);
  pairs.spare = now.margin + credit - nearer;
  if (second_boxes == nullptr || first_boxes.boxes.empty() || second_boxes->boxes.empty()) return;
  // Muscles that are far apart need not be asked for longer.
  const SurfaceRange &a = first_boxes.boxes[0], b = moved(second_boxes->boxes[0], job.second_to_first);
  float gap = 0.0f;
  for (std::size_t k = 0; k < 3; ++k) gap = std::max({gap, a.lower[k] - b.upper[k], b.lower[k] - a.upper[k]});
  pairs.spare = std::max(pairs.spare, gap - job.contact_distance - nearer);
}

void forget_pairs(SurfacePairs& pairs) {
  pairs.pairs.clear();
  pairs.last.clear();
  pairs.spare = -1.0f;
}

}  // namespace fascicle::muscle
