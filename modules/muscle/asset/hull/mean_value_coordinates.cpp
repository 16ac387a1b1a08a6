// How it is done. Seen from a point x, the hull's vertices are unit directions u at distances d, and a triangle is a
// spherical one whose mean vector m = integral of the direction is half the sum of its sides' angles times their unit
// normals, by Stokes. With m = sum of lambda u over the triangle's corners each corner gets lambda / d, and since the
// mean vectors of a closed mesh sum to zero, so do all lambda u: the weights have linear precision (Ju et al. 2005).
//
// Instead of their formulas with arc sines this one solves the 3 x 3 system by Cramer's rule on the cross products
// X_a = u_b x u_c, which stays good next to the hull: there both lambda and 1 / determinant grow without a bound, but a
// triangle's three lambda have that factor in common, and a side's normal, uncertain as it is next to an edge, is the
// same in both of its triangles. The side's angle comes from sine and cosine together; arc cosines would lose it at 0
// and pi. Against sums in 113 bits every weight of the real hulls is right to half a last digit of a float.
//
// Two points go side by side, for each the same operations in the same order.
#include "modules/muscle/asset/hull/mean_value_coordinates.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/finite.hpp"
#include "engine/geometry/mesh_edges.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/parallel/for_range.hpp"

namespace fascicle::muscle {
namespace {

// A triangle whose mean vector is less than this part of its longest side's angle is seen from its plane, outside of
// it, or is none: what it would add is as small, and rounding divided by this is as small, too.
constexpr double kEdgeOn = 1.0e-8;
// Sine of an angle of pi at which the point is on the edge.
constexpr double kOnEdge = 1.0e-15;
// Of a row, relative to the hull's size, from which on it is corrected.
constexpr double kResidual = 1.0e-12;
// Weights that cancel to less than this part of their sum of magnitudes have no sum at all.
constexpr double kNoSum = 1.0e-9;

constexpr std::size_t kPointsPerChunk = 64;
constexpr std::size_t kLanes = 2;  // as many as every processor's registers hold: wider ones go by single numbers
typedef double Wide __attribute__((vector_size(kLanes * sizeof(double))));

struct WideVectors {
  Wide x, y, z;
};
WideVectors operator+(const WideVectors& a, const WideVectors& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
WideVectors operator*(const Wide& s, const WideVectors& a) { return {s * a.x, s * a.y, s * a.z}; }
Wide dot(const WideVectors& a, const WideVectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
WideVectors cross(const WideVectors& a, const WideVectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Wide broadcast(double value) { return Wide{} + value; }
Wide larger(const Wide& a, const Wide& b) { return a < b ? b : a; }
Wide square_root(const Wide& a) {
  Wide root;
  for (std::size_t lane = 0; lane < kLanes; ++lane) root[lane] = std::sqrt(a[lane]);
  return root;
}

// The angle in [0, pi] with this sine >= 0 and cosine, not both 0, to rounding: reduced by eighths of a turn to
// |t| <= tan(pi / 8), where atan(t) = t + t^3 R(t^2) with R of least error, 3e-17.
Wide angle_of(const Wide& sine, const Wide& cosine) {
  constexpr double kPi = std::numbers::pi, kSteep = 2.414213562373095, kFlat = 0.41421356237309505;
  const Wide c = cosine < 0.0 ? -cosine : cosine;
  const auto steep = sine > kSteep * c, middle = sine > kFlat * c;
  const Wide upper = steep ? -c : middle ? sine - c : sine;
  const Wide lower = steep ? sine : middle ? sine + c : c;
  const Wide base = steep ? broadcast(0.5 * kPi) : middle ? broadcast(0.25 * kPi) : Wide{};
  const Wide t = upper / lower, z = t * t;
  Wide r = broadcast(-0.019176887119062259);
  for (const double coefficient :
       {0.0392316582955871913, -0.0508544973794025986, 0.0585814891280220988, -0.06664511447381948,
        0.0769218319082608656, -0.0909090457812390189, 0.111111110152563617, -0.142857142846665429,
        0.199999999999955207, -0.333333333333333302}) {
    r = r * z + coefficient;
  }
  const Wide angle = base + (t + t * z * r);
  return cosine < 0.0 ? kPi - angle : angle;
}

struct Hull {
  struct Edge {
    std::uint32_t a, b;
  };
  struct Triangle {
    std::array<std::uint32_t, 3> corner, opposite;  // the edge across from each corner
  };
  std::vector<glm::dvec3> positions;  // m
  std::vector<Edge> edges;
  std::vector<Triangle> triangles;
  // For corrections: positions about their mean, as parts of the size, and the inverse of the sum of their squares.
  glm::dvec3 mean{0.0};
  double size = 0.0;                  // m
  std::vector<glm::dvec3> about;
  glm::dmat3 inverse{0.0};            // zero where the vertices lie in a plane
};

// Without triangles where it has no area, or is not finite.
Hull prepare(const TriangleMesh& mesh) {
  Hull hull;
  const std::size_t count = mesh.positions.size();
  for (const glm::vec3& p : mesh.positions) {
    if (!is_finite(p)) return hull;
    hull.positions.emplace_back(p);
  }
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    if (a < count && b < count && c < count && a != b && b != c && c != a) indices.insert(indices.end(), {a, b, c});
  }
  double area = 0.0;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const glm::dvec3& a = hull.positions[indices[i]];
    area += glm::length(glm::cross(hull.positions[indices[i + 1]] - a, hull.positions[indices[i + 2]] - a));
  }
  if (!(area > 0.0)) return hull;

  const MeshEdges edges = find_edges(indices, count);
  std::vector<std::uint32_t> edge_of(indices.size());
  for (std::size_t e = 0; e < edges.count(); ++e) {
    for (const std::uint32_t side : edges.sides_of(e)) edge_of[side] = static_cast<std::uint32_t>(e);
    const std::uint32_t side = edges.sides_of(e).front();
    hull.edges.push_back({indices[side], indices[next_side(side)]});
  }
  for (std::uint32_t i = 0; i < indices.size(); i += 3) {
    hull.triangles.push_back({{indices[i], indices[i + 1], indices[i + 2]},
                              {edge_of[i + 1], edge_of[i + 2], edge_of[i]}});
  }

  for (const glm::dvec3& p : hull.positions) hull.mean += p / static_cast<double>(count);
  for (const glm::dvec3& p : hull.positions) hull.size = std::max(hull.size, glm::distance(p, hull.mean));
  glm::dmat3 squares(0.0);
  for (const glm::dvec3& p : hull.positions) {
    hull.about.push_back((p - hull.mean) / hull.size);
    squares += glm::outerProduct(hull.about.back(), hull.about.back());
  }
  const double trace = squares[0][0] + squares[1][1] + squares[2][2];
  if (glm::determinant(squares) > 1.0e-12 * trace * trace * trace) hull.inverse = glm::inverse(squares);
  return hull;
}

// A point on a vertex, an edge or, if nothing else, a triangle of the hull: calls weigh(vertex, weight) for each of its
// corners.
template <class Weigh>
void weigh_on_hull(const Hull& hull, const glm::dvec3& x, Weigh&& weigh) {
  for (std::uint32_t v = 0; v < hull.positions.size(); ++v) {
    if (hull.positions[v] == x) return weigh(v, 1.0);
  }
  for (const Hull::Edge& edge : hull.edges) {
    const glm::dvec3 a = hull.positions[edge.a] - x, b = hull.positions[edge.b] - x;
    const double la = glm::length(a), lb = glm::length(b);
    if (glm::dot(a, b) < 0.0 && glm::length(glm::cross(a, b)) <= 2.0 * kOnEdge * la * lb) {
      weigh(edge.a, lb / (la + lb));
      return weigh(edge.b, la / (la + lb));
    }
  }
  const Hull::Triangle* nearest = nullptr;
  double least = 0.0;
  for (const Hull::Triangle& triangle : hull.triangles) {
    const glm::dvec3 &a = hull.positions[triangle.corner[0]], &b = hull.positions[triangle.corner[1]],
                     &c = hull.positions[triangle.corner[2]];
    if (glm::cross(b - a, c - a) == glm::dvec3(0.0)) continue;
    const double distance = glm::distance(closest_point_on_triangle(x, a, b, c), x);
    if (!nearest || distance < least) nearest = &triangle, least = distance;
  }
  const std::array<std::uint32_t, 3>& corner = nearest->corner;
  const glm::dvec3 a = hull.positions[corner[0]] - x, b = hull.positions[corner[1]] - x,
                   c = hull.positions[corner[2]] - x;
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double square = glm::dot(normal, normal);
  weigh(corner[0], glm::dot(glm::cross(b, c), normal) / square);
  weigh(corner[1], glm::dot(glm::cross(c, a), normal) / square);
  weigh(corner[2], glm::dot(glm::cross(a, b), normal) / square);
}

// A few points' rows, for one chunk of points after another.
class WideRows {
 public:
  explicit WideRows(const Hull& hull)
      : hull_(hull), directions_(hull.positions.size()), sides_(hull.edges.size()), rows_(hull.positions.size()) {}

  // `out`: a row of the hull's vertices for each point.
  void find(std::span<const glm::vec3> points, float* out) {
    std::array<glm::dvec3, kLanes> x;
    WideVectors at;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      x[lane] = points[std::min(lane, points.size() - 1)];
      at.x[lane] = x[lane].x, at.y[lane] = x[lane].y, at.z[lane] = x[lane].z;
    }
    const Wide on_hull = weigh(at);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (on_hull[lane] == 0.0) continue;
      for (Row& row : rows_) row.weight[lane] = 0.0;
      weigh_on_hull(hull_, x[lane], [&](std::uint32_t v, double weight) { rows_[v].weight[lane] = weight; });
    }
    const Wide exists = normalise(at);
    const std::size_t count = rows_.size();
    for (std::size_t lane = 0; lane < points.size(); ++lane) {
      float* row = out + lane * count;
      for (std::size_t v = 0; v < count; ++v) row[v] = static_cast<float>(rows_[v].weight[lane]);
      if (exists[lane] == 0.0) std::fill_n(row, count, 1.0f / static_cast<float>(count));
    }
  }

