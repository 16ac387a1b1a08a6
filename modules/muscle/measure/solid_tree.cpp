#include "modules/muscle/measure/solid_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/closest_point.hpp"

namespace fascicle::muscle {
namespace {

// +1 where the triangle, seen from +z, runs anticlockwise round the point, -1 where clockwise, 0 where it does not.
// Each edge is asked in one way whichever triangle it belongs to, and its ends count half-open, so that along a closed
// surface no crossing is lost and none counts twice.
int turns_round(const std::array<glm::vec3, 3>& corners, double x, double y) {
  int turns = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec3 &from = corners[i], &to = corners[(i + 1) % 3];
    const bool from_below = double{from.y} <= y, to_below = double{to.y} <= y;
    if (from_below == to_below) continue;
    const glm::dvec3 low(from_below ? from : to), high(from_below ? to : from);
    const double left = (high.x - low.x) * (y - low.y) - (x - low.x) * (high.y - low.y);
    if (left > 0.0) turns += from_below ? 1 : -1;
  }
  return turns;
}

// Where the triangle's plane is above (x, y); the triangle is not upright.
double height_at(const std::array<glm::vec3, 3>& corners, double x, double y) {
  const glm::dvec3 a(corners[0]), normal = glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
  return a.z - ((x - a.x) * normal.x + (y - a.y) * normal.y) / normal.z;
}

double square_distance(const glm::vec3& point, const TriangleTree::Node& node) {
  const glm::vec3 away = glm::max(glm::max(node.lower - point, point - node.upper), 0.0f);
  return 0.99999 * static_cast<double>(glm::dot(away, away));
}

}  // namespace

Box empty_box() {
  constexpr float kFar = std::numeric_limits<float>::max();
  return {glm::vec3(kFar), glm::vec3(-kFar)};
}

void Box::add(const glm::vec3& point) {
  lower = glm::min(lower, point);
  upper = glm::max(upper, point);
}

void Box::add(const Box& box) {
  lower = glm::min(lower, box.lower);
  upper = glm::max(upper, box.upper);
}

bool Box::contains(const glm::vec3& point) const {
  return point.x >= lower.x && point.y >= lower.y && point.z >= lower.z && point.x <= upper.x && point.y <= upper.y &&
         point.z <= upper.z;
}

bool Box::meets(const Box& other) const {
  return lower.x <= other.upper.x && lower.y <= other.upper.y && lower.z <= other.upper.z && upper.x >= other.lower.x &&
         upper.y >= other.lower.y && upper.z >= other.lower.z;
}

SolidTree::SolidTree(const TriangleMesh& mesh) : tree_(build_triangle_tree(mesh)), indices_(mesh.indices) {}

void SolidTree::move(std::span<const glm::vec3> positions) {
  for (std::size_t t = 0; t < tree_.triangles.size(); ++t) {
    const std::size_t first = 3 * std::size_t{tree_.numbers[t]};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      tree_.triangles[t][corner] = positions[indices_[first + corner]];
    }
  }
  // Children stand after their parents.
  for (std::size_t n = tree_.nodes.size(); n-- > 0;) {
    TriangleTree::Node& node = tree_.nodes[n];
    Box box = empty_box();
    if (node.count == 0) {
      box.add({tree_.nodes[n + 1].lower, tree_.nodes[n + 1].upper});
      box.add({tree_.nodes[node.first].lower, tree_.nodes[node.first].upper});
    }
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      for (const glm::vec3& corner : tree_.triangles[t]) box.add(corner);
    }
    node.lower = box.lower;
    node.upper = box.upper;
  }
}

Box SolidTree::box() const {
  return tree_.nodes.empty() ? empty_box() : Box{tree_.nodes[0].lower, tree_.nodes[0].upper};
}

int SolidTree::windings(const glm::vec3& point) const {
  if (tree_.nodes.empty()) return 0;
  const double x = double{point.x}, y = double{point.y}, z = double{point.z};
  std::array<std::uint32_t, kTreeStackSize> stack;
  std::size_t waiting = 0;
  stack[waiting++] = 0;
  int windings = 0;
  while (waiting > 0) {
    const std::uint32_t index = stack[--waiting];
    const TriangleTree::Node& node = tree_.nodes[index];
    if (point.x < node.lower.x || point.x > node.upper.x || point.y < node.lower.y || point.y > node.upper.y ||
        point.z > node.upper.z) {
      continue;
    }
    if (node.count == 0) {
      stack[waiting++] = node.first;
      stack[waiting++] = index + 1;
      continue;
    }
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      const std::array<glm::vec3, 3>& corners = tree_.triangles[t];
      const int turns = turns_round(corners, x, y);
      if (turns != 0 && height_at(corners, x, y) > z) windings += turns;
    }
  }
  return windings;
}

double SolidTree::distance_beyond(const glm::vec3& point, double enough) const {
  if (tree_.nodes.empty()) return std::numeric_limits<double>::max();
  const glm::dvec3 p(point);
  const double stop = enough * enough;
  double nearest = std::numeric_limits<double>::max();

  struct Waiting {
    std::uint32_t node;
    double distance;
  };
  std::array<Waiting, kTreeStackSize> stack;
  std::size_t waiting = 0;
  stack[waiting++] = {0, square_distance(point, tree_.nodes[0])};
  while (waiting > 0) {
    const auto [index, distance] = stack[--waiting];
    if (distance >= nearest) continue;
    const TriangleTree::Node& node = tree_.nodes[index];
    if (node.count == 0) {
      Waiting near{index + 1, square_distance(point, tree_.nodes[index + 1])};
      Waiting far{node.first, square_distance(point, tree_.nodes[node.first])};
      if (far.distance < near.distance) std::swap(near, far);
      stack[waiting++] = far;
      stack[waiting++] = near;
      continue;
    }
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      const std::array<glm::vec3, 3>& corners = tree_.triangles[t];
      const glm::dvec3 away = closest_point_on_triangle(p, corners[0], corners[1], corners[2]) - p;
      nearest = std::min(nearest, glm::dot(away, away));
    }
    if (nearest <= stop) break;
  }
  return std::sqrt(nearest);
}

}  // namespace fascicle::muscle
