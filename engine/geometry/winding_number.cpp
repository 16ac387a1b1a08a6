#include "engine/geometry/winding_number.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/geometry/finite.hpp"
#include "engine/geometry/triangle_tree.hpp"

namespace fascicle {
namespace {

// A node counts as its expansion where the point is this many radii away from its centre.
constexpr double kFar = 2.3;

double half_solid_angle(const glm::dvec3& point, const glm::dvec3& corner_a, const glm::dvec3& corner_b,
                        const glm::dvec3& corner_c) {
  const glm::dvec3 a = corner_a - point, b = corner_b - point, c = corner_c - point;
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double determinant = glm::dot(a, glm::cross(b, c));
  if (determinant == 0.0) return 0.0;  // in the triangle's plane: atan2(0, negative) would take a side
  return std::atan2(determinant, la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

// The winding number of a patch of surface about a point q far away is the integral of n . g(x), g(x) = (x - q) /
// (4 pi |x - q|^3). With x = centre + y and r = centre - q, g's Taylor series about the centre leaves moments of the
// patch: n, n y, n y y / 2. As g's derivatives are symmetric, only the symmetric parts of the moments count.
struct Expansion {
  glm::dvec3 centre{0.0};
  double far_square = 0.0;    // (kFar radius)^2
  glm::dvec3 normal{0.0};     // the integral of n
  std::array<double, 6> first{};    // of n_i y_j: xx yy zz, and xy xz yz doubled
  std::array<double, 10> second{};  // of n_i y_j y_k / 2: xxx yyy zzz, 3 xxy, 3 xxz, 3 xyy, 3 yyz, 3 xzz, 3 yzz, 6 xyz

  double at(const glm::dvec3& point) const;
};

double Expansion::at(const glm::dvec3& point) const {
  const glm::dvec3 r = centre - point;
  const double square = glm::dot(r, r), inverse = 1.0 / square, cube = inverse / std::sqrt(square);
  const double trace = first[0] + first[1] + first[2];
  const double along = first[0] * r.x * r.x + first[1] * r.y * r.y + first[2] * r.z * r.z + first[3] * r.x * r.y +
                       first[4] * r.x * r.z + first[5] * r.y * r.z;
  const auto& s = second;
  const double cubic = s[0] * r.x * r.x * r.x + s[1] * r.y * r.y * r.y + s[2] * r.z * r.z * r.z +
                       s[3] * r.x * r.x * r.y + s[4] * r.x * r.x * r.z + s[5] * r.x * r.y * r.y +
                       s[6] * r.y * r.y * r.z + s[7] * r.x * r.z * r.z + s[8] * r.y * r.z * r.z +
                       s[9] * r.x * r.y * r.z;
  const glm::dvec3 contracted(s[0] + (s[5] + s[7]) / 3.0, s[1] + (s[3] + s[8]) / 3.0, s[2] + (s[4] + s[6]) / 3.0);
  return cube / (4.0 * std::numbers::pi) *
         (glm::dot(normal, r) + trace - 3.0 * inverse * along +
          inverse * (15.0 * inverse * cubic - 9.0 * glm::dot(contracted, r)));
}

Expansion expand(const TriangleTree& tree, std::size_t begin, std::size_t end) {
  Expansion e;
  double area = 0.0;
  glm::dvec3 weighted(0.0), mean(0.0);
  for (std::size_t t = begin; t < end; ++t) {
    const glm::dvec3 a = tree.triangles[t][0], b = tree.triangles[t][1], c = tree.triangles[t][2];
    const double size = glm::length(glm::cross(b - a, c - a));
    area += size;
    weighted += size / 3.0 * (a + b + c);
    mean += (a + b + c) / 3.0;
  }
  e.centre = area > 0.0 ? weighted / area : mean / static_cast<double>(end - begin);
  for (std::size_t t = begin; t < end; ++t) {
    std::array<glm::dvec3, 3> v;
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = glm::dvec3(tree.triangles[t][i]) - e.centre;
      e.far_square = std::max(e.far_square, glm::dot(v[i], v[i]));
    }
    const glm::dvec3 n = 0.5 * glm::cross(v[1] - v[0], v[2] - v[0]), middle = (v[0] + v[1] + v[2]) / 3.0;
    e.normal += n;
    e.first[0] += n.x * middle.x;
    e.first[1] += n.y * middle.y;
    e.first[2] += n.z * middle.z;
    e.first[3] += n.x * middle.y + n.y * middle.x;
    e.first[4] += n.x * middle.z + n.z * middle.x;
    e.first[5] += n.y * middle.z + n.z * middle.y;
    // The mean of y_j y_k over a triangle is (the corners' sum of v_j v_k + 9 middle_j middle_k) / 12; halved.
    const auto m = [&](int j, int k) {
      return (v[0][j] * v[0][k] + v[1][j] * v[1][k] + v[2][j] * v[2][k] + 9.0 * middle[j] * middle[k]) / 24.0;
    };
    const double xx = m(0, 0), yy = m(1, 1), zz = m(2, 2), xy = m(0, 1), xz = m(0, 2), yz = m(1, 2);
    e.second[0] += n.x * xx;
    e.second[1] += n.y * yy;
    e.second[2] += n.z * zz;
    e.second[3] += n.y * xx + 2.0 * n.x * xy;
    e.second[4] += n.z * xx + 2.0 * n.x * xz;
    e.second[5] += n.x * yy + 2.0 * n.y * xy;
    e.second[6] += n.z * yy + 2.0 * n.y * yz;
    e.second[7] += n.x * zz + 2.0 * n.z * xz;
    e.second[8] += n.y * zz + 2.0 * n.z * yz;
    e.second[9] += 2.0 * (n.x * yz + n.y * xz + n.z * xy);
  }
  e.far_square *= kFar * kFar;
  return e;
}

}  // namespace

double winding_number(const TriangleMesh& mesh, const glm::dvec3& point) {
  if (!is_finite(point)) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3& a = mesh.positions[mesh.indices[i]];
    const glm::vec3& b = mesh.positions[mesh.indices[i + 1]];
    const glm::vec3& c = mesh.positions[mesh.indices[i + 2]];
    if (is_finite(a) && is_finite(b) && is_finite(c)) sum += half_solid_angle(point, a, b, c);
  }
  return sum / (2.0 * std::numbers::pi);
}

struct WindingField::State {
  TriangleTree tree;
  std::vector<Expansion> expansions;  // by node