 private:
  struct Direction {
    WideVectors unit;
    Wide inverse;  // 1 / m
  };
  struct Side {
    Wide ratio;    // angle / sine
  };
  struct Row {
    Wide weight;
  };

  // Not yet normalised. 1 in lanes whose point lies on the hull, and 0 in the others.
  Wide weigh(const WideVectors& at) {
    Wide on_hull{};
    for (std::size_t v = 0; v < rows_.size(); ++v) {
      const glm::dvec3& p = hull_.positions[v];
      const WideVectors way{p.x - at.x, p.y - at.y, p.z - at.z};
      const Wide distance = square_root(dot(way, way));
      const Wide inverse = 1.0 / (distance == 0.0 ? broadcast(1.0) : distance);
      on_hull = distance == 0.0 ? broadcast(1.0) : on_hull;
      directions_[v] = {inverse * way, inverse};
      rows_[v].weight = Wide{};
    }
    for (std::size_t e = 0; e < sides_.size(); ++e) {
      const WideVectors &a = directions_[hull_.edges[e].a].unit, &b = directions_[hull_.edges[e].b].unit;
      const WideVectors normal = cross(a, b);
      const Wide sine = square_root(dot(normal, normal)), cosine = dot(a, b);
      const auto straight = sine <= kOnEdge;
      on_hull = straight && cosine < 0.0 ? broadcast(1.0) : on_hull;
      // At an angle of 0 the ratio is 1.
      sides_[e].ratio = straight ? broadcast(1.0) : angle_of(sine, cosine) / sine;
    }
    for (const Hull::Triangle& triangle : hull_.triangles) {
      const WideVectors &ua = directions_[triangle.corner[0]].unit, &ub = directions_[triangle.corner[1]].unit,
                        &uc = directions_[triangle.corner[2]].unit;
      const Wide ra = sides_[triangle.opposite[0]].ratio, rb = sides_[triangle.opposite[1]].ratio,
                 rc = sides_[triangle.opposite[2]].ratio;
      const WideVectors xa = cross(ub, uc), xb = cross(uc, ua), xc = cross(ua, ub);
      const WideVectors mean = ra * xa + (rb * xb + rc * xc);  // twice
      const Wide longest =  // angle, squared
          larger(ra * ra * dot(xa, xa), larger(rb * rb * dot(xb, xb), rc * rc * dot(xc, xc)));
      const Wide determinant = dot(xa, ua);
      const auto counts = dot(mean, mean) > 4.0 * kEdgeOn * kEdgeOn * longest;
      const auto flat = determinant == 0.0;
      on_hull = counts && flat ? broadcast(1.0) : on_hull;
      const Wide inverse = counts ? 1.0 / (flat ? broadcast(1.0) : determinant) : Wide{};
      rows_[triangle.corner[0]].weight += dot(mean, xa) * inverse;
      rows_[triangle.corner[1]].weight += dot(mean, xb) * inverse;
      rows_[triangle.corner[2]].weight += dot(mean, xc) * inverse;
    }
    for (std::size_t v = 0; v < rows_.size(); ++v) rows_[v].weight *= directions_[v].inverse;
    return on_hull;
  }

