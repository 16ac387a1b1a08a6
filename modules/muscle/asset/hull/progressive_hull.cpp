#include "modules/muscle/asset/hull/progressive_hull.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <queue>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/finite.hpp"
#include "engine/geometry/mesh_edges.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "modules/muscle/asset/hull/collapsing_mesh.hpp"
#include "modules/muscle/asset/hull/linear_program.hpp"

namespace fascicle::muscle {
namespace {

// Lengths are relative to the edge's surroundings: the furthest corner of its triangles from its midpoint.
constexpr double kReach = 50.0;     // of the linear program: places further away must gain in proportion
constexpr double kFurthest = 2.0;   // a new vertex further from the edge is a spike
constexpr double kSlack = 1.0e-9;   // by which a new vertex may be inside of a plane
// Shapes of the triangles that a collapse leaves. The limits keep the hull from folding over and passing through
// itself, and the coordinates on it smooth.
constexpr double kLeastCosine = 0.2;     // between a triangle's normals before and after
constexpr double kLeastShape = 0.05;     // 1: equilateral, 0: no area; or the worst that was there before. More makes
                                         // hulls of thin straps thick.
constexpr double kDegenerate = 1.0e-6;   // the same, whatever was there
// Added to the volume: times the edge's length cubed, so that among flat places, where no volume is added, the short
// edges go first; and times the cube of the new vertex's way from the edge, so that there are few thin spikes.
constexpr double kLengthCost = 1.0e-3;
constexpr double kWayCost = 3.0e-2;

// Four times the root of three times the area over the sum of the squared sides.
double shape_of(double area, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, bc = c - b, ca = a - c;
  const double sides = glm::dot(ab, ab) + glm::dot(bc, bc) + glm::dot(ca, ca);
  return sides > 0.0 ? 6.928203230275509 * area / sides : 0.0;
}

// How an edge would be collapsed.
struct Candidate {
  double cost = 0.0;           // m^3
  std::uint32_t u = 0, v = 0;  // u < v
  std::uint32_t revision = 0;  // the sum of both vertices' when it was planned
  glm::dvec3 place{0.0};

  bool operator>(const Candidate& other) const {
    return std::tie(cost, u, v) > std::tie(other.cost, other.u, other.v);
  }
};

class Collapser {
 public:
  // `within` is asked whether a place on a new triangle, relative to `centre`, is near enough to the fine mesh.
  Collapser(const TriangleMesh& mesh, const glm::dvec3& centre, std::function<bool(const glm::dvec3&)> within)
      : mesh_(mesh, centre), within_(std::move(within)) {}

  // Candidates are planned anew only when their turn comes: a collapse changes the surroundings of fifty edges, and
  // most of these change again before then. Edges that could not be collapsed are tried again when nothing else is left.
  void run(std::uint32_t vertices) {
    std::uint32_t tried = 0;
    while (mesh_.vertex_count() > vertices) {
      if (queue_.empty()) {
        if (tried == mesh_.vertex_end()) return;
        tried = mesh_.vertex_end();
        offer_all();
        continue;
      }
      const Candidate best = queue_.top();
      queue_.pop();
      if (!mesh_.alive(best.u) || !mesh_.alive(best.v)) continue;
      if (best.revision != mesh_.revision(best.u) + mesh_.revision(best.v)) {
        offer(best.u, best.v);
        continue;
      }
      const std::uint32_t made = mesh_.collapse(best.u, best.v, best.place);
      for (const std::uint32_t t : mesh_.fan(made)) {
        const CollapsingMesh::Triangle& triangle = mesh_.triangle(t);
        for (std::size_t k = 0; k < 3; ++k) {
          if (triangle[k] == made) offer(triangle[(k + 1) % 3], made);
        }
      }
    }
  }

  const CollapsingMesh& mesh() const { return mesh_; }

 private:
  struct StarTriangle {
    glm::dvec3 area{0.0};              // the triangle's as it is
    double size = 0.0;                 // m^2
    std::array<std::uint32_t, 2> rim;  // the corners that stay; the same twice where the triangle goes
  };

