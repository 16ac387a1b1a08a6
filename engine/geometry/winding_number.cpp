#include "engine/geometry/winding_number.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/geometry/finite.hpp"
#include "engine/geometry/for_each_triangle.hpp"
#include "engine/geometry/triangle_tree.hpp"

namespace fascicle {
namespace {

// A node counts as its expansion where the point is this many radii away from its centre.
constexpr double kFar = 3.0;
// More than the field is ever wrong by at that distance.
constexpr double kFieldError = 5e-3;

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
  double area = 0.0;          // m^2
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

// (a . r)(b . r) as a quadratic form's coefficients, added to `form`.
void add_product(const glm::dvec3& a, const glm::dvec3& b, std::array<double, 6>& form) {
  form[0] += a.x * b.x;
  form[1] += a.y * b.y;
  form[2] += a.z * b.z;
  form[3] += a.x * b.y + a.y * b.x;
  form[4] += a.x * b.z + a.z * b.x;
  form[5] += a.y * b.z + a.z * b.y;
}

// form(r) (a . r), added to `cubic`.
void add_product(const std::array<double, 6>& form, const glm::dvec3& a, std::array<double, 10>& cubic) {
  cubic[0] += form[0] * a.x;
  cubic[1] += form[1] * a.y;
  cubic[2] += form[2] * a.z;
  cubic[3] += form[0] * a.y + form[3] * a.x;
  cubic[4] += form[0] * a.z + form[4] * a.x;
  cubic[5] += form[1] * a.x + form[3] * a.y;
  cubic[6] += form[1] * a.z + form[5] * a.y;
  cubic[7] += form[2] * a.x + form[4] * a.z;
  cubic[8] += form[2] * a.y + form[5] * a.z;
  cubic[9] += form[3] * a.z + form[4] * a.y + form[5] * a.x;
}

// One triangle's moments about `centre`.
void add_triangle(const std::array<glm::vec3, 3>& corners, Expansion& e) {
  std::array<glm::dvec3, 3> v;
  for (std::size_t i = 0; i < 3; ++i) v[i] = glm::dvec3(corners[i]) - e.centre;
  const glm::dvec3 n = 0.5 * glm::cross(v[1] - v[0], v[2] - v[0]), middle = (v[0] + v[1] + v[2]) / 3.0;
  e.normal += n;
  add_product(n, middle, e.first);
  // The mean of y y over a triangle is (the corners' sum of v v + 9 middle middle) / 12; here halved.
  std::array<double, 6> square{};
  for (const glm::dvec3& corner : v) add_product(corner / 24.0, corner, square);
  add_product(9.0 / 24.0 * middle, middle, square);
  add_product(square, n, e.second);
}

// The moments of a part that is expanded about another point: y + d, d from `whole`'s centre to `part`'s.
void add_part(const Expansion& part, Expansion& whole) {
  const glm::dvec3 d = part.centre - whole.centre;
  whole.normal += part.normal;
  for (std::size_t i = 0; i < 6; ++i) whole.first[i] += part.first[i];
  for (std::size_t i = 0; i < 10; ++i) whole.second[i] += part.second[i];
  add_product(part.normal, d, whole.first);
  add_product(part.first, d, whole.second);
  std::array<double, 6> square{};
  add_product(0.5 * d, d, square);
  add_product(square, part.normal, whole.second);
}

}  // namespace

double winding_number(const TriangleMesh& mesh, const glm::dvec3& point) {
  if (!is_finite(point)) return 0.0;
  double sum = 0.0;
  for_each_triangle(mesh, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    sum += half_solid_angle(point, a, b, c);
  });
  return sum / (2.0 * std::numbers::pi);
}

struct WindingField::State {
  TriangleTree tree;
  std::vector<Expansion> expansions;  // by node

  // Fills the expansions of a node and those below; returns where its triangles end.
  std::size_t fill(std::uint32_t index, std::size_t begin) {
    const TriangleTree::Node& node = tree.nodes[index];
    const bool leaf = node.count > 0;
    const std::size_t end = leaf ? begin + node.count : fill(node.first, fill(index + 1, begin));
    Expansion& e = expansions[index];
    glm::dvec3 weighted(0.0);
    const auto weigh = [&](double area, const glm::dvec3& centre) {
      e.area += area;
      weighted += area * centre;
    };
    if (leaf) {
      for (std::size_t t = begin; t < end; ++t) {
        const glm::dvec3 a = tree.triangles[t][0], b = tree.triangles[t][1], c = tree.triangles[t][2];
        weigh(0.5 * glm::length(glm::cross(b - a, c - a)), (a + b + c) / 3.0);
      }
    } else {
      for (const std::uint32_t child : {index + 1, node.first}) weigh(expansions[child].area, expansions[child].centre);
    }
    e.centre = e.area > 0.0 ? weighted / e.area : 0.5 * (glm::dvec3(node.lower) + glm::dvec3(node.upper));
    if (leaf) {
      for (std::size_t t = begin; t < end; ++t) add_triangle(tree.triangles[t], e);
    } else {
      for (const std::uint32_t child : {index + 1, node.first}) add_part(expansions[child], e);
    }
    for (std::size_t t = begin; t < end; ++t) {
      for (const glm::dvec3 corner : tree.triangles[t]) {
        e.far_square = std::max(e.far_square, kFar * kFar * glm::dot(corner - e.centre, corner - e.centre));
      }
    }
    return end;
  }

  double exact(const glm::dvec3& point) const {
    double sum = 0.0;
    for (const std::array<glm::vec3, 3>& t : tree.triangles) sum += half_solid_angle(point, t[0], t[1], t[2]);
    return sum / (2.0 * std::numbers::pi);
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

bool WindingField::inside(const glm::dvec3& point) const {
  const double about = at(point);
  return (std::abs(about - 0.5) > kFieldError ? about : state_->exact(point)) > 0.5;
}

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
  const double sum = far + near / (2.0 * std::numbers::pi);
  return std::isfinite(sum) ? sum : state_->exact(point);  // a node without extent, all but at the point
}

}  // namespace fascicle
