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

constexpr std::size_t kDirections = 48;   // over half a sphere: the shortest chord is found within some 10 degrees
constexpr std::size_t kTries = 4;         // chords, the shortest first, until one has a free view
constexpr double kTouch = 1.0e-4;         // of the way to the vertex behind: nearer to it the surface is its own triangles
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

// Weights of a triangle's corners, none negative, for the place nearest to `p` in its plane.
glm::dvec3 barycentric(const glm::dvec3& p, const std::array<glm::dvec3, 3>& corner) {
  const glm::dvec3 n = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double square = glm::dot(n, n);
  if (!(square > 0.0)) return {1.0, 0.0, 0.0};
  glm::dvec3 w(glm::dot(n, glm::cross(corner[2] - corner[1], p - corner[1])),
               glm::dot(n, glm::cross(corner[0] - corner[2], p - corner[2])),
               glm::dot(n, glm::cross(corner[1] - corner[0], p - corner[0])));
  w = glm::max(w / square, glm::dvec3(0.0));
  return w / (w.x + w.y + w.z);
}

// The part of a line within the mesh that holds t = 0.
struct Chord {
  double length = 0.0;
  std::uint32_t far = 0;       // the triangle at its further end
};

class Binder {
 public:
  explicit Binder(const TriangleMesh& mesh)
      : mesh_(mesh), scene_(device_, mesh), surface_(mesh), directions_(spread_directions()) {}

  FibreBinding bind(const glm::dvec3& p) const {
    std::vector<Chord> chords = chords_through(p);
    std::ranges::stable_sort(chords, [](const Chord& a, const Chord& b) { return a.length < b.length; });
    if (chords.size() > kTries) chords.resize(kTries);
    for (const Chord& chord : chords)
      if (const std::optional<FibreBinding> binding = bind_across(p, chord)) return *binding;
    // Nothing behind it can be seen.
    const std::uint32_t nearest = surface_.at(glm::vec3(p)).triangle;
    return blend(nearest, barycentric(p, corners(nearest)), mesh_.indices[3 * nearest], 0.0);
  }

 private:
  std::array<glm::dvec3, 3> corners(std::uint32_t triangle) const {
    return {glm::dvec3(mesh_.positions[mesh_.indices[3 * triangle]]),
            glm::dvec3(mesh_.positions[mesh_.indices[3 * triangle + 1]]),
            glm::dvec3(mesh_.positions[mesh_.indices[3 * triangle + 2]])};
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
      chords.push_back({static_cast<double>(after->t) - static_cast<double>(before->t),
                        -before->t > after->t ? before->triangle : after->triangle});
    }
    return chords;
  }

  // From a corner of the chord's further triangle through the point to the surface on this side.
  std::optional<FibreBinding> bind_across(const glm::dvec3& p, const Chord& chord) const {
    std::array<Line, 3> lines;
    std::array<double, 3> behind{};
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 way = p - corners(chord.far)[k];
      behind[k] = glm::length(way);
      if (!(behind[k] > 0.0)) return std::nullopt;
      lines[k] = {glm::vec3(p), glm::vec3(way / behind[k])};
    }
    std::vector<std::uint32_t> starts;
    std::vector<LineCrossing> crossings;
    scene_.cast_all(lines, starts, crossings);
    std::optional<FibreBinding> best;
    double shortest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const LineCrossing* after = nullptr;
      bool free = true;
      for (std::uint32_t c = starts[k]; c < starts[k + 1]; ++c) {
        const double t = static_cast<double>(crossings[c].t);
        if (t <= 0.0 && t > -behind[k] * (1.0 - kTouch)) free = false;
        if (t > 0.0 && after == nullptr) after = &crossings[c];
      }
      if (!free || after == nullptr || !after->exit) continue;
      const double ahead = static_cast<double>(after->t), length = behind[k] + ahead;
      if (best && length >= shortest) continue;
      shortest = length;
      const glm::dvec3 hit = p + ahead * glm::dvec3(lines[k].direction);
      best = blend(after->triangle, barycentric(hit, corners(after->triangle)), mesh_.indices[3 * chord.far + k],
                   ahead / length);
    }
    return best;
  }

  // `share` of the vertex, the rest of the triangle's place.
  FibreBinding blend(std::uint32_t triangle, const glm::dvec3& weights, std::uint32_t vertex, double share) const {
    FibreBinding binding;
    for (int k = 0; k < 3; ++k) {
      binding.vertex[static_cast<std::size_t>(k)] = mesh_.indices[3 * triangle + static_cast<std::uint32_t>(k)];
      binding.weight[static_cast<std::size_t>(k)] = static_cast<float>((1.0 - share) * weights[k]);
    }
    binding.vertex[3] = vertex;
    binding.weight[3] = static_cast<float>(share);
    return binding;
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