  // Fills the expansions of a node and those below; returns where its triangles end.
  std::size_t fill(std::uint32_t index, std::size_t begin) {
    const TriangleTree::Node& node = tree.nodes[index];
    const std::size_t end = node.count > 0 ? begin + node.count : fill(node.first, fill(index + 1, begin));
    expansions[index] = expand(tree, begin, end);
    return end;
  }
};

WindingField::WindingField(const TriangleMesh& mesh) {
  auto state = std::make_unique<State>();
  state->tree = build_triangle_tree(mesh);
  state->expansions.resize(state->tree.nodes.size());
  if (!state->tree.nodes.empty()) state->fill(0, 0);
  state_ = std::move(state);
}
WindingField::~WindingField() = default;
WindingField::WindingField(WindingField&&) noexcept = default;
WindingField& WindingField::operator=(WindingField&&) noexcept = default;

double WindingField::at(const glm::dvec3& point) const {
  const TriangleTree& tree = state_->tree;
  if (tree.nodes.empty() || !is_finite(point)) return 0.0;
  std::array<std::uint32_t, kTreeStackSize> stack;
  std::size_t waiting = 0;
  stack[waiting++] = 0;
  double far = 0.0, near = 0.0;
  while (waiting > 0) {
    const std::uint32_t index = stack[--waiting];
    const TriangleTree::Node& node = tree.nodes[index];
    const Expansion& expansion = state_->expansions[index];
    const glm::dvec3 offset = point - expansion.centre;
    if (glm::dot(offset, offset) > expansion.far_square) {
      far += expansion.at(point);
    } else if (node.count == 0) {
      stack[waiting++] = node.first;
      stack[waiting++] = index + 1;
    } else {
      for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
        const std::array<glm::vec3, 3>& corners = tree.triangles[t];
        near += half_solid_angle(point, corners[0], corners[1], corners[2]);
      }
    }
  }
  return far + near / (2.0 * std::numbers::pi);
}

}  // namespace fascicle
