#include "engine/geometry/mesh_distance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/geometry/finite.hpp"
#include "engine/parallel/ordered_sum.hpp"

namespace fascicle {
namespace {

constexpr std::size_t kPointsPerChunk = 512;

// Steps of the R2 sequence (Roberts 2018): points that fill a square evenly, however many are taken.
constexpr double kStepA = 0.7548776662466927, kStepB = 0.5698402909980532;

// One point per square of `spacing` of area: sample i lies where the areas of the triangles so far sum to i + 1/2
// squares, and within its triangle where the sequence says.
std::vector<glm::vec3> spread_points(const TriangleMesh& mesh, double spacing) {
  const std::size_t triangle_count = mesh.indices.size() / 3;
  const auto corner = [&](std::size_t t, std::size_t i) { return glm::dvec3(mesh.positions[mesh.indices[3 * t + i]]); };
  std::vector<double> sums(triangle_count);
  double sum = 0.0;
  for (std::size_t t = 0; t < triangle_count; ++t) {
    const glm::dvec3 a = corner(t, 0);
    const double area = 0.5 * glm::length(glm::cross(corner(t, 1) - a, corner(t, 2) - a));
    if (std::isfinite(area)) sum += area;
    sums[t] = sum;
  }
  std::vector<glm::vec3> points;
  if (!(sum > 0.0)) return points;
  const double wanted = spacing > 0.0 ? sum / (spacing * spacing) : static_cast<double>(kMostSamples);
  const auto count = static_cast<std::size_t>(std::clamp(std::ceil(wanted), 1.0, static_cast<double>(kMostSamples)));
  points.reserve(count);
  std::size_t t = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double reached = sum * ((static_cast<double>(i) + 0.5) / static_cast<double>(count));
    while (t + 1 < triangle_count && sums[t] <= reached) ++t;
    const double n = static_cast<double>(i + 1);
    double u = n * kStepA - std::floor(n * kStepA), v = n * kStepB - std::floor(n * kStepB);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const glm::dvec3 a = corner(t, 0);
    points.emplace_back(a + u * (corner(t, 1) - a) + v * (corner(t, 2) - a));
  }
  return points;
}

std::vector<glm::vec3> used_vertices(const TriangleMesh& mesh) {
  std::vector<char> used(mesh.positions.size(), 0);
  for (const std::uint32_t index : mesh.indices) used[index] = 1;
  std::vector<glm::vec3> vertices;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] != 0 && is_finite(mesh.positions[i])) vertices.push_back(mesh.positions[i]);
  }
  return vertices;
}

struct Sums {
  double squares = 0.0, distances = 0.0, most = 0.0;
  std::size_t count = 0;

  Sums& operator+=(const Sums& other) {
    squares += other.squares;
    distances += other.distances;
    most = std::max(most, other.most);
    count += other.count;
    return *this;
  }
};

Sums sum_distances(const std::vector<glm::vec3>& points, const ClosestPoints& to,
                   const std::function<bool(const glm::vec3&)>& counts) {
  return parallel::ordered_sum(points.size(), kPointsPerChunk, [&](std::size_t begin, std::size_t end) {
    Sums sums;
    for (std::size_t i = begin; i < end; ++i) {
      if (counts && !counts(points[i])) continue;
      const double distance = to.at(points[i]).distance;
      sums += {distance * distance, distance, distance, 1};
    }
    return sums;
  });
}

}  // namespace

SurfaceDistance measure_distance(const TriangleMesh& from, const ClosestPoints& to, double spacing) {
  return measure_distance(from, to, spacing, {});
}

SurfaceDistance measure_distance(const TriangleMesh& from, const ClosestPoints& to, double spacing,
                                 const std::function<bool(const glm::vec3&)>& counts) {
  if (to.empty()) return {};
  const Sums sums = sum_distances(spread_points(from, spacing), to, counts);
  if (sums.count == 0) return {};
  const double count = static_cast<double>(sums.count);
  return {std::sqrt(sums.squares / count), sums.distances / count,
          std::max(sums.most, sum_distances(used_vertices(from), to, counts).most), sums.count};
}

}  // namespace fascicle
