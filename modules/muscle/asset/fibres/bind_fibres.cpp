#include "modules/muscle/asset/fibres/bind_fibres.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/ray_scene.hpp"
#include "engine/parallel/for_range.hpp"

namespace fascicle::muscle {
namespace {

constexpr std::size_t kDirections = 40;   // over half a sphere: the best chord is found within some 15 degrees
constexpr std::size_t kTries = 4;         // chords, the best first, until one has a free view
constexpr double kGrazing = 0.05;         // sines of angles below count as this: such a chord is bad enough
constexpr double kTouch = 1.0e-4;         // of the way to the vertex behind: nearer to it are its own triangles
constexpr std::size_t kChunk = 64;

std::array<glm::dvec3, kDirections> spread_directions() {
  std::array<glm::dvec3, kDirections> directions;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (std::size_t i = 0; i < kDirections; ++i) {
    const double z = (static_cast<double>(i) + 0.5) / static_cast<double>(kDirections);
    const double r = std::sqrt(1.0 - z * z), angle = golden * static_cast<double>(i);
    directions[i] = {r * std::cos(angle), r * std::sin(angle), z};
  }
  return directions;
}

using Corners = std::array<glm::dvec3, 3>;

glm::dvec3 unit_normal(const Corners& corner) {
  const glm::dvec3 n = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double length = glm::length(n);
  return length > 0.0 ? n / length : glm::dvec3(0.0);
}

// Factors of a triangle's corners, summing to 1, that give the place nearest to `p` in its plane; zero where it has
// none.
glm::dvec3 barycentric(const glm::dvec3& p, const Corners& corner) {
  const glm::dvec3 n = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double square = glm::dot(n, n);
  if (!(square > 0.0)) return glm::dvec3(0.0);
  const double b = glm::dot(n, glm::cross(p - corner[0], corner[2] - corner[0])) / square;
  const double c = glm::dot(n, glm::cross(corner[1] - corner[0], p - corner[0])) / square;
  return {1.0 - b - c, b, c};
}

// The part of a line within the mesh that holds t = 0.
struct Chord {
  double cost = 0.0;           // m: the length, more where it meets a face at a slant
  std::uint32_t far = 0;       // the triangle at its further end
};

class Binder {
 public:
  explicit Binder(const TriangleMesh& mesh)
      : mesh_(mesh), scene_(device_, mesh), surface_(mesh), directions_(spread_directions()) {}

  FibreBinding bind(const glm::dvec3& p) const {
    std::vector<Chord> chords = chords_through(p);
    std::ranges::stable_sort(chords, [](const Chord& a, const Chord& b) { return a.cost < b.cost; });
    if (chords.size() > kTries) chords.resize(kTries);
    for (const Chord& chord : chords)
      if (const std::optional<FibreBinding> binding = bind_across(p, chord.far)) return *binding;
    return bind_below(p);
  }

 private:
  Corners corners(std::uint32_t triangle) const {
    return {glm::dvec3(mesh_.positions[mesh_.indices[3 * triangle]]),
            glm::dvec3(mesh_.positions[mesh_.indices[3 * triangle + 1]]),
            glm::dvec3(mesh_.positions[mesh_.indices[3 * triangle + 2]])};
  }

  // The sine of the angle at which a direction meets a triangle.
  double squareness(std::uint32_t triangle, const glm::dvec3& direction) const {
    return std::max(std::abs(glm::dot(unit_normal(corners(triangle)), direction)), kGrazing);
  }

  std::vector<Chord> chords_through(const glm::dvec3& p) const {
    std::array<Line, kDirections> lines;
    for (std::size_t i = 0; i < kDirections; ++i) lines[i] = {glm::vec3(p), glm::vec3(directions_[i])};
    std::vector<std::uint32_t> starts;
    std::vector<LineCrossing> crossings;
    scene_.cast_all(lines, starts, crossings);
    std::vector<Chord> chords;
    for (std::size_t i = 0; i < kDirections; ++i) {
      const LineCrossing *before = nullptr, *after = nullptr;
      for (std::uint32_t k = starts[i]; k < starts[i + 1]; ++k) {
        if (crossings[k].t <= 0.0f) before = &crossings[k];
        if (crossings[k].t > 0.0f && after == nullptr) after = &crossings[k];
      }
      if (before == nullptr || after == nullptr || before->exit || !after->exit) continue;
      const double length = static_cast<double>(after->t) - static_cast<double>(before->t);
      const double square = squareness(before->triangle, directions_[i]) * squareness(after->triangle, directions_[i]);
      chords.push_back({length / square,
                        -before->t > after->t ? before->triangle : after->triangle});
    }
    return chords;
  }