  void offer_all() {
    for (std::uint32_t t = 0; t < mesh_.triangle_end(); ++t) {
      if (!mesh_.triangle_alive(t)) continue;
      const CollapsingMesh::Triangle triangle = mesh_.triangle(t);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t u = triangle[k], v = triangle[(k + 1) % 3];
        if (u < v) offer(u, v);
      }
    }
  }

  void offer(std::uint32_t u, std::uint32_t v) {
    Candidate candidate{.u = std::min(u, v), .v = std::max(u, v), .revision = mesh_.revision(u) + mesh_.revision(v)};
    if (mesh_.can_collapse(u, v) && plan(candidate)) queue_.push(candidate);
  }

  // Finds the triangles around the edge, and returns the least shape among them.
  double gather(const Candidate& edge, const glm::dvec3& middle) {
    half_spaces_.clear();
    star_.clear();
    cost_ = glm::dvec3(0.0);
    area_ = offset_ = radius_ = 0.0;
    double least_shape = 1.0;
    for (const std::uint32_t from : {edge.u, edge.v}) {
      const std::uint32_t other = from == edge.u ? edge.v : edge.u;
      for (const std::uint32_t t : mesh_.fan(from)) {
        const CollapsingMesh::Triangle& triangle = mesh_.triangle(t);
        const bool shared = std::ranges::find(triangle, other) != triangle.end();
        if (shared && from == edge.v) continue;
        const glm::dvec3& area = mesh_.area(t);
        const double size = glm::length(area);
        std::array<glm::dvec3, 3> corners;
        std::size_t at = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          corners[k] = mesh_.position(triangle[k]) - middle;
          radius_ = std::max(radius_, glm::length(corners[k]));
          if (triangle[k] == from) at = k;
        }
        least_shape = std::min(least_shape, shape_of(size, corners[0], corners[1], corners[2]));
        if (size > 0.0) {
          const glm::dvec3 normal = area / size;
          const double offset = glm::dot(normal, corners[at]);
          half_spaces_.push_back({normal, offset});
          cost_ += area;
          area_ += size;
          offset_ += size * offset;
        }
        const std::uint32_t ahead = triangle[(at + 1) % 3];
        star_.push_back({area, size, {ahead, shared ? ahead : triangle[(at + 2) % 3]}});
      }
    }
    return least_shape;
  }

  bool keeps_shape(const glm::dvec3& place, double least_shape) const {
    const double least = std::max(std::min(kLeastShape, least_shape), kDegenerate);
    for (const StarTriangle& one : star_) {
      if (one.rim[0] == one.rim[1]) continue;
      const glm::dvec3 &a = mesh_.position(one.rim[0]), &b = mesh_.position(one.rim[1]);
      const glm::dvec3 area = 0.5 * glm::cross(a - place, b - place);
      const double size = glm::length(area);
      if (!(shape_of(size, place, a, b) >= least)) return false;
      if (glm::dot(area, one.area) < kLeastCosine * size * one.size) return false;
    }
    return true;
  }

  // The new vertex, and the middles of the triangles and edges that it would have: a long triangle may bridge a hollow
  // whose rims are near.
  bool stays_near(const glm::dvec3& place) const {
    if (!within_(place)) return false;
    for (const StarTriangle& one : star_) {
      if (one.rim[0] == one.rim[1]) continue;
      const glm::dvec3 &a = mesh_.position(one.rim[0]), &b = mesh_.position(one.rim[1]);
      if (!within_((place + a + b) / 3.0) || !within_(0.5 * (place + a))) return false;
    }
    return true;
  }

  bool plan(Candidate& candidate) {
    const glm::dvec3 &u = mesh_.position(candidate.u), &v = mesh_.position(candidate.v);
    const glm::dvec3 middle = 0.5 * (u + v);
    const double least_shape = gather(candidate, middle);
    if (!(area_ > 0.0)) return false;
    // What a collapse adds are the tetrahedra from the triangles to the new vertex: a third of the areas times the
    // heights above their planes. None is negative.
    const auto found = solve_linear_program(cost_ / area_, half_spaces_, kReach * radius_, kSlack * radius_);
    if (!found || !(glm::length(*found) <= kFurthest * radius_)) return false;
    candidate.place = middle + *found;
    if (!keeps_shape(candidate.place, least_shape) || !stays_near(candidate.place)) return false;
    const double length = glm::length(u - v), way = glm::length(*found);
    candidate.cost = (glm::dot(cost_, *found) - offset_) / 3.0 + kLengthCost * length * length * length +
                     kWayCost * way * way * way;
    return std::isfinite(candidate.cost);
  }

