#include "modules/muscle/asset/fibres/pull_inside.hpp"

#include <algorithm>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/ray_scene.hpp"
#include "engine/geometry/winding_number.hpp"
#include "engine/parallel/for_range.hpp"

namespace fascicle::muscle {
namespace {

constexpr double kOnSurface = 1.0e-6;  // m: a point so near to the surface has no direction to it but for rounding
constexpr int kTries = 6;          // with half the way in each time
constexpr std::size_t kChunk = 64;

// How far (m) the surface is from `place`, which lies on it, straight in along `inward`.
double thickness(const RayScene& scene, const glm::dvec3& place, const glm::dvec3& inward, double margin) {
  const Line line{glm::vec3(place), glm::vec3(inward)};
  std::vector<std::uint32_t> starts;
  std::vector<LineCrossing> crossings;
  scene.cast_all(std::span(&line, 1), starts, crossings);
  for (const LineCrossing& crossing : crossings)
    if (crossing.exit && static_cast<double>(crossing.t) > 0.01 * margin) return static_cast<double>(crossing.t);
  return 2.0 * margin;
}

struct Way {
  glm::dvec3 from, inward;
};

struct Pulled {
  bool outside = false, failed = false;
  double moved = 0.0;
};

}  // namespace

PulledPoints pull_inside(const TriangleMesh& mesh, double margin, std::span<glm::dvec3> points) {
  const ClosestPoints surface(mesh);
  const WindingField winding(mesh);
  const RayDevice device;
  const RayScene scene(device, mesh);
  std::vector<Pulled> results(points.size());
  const auto pull = [&](glm::dvec3& p, Pulled& result) {
    const ClosestPoint nearest = surface.at(glm::vec3(p));
    const glm::dvec3 place(nearest.position);
    result.outside = !winding.inside(p);
    if (!result.outside && static_cast<double>(nearest.distance) >= margin) return;
    const std::uint32_t* corners = &mesh.indices[3 * nearest.triangle];
    const auto corner = [&](std::size_t k) { return glm::dvec3(mesh.positions[corners[k]]); };
    const glm::dvec3 way = result.outside ? place - p : p - place;
    const glm::dvec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    // Straight on, or where a fold is in the way against the nearest triangle's normal, from its middle if need be.
    const Way ways[] = {{place, way}, {place, -normal}, {(corner(0) + corner(1) + corner(2)) / 3.0, -normal}};
    for (const Way& w : ways) {
      const double length = glm::length(w.inward);
      if (!(length > 0.0) || (&w == &ways[0] && length < kOnSurface)) continue;
      const glm::dvec3 inward = w.inward / length;
      double depth = std::min(margin, 0.5 * thickness(scene, w.from, inward, margin));
      for (int i = 0; i < kTries; ++i, depth *= 0.5) {
        const glm::dvec3 there = w.from + depth * inward;
        if (!winding.inside(there)) continue;
        result.moved = glm::distance(there, p);
        p = there;
        return;
      }
    }
    result.failed = result.outside;
  };
  parallel::for_range(points.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) pull(points[i], results[i]);
  });
  PulledPoints sum;
  for (const Pulled& result : results) {
    sum.outside += result.outside;
    sum.failed += result.failed;
    sum.furthest = std::max(sum.furthest, static_cast<float>(result.moved));
  }
  return sum;
}

}  // namespace fascicle::muscle