  // From a corner of the triangle through the point to the surface on this side.
  std::optional<FibreBinding> bind_across(const glm::dvec3& p, std::uint32_t far) const {
    std::array<Line, 3> lines;
    std::array<double, 3> behind{};
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 way = p - corners(far)[k];
      behind[k] = glm::length(way);
      if (!(behind[k] > 0.0)) return std::nullopt;
      lines[k] = {glm::vec3(p), glm::vec3(way / behind[k])};
    }
    std::vector<std::uint32_t> starts;
    std::vector<LineCrossing> crossings;
    scene_.cast_all(lines, starts, crossings);
    std::optional<FibreBinding> best;
    double least = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const LineCrossing* after = nullptr;
      bool free = true;
      for (std::uint32_t c = starts[k]; c < starts[k + 1]; ++c) {
        const double t = static_cast<double>(crossings[c].t);
        if (t <= 0.0 && t > -behind[k] * (1.0 - kTouch)) free = false;
        if (t > 0.0 && after == nullptr) after = &crossings[c];
      }
      if (!free || after == nullptr || !after->exit) continue;
      const double length = behind[k] + static_cast<double>(after->t);
      const double cost = length / squareness(after->triangle, glm::dvec3(lines[k].direction));
      if (best && cost >= least) continue;
      if (const std::optional<FibreBinding> binding = bend(p, mesh_.indices[3 * far + k], after->triangle)) {
        best = binding;
        least = cost;
      }
    }
    return best;
  }

  // The parabola from the triangle to the vertex, through `p` at rest; nothing where the triangle has no area.
  std::optional<FibreBinding> bend(const glm::dvec3& p, std::uint32_t vertex, std::uint32_t triangle) const {
    const Corners corner = corners(triangle);
    const glm::dvec3 v(mesh_.positions[vertex]), normal = unit_normal(corner);
    const double across = glm::dot(v - corner[0], normal);  // of the whole chord: negative, inwards
    if (!(across < 0.0)) return std::nullopt;
    // h from the line itself, so that p is met exactly.
    const double u = glm::dot(p - corner[0], normal) / across, s = 1.0 - u;
    if (!(u >= 0.0 && u < 1.0)) return std::nullopt;
    const glm::dvec3 h = (p - u * v) / s;
    const glm::dvec3 at_h = barycentric(h, corner), at_v = barycentric(v, corner);
    const glm::dvec3 weights = (s * s + 2.0 * s * u) * at_h + s * u * (at_v - at_h);
    return make(triangle, weights, vertex, u * u, s * u * across);
  }

  // Held by the nearest triangle alone, as far under it as it is.
  FibreBinding bind_below(const glm::dvec3& p) const {
    const std::uint32_t nearest = surface_.at(glm::vec3(p)).triangle;
    const Corners corner = corners(nearest);
    const glm::dvec3 weights = barycentric(p, corner);
    const glm::dvec3 whole = weights == glm::dvec3(0.0) ? glm::dvec3(1.0, 0.0, 0.0) : weights;
    return make(nearest, whole, mesh_.indices[3 * nearest], 0.0, glm::dot(p - corner[0], unit_normal(corner)));
  }

  FibreBinding make(std::uint32_t triangle, const glm::dvec3& weights, std::uint32_t vertex, double last,
                    double rise) const {
    const std::uint32_t* corner = &mesh_.indices[3 * triangle];
    return {{corner[0], corner[1], corner[2], vertex},
            {static_cast<float>(weights.x), static_cast<float>(weights.y), static_cast<float>(weights.z),
             static_cast<float>(last)},
            static_cast<float>(rise)};
  }

  const TriangleMesh& mesh_;
  RayDevice device_;
  RayScene scene_;
  ClosestPoints surface_;
  std::array<glm::dvec3, kDirections> directions_;
};

}  // namespace

AlignedVector<FibreBinding> bind_fibres(const TriangleMesh& mesh, std::span<const glm::dvec3> points) {
  const Binder binder(mesh);
  AlignedVector<FibreBinding> bindings(points.size());
  parallel::for_range(points.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) bindings[i] = binder.bind(points[i]);
  });
  return bindings;
}

}  // namespace fascicle::muscle