  CollapsingMesh mesh_;
  std::function<bool(const glm::dvec3&)> within_;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
  // Of the edge that is being planned; places are relative to its midpoint.
  std::vector<StarTriangle> star_;
  std::vector<HalfSpace> half_spaces_;
  glm::dvec3 cost_{0.0};  // m^2: the sum of the areas, as vectors
  double area_ = 0.0, offset_ = 0.0, radius_ = 0.0;
};

// What keeps the mesh from having a hull; empty where nothing does.
std::string fault_of(const TriangleMesh& mesh) {
  if (mesh.indices.empty() || mesh.indices.size() % 3 != 0) return "the mesh has no triangles";
  for (const std::uint32_t index : mesh.indices) {
    if (index >= mesh.positions.size()) return fmt::format("a triangle has corner {} of {}", index, mesh.positions.size());
    if (!is_finite(mesh.positions[index])) return fmt::format("vertex {} is no finite place", index);
  }
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const std::uint32_t a = mesh.indices[t], b = mesh.indices[t + 1], c = mesh.indices[t + 2];
    if (a == b || b == c || c == a) return fmt::format("triangle {} has a corner twice", t / 3);
  }
  const MeshEdges edges = find_edges(mesh.indices, mesh.positions.size());
  for (std::size_t e = 0; e < edges.count(); ++e) {
    const auto sides = edges.sides_of(e);
    if (sides.size() != 2) return fmt::format("an edge has {} triangles", sides.size());
    if (mesh.indices[sides[0]] == mesh.indices[sides[1]]) return "an edge runs the same way in both of its triangles";
  }
  const double volume = mesh_volume(mesh);
  if (!std::isfinite(volume) || !(volume > 0.0)) return fmt::format("the mesh encloses {:.6g} m^3", volume);
  return {};
}

Diagnostic warning_of(const HullTarget& target, std::size_t vertices) {
  if (target.error > 0.0f) {
    return {{}, 0, 0, {},
            fmt::format("a hull no further than {:.4g} mm away needs {} vertices, more than the {} asked for",
                        1000.0f * target.error, vertices, target.vertices),
            "ask for more vertices, or let the hull be further away"};
  }
  return {{}, 0, 0, {},
          fmt::format("the hull needs {} vertices, more than the {} asked for: no further edge collapses without "
                      "folding it", vertices, target.vertices),
          fmt::format("ask for {} or more", vertices)};
}

}  // namespace

Result<ProgressiveHull> build_progressive_hull(const TriangleMesh& mesh, const HullTarget& target) {
  if (std::string fault = fault_of(mesh); !fault.empty()) {
    return Diagnostic{{}, 0, 0, {}, std::move(fault), "a hull is made of a closed, outward surface alone"};
  }
  if (!std::isfinite(target.error) || target.error < 0.0f) {
    return Diagnostic{{}, 0, 0, {}, fmt::format("a hull is to be {} m away at most", target.error), "give 0 or more"};
  }
  const Bounds bounds = mesh_bounds(mesh);
  const glm::dvec3 centre = 0.5 * (glm::dvec3(bounds.lower) + glm::dvec3(bounds.upper));
  const ClosestPoints fine(mesh);
  Collapser collapser(mesh, centre, [&](const glm::dvec3& place) {
    return target.error == 0.0f || fine.within(glm::vec3(place + centre), target.error).distance < target.error;
  });
  collapser.run(target.vertices);

  ProgressiveHull hull;
  hull.mesh = collapser.mesh().finish();
  hull.mesh.name = mesh.name;
  hull.volume = mesh_volume(hull.mesh);
  hull.fine_volume = mesh_volume(mesh);
  for (const glm::vec3& position : hull.mesh.positions) {
    hull.distance = std::max(hull.distance, fine.at(position).distance);
  }
  Diagnostics found;
  const std::size_t vertices = hull.mesh.positions.size();
  if (vertices > target.vertices) found.warnings.push_back(warning_of(target, vertices));
  return Result<ProgressiveHull>(std::move(hull), std::move(found));
}

}  // namespace fascicle::muscle