  // To a sum of 1; then, where the rows miss 1 or the point by more than kResidual, by the least change (in the sum of
  // squares over all vertices) that does not: delta_v = a + b . p_v. 0 in lanes whose weights have no sum, else 1.
  Wide normalise(const WideVectors& at) {
    Wide sum{}, magnitude{};
    for (const Row& row : rows_) {
      sum += row.weight;
      magnitude += row.weight < 0.0 ? -row.weight : row.weight;
    }
    const Wide scale = 1.0 / sum;
    Wide one = broadcast(1.0);
    WideVectors rest{(at.x - hull_.mean.x) / hull_.size, (at.y - hull_.mean.y) / hull_.size,
                     (at.z - hull_.mean.z) / hull_.size};
    for (std::size_t v = 0; v < rows_.size(); ++v) {
      Wide& weight = rows_[v].weight;
      weight *= scale;
      one -= weight;
      const glm::dvec3& p = hull_.about[v];
      rest.x -= weight * p.x, rest.y -= weight * p.y, rest.z -= weight * p.z;
    }
    const Wide miss = one * one + dot(rest, rest);
    const Wide wanted = miss > kResidual * kResidual ? broadcast(1.0) : Wide{};
    const Wide a = wanted * one / static_cast<double>(rows_.size());
    const glm::dmat3& m = hull_.inverse;
    const WideVectors b{wanted * (m[0][0] * rest.x + m[1][0] * rest.y + m[2][0] * rest.z),
                        wanted * (m[0][1] * rest.x + m[1][1] * rest.y + m[2][1] * rest.z),
                        wanted * (m[0][2] * rest.x + m[1][2] * rest.y + m[2][2] * rest.z)};
    for (std::size_t v = 0; v < rows_.size(); ++v) {
      const glm::dvec3& p = hull_.about[v];
      rows_[v].weight += a + (b.x * p.x + b.y * p.y + b.z * p.z);
    }
    // Not so where something is no number, either.
    return (sum < 0.0 ? -sum : sum) > kNoSum * magnitude && magnitude * 0.0 == 0.0 ? broadcast(1.0) : Wide{};
  }

  const Hull& hull_;
  std::vector<Direction> directions_;  // by vertex, from the points to it
  std::vector<Side> sides_;            // by edge
  std::vector<Row> rows_;              // by vertex
};

}  // namespace

void find_mean_value_coordinates(const TriangleMesh& hull, std::span<const glm::vec3> points,
                                 std::span<float> weights) {
  const std::size_t count = hull.positions.size();
  assert(weights.size() == points.size() * count);
  if (count == 0) return;
  const Hull prepared = prepare(hull);
  if (prepared.triangles.empty()) {
    std::fill(weights.begin(), weights.end(), 1.0f / static_cast<float>(count));
    return;
  }
  parallel::for_range(points.size(), kPointsPerChunk, [&](std::size_t begin, std::size_t end) {
    WideRows rows(prepared);
    for (std::size_t i = begin; i < end; i += kLanes) {
      rows.find(points.subspan(i, std::min(kLanes, end - i)), weights.data() + i * count);
    }
  });
}

}  // namespace fascicle::muscle
