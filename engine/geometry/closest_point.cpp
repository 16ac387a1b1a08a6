#include "engine/geometry/closest_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/finite.hpp"
#include "engine/geometry/triangle_tree.hpp"

namespace fascicle {
namespace {

double square(const glm::dvec3& v) { return glm::dot(v, v); }

// A little less than the square of the point's distance to the node's box, so that rounding hides nothing; at most the
// largest number.
float square_distance(const glm::vec3& point, const TriangleTree::Node& node) {
  const glm::vec3 away = glm::max(glm::max(node.lower - point, point - node.upper), 0.0f);
  return std::min(0.99999f * glm::dot(away, away), std::numeric_limits<float>::max());
}

// Whether no point of the triangle's plane is nearer than the square root of `nearest`.
bool lies_beyond(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                 double nearest) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double height = glm::dot(point - a, normal);
  return height * height > 1.00001 * nearest * square(normal);
}

glm::dvec3 closest_on_segment(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b) {
  const double length = square(b - a);
  if (!(length > 0.0)) return a;
  return a + std::clamp(glm::dot(point - a, b - a) / length, 0.0, 1.0) * (b - a);
}

}  // namespace

glm::dvec3 closest_point_on_triangle(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b,
                                     const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a, ap = point - a;
  const glm::dvec3 normal = glm::cross(ab, ac);
  const double size = square(normal);
  // Weights of b and c for the point's foot, times `size`. No area: every edge is asked.
  const double to_b = glm::dot(glm::cross(ap, ac), normal), to_c = glm::dot(glm::cross(ab, ap), normal);
  const bool flat = !(size > 1e-24 * square(ab) * square(ac));
  if (!flat && to_b >= 0.0 && to_c >= 0.0 && to_b + to_c <= size) return a + (to_b / size) * ab + (to_c / size) * ac;
  // Else the nearest point lies on an edge that has the foot on its outer side.
  glm::dvec3 best = a;
  double nearest = std::numeric_limits<double>::max();
  const auto try_edge = [&](bool outside, const glm::dvec3& from, const glm::dvec3& to) {
    if (!outside && !flat) return;
    const glm::dvec3 found = closest_on_segment(point, from, to);
    const double distance = square(found - point);
    if (distance < nearest) {
      nearest = distance;
      best = found;
    }
  };
  try_edge(to_c < 0.0, a, b);
  try_edge(to_b < 0.0, c, a);
  try_edge(to_b + to_c > size, b, c);
  return best;
}

struct ClosestPoints::State {
  TriangleTree tree;
};

ClosestPoints::ClosestPoints(const TriangleMesh& mesh)
    : state_(std::make_unique<const State>(State{build_triangle_tree(mesh)})) {}
ClosestPoints::~ClosestPoints() = default;
ClosestPoints::ClosestPoints(ClosestPoints&&) noexcept = default;
ClosestPoints& ClosestPoints::operator=(ClosestPoints&&) noexcept = default;

bool ClosestPoints::empty() const { return state_->tree.nodes.empty(); }

namespace {

// The nearest point, of those whose square distance is less than `nearest`.
ClosestPoint search(const TriangleTree& tree, const glm::vec3& point, double nearest) {
  if (tree.nodes.empty() || !is_finite(point)) return {};
  const glm::dvec3 p(point);
  glm::dvec3 best(0.0);
  std::uint32_t triangle = ClosestPoint{}.triangle;

  struct Waiting {
    std::uint32_t node;
    float distance;
  };
  std::array<Waiting, kTreeStackSize> stack;
  std::size_t waiting = 0;
  stack[waiting++] = {0, square_distance(point, tree.nodes[0])};
  while (waiting > 0) {
    auto [index, distance] = stack[--waiting];
    if (double{distance} >= nearest) continue;
    while (tree.nodes[index].count == 0) {
      std::uint32_t near = index + 1, far = tree.nodes[index].first;
      float near_distance = square_distance(point, tree.nodes[near]);
      float far_distance = square_distance(point, tree.nodes[far]);
      if (far_distance < near_distance) {
        std::swap(near, far);
        std::swap(near_distance, far_distance);
      }
      if (double{far_distance} < nearest) stack[waiting++] = {far, far_distance};
      index = near;
      if (double{near_distance} >= nearest) break;
    }
    const TriangleTree::Node& node = tree.nodes[index];
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      const std::array<glm::vec3, 3>& corners = tree.triangles[t];
      if (lies_beyond(p, corners[0], corners[1], corners[2], nearest)) continue;
      const glm::dvec3 found = closest_point_on_triangle(p, corners[0], corners[1], corners[2]);
      const double here = square(found - p);
      if (here < nearest || (here == nearest && tree.numbers[t] < triangle)) {
        nearest = here;
        best = found;
        triangle = tree.numbers[t];
      }
    }
  }
  if (triangle == ClosestPoint{}.triangle) return {};
  constexpr double kLargest = std::numeric_limits<float>::max();
  return {glm::vec3(best), static_cast<float>(std::min(glm::length(best - p), kLargest)), triangle};
}

}  // namespace

ClosestPoint ClosestPoints::at(const glm::vec3& point) const {
  return search(state_->tree, point, std::numeric_limits<double>::max());
}

ClosestPoint ClosestPoints::within(const glm::vec3& point, float limit) const {
  return search(state_->tree, point, double{limit} * double{limit});
}

}  // namespace fascicle
