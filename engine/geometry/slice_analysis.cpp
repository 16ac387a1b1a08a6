#include "engine/geometry/slice_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/principal_axes.hpp"

namespace fascicle {
namespace {

constexpr double kShallow = 0.01;  // dent, below which an outline is convex

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

bool has_area(const SliceLoop& loop) {
  return loop.perimeter > 0.0 && std::abs(loop.area) > 1e-9 * loop.perimeter * loop.perimeter;
}

// Anticlockwise (Andrew's monotone chain).
std::vector<glm::dvec2> convex_hull(std::vector<glm::dvec2> points) {
  std::ranges::sort(points,
                    [](const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<glm::dvec2> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const glm::dvec2& point : points) {
      while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

// How far the deepest of the points lies from the sides of their hull.
double deepest_dent(std::span<const glm::dvec2> points) {
  const std::vector<glm::dvec2> hull = convex_hull({points.begin(), points.end()});
  double deepest = 0.0;
  for (const glm::dvec2& point : points) {
    double depth = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < hull.size() && depth > deepest; ++i) {
      const glm::dvec2 side = hull[(i + 1) % hull.size()] - hull[i];
      depth = std::min(depth, cross(side, point - hull[i]) / glm::length(side));
    }
    deepest = std::max(deepest, depth);
  }
  return deepest;
}

bool encloses(std::span<const glm::dvec2> points, const glm::dvec2& p) {
  bool inside = false;
  for (std::size_t i = 0, j = points.size() - 1; i < points.size(); j = i++) {
    const glm::dvec2 &a = points[i], &b = points[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

double closed_perimeter(const SliceLoop& loop) {
  return loop.perimeter + (loop.closed ? 0.0 : glm::distance(loop.points.back(), loop.points.front()));
}

}  // namespace

SliceShape measure_shape(const SliceLoop& loop) {
  SliceShape shape;
  if (!has_area(loop)) return shape;
  const double area = std::abs(loop.area), perimeter = closed_perimeter(loop);
  shape.quotient = 4.0 * std::numbers::pi * area / (perimeter * perimeter);
  shape.normalised_perimeter = perimeter / std::sqrt(area);
  shape.dent = deepest_dent(loop.points) / std::sqrt(area);
  shape.convex = shape.dent <= kShallow;
  shape.centroid_inside = encloses(loop.points, loop.centroid);
  return shape;
}

std::vector<glm::dvec2> normalise_outline(const SliceLoop& loop) {
  std::vector<glm::dvec2> points;
  if (!has_area(loop)) return points;
  // Second moments of the area about the centroid, by the triangles that the edges make with it.
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    const glm::dvec2 a = loop.points[i] - loop.centroid;
    const glm::dvec2 b = loop.points[(i + 1) % loop.points.size()] - loop.centroid;
    const double weight = cross(a, b) / 24.0;
    xx += 2.0 * weight * (a.x * a.x + a.x * b.x + b.x * b.x);
    yy += 2.0 * weight * (a.y * a.y + a.y * b.y + b.y * b.y);
    xy += weight * (2.0 * a.x * a.y + a.x * b.y + b.x * a.y + 2.0 * b.x * b.y);
  }
  const double sign = loop.area > 0.0 ? 1.0 : -1.0;
  const double angle = 0.5 * std::atan2(2.0 * sign * xy, sign * (xx - yy));
  const double scale = 1.0 / std::sqrt(std::abs(loop.area));
  const glm::dvec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
  for (const glm::dvec2& point : loop.points) {
    const glm::dvec2 offset = scale * (point - loop.centroid);
    points.emplace_back(glm::dot(offset, along), glm::dot(offset, across));
  }
  if (sign < 0.0) std::ranges::reverse(points);
  return points;
}

std::vector<SliceStation> place_stations(std::span<const glm::dvec3> line, std::span<const double> fractions) {
  std::vector<double> arcs(line.size(), 0.0);
  for (std::size_t i = 1; i < line.size(); ++i) arcs[i] = arcs[i - 1] + glm::distance(line[i - 1], line[i]);
  std::vector<SliceStation> stations;
  if (line.empty() || !(arcs.back() > 0.0) || !std::isfinite(arcs.back())) return stations;
  const auto at = [&](double arc) {
    const std::size_t after = static_cast<std::size_t>(
        std::ranges::upper_bound(arcs.begin() + 1, arcs.end() - 1, arc) - arcs.begin());
    const double length = arcs[after] - arcs[after - 1];
    const double s = length > 0.0 ? std::clamp((arc - arcs[after - 1]) / length, 0.0, 1.0) : 0.0;
    return glm::mix(line[after - 1], line[after], s);
  };
  for (const double fraction : fractions) {
    const double arc = fraction * arcs.back(), reach = 0.05 * arcs.back();
    stations.push_back({fraction, plane_across(at(arc), at(arc + reach) - at(arc - reach))});
  }
  return stations;
}

std::vector<SliceStation> place_stations(const TriangleMesh& mesh, std::span<const double> fractions) {
  const PrincipalAxes axes = principal_axes(mesh);
  const glm::dvec3 line[2] = {axes.centre + axes.ranges[0].x * axes.axes[0],
                              axes.centre + axes.ranges[0].y * axes.axes[0]};
  return place_stations(line, fractions);
}

std::vector<MeshSlice> slice_at(const TriangleMesh& mesh, std::span<const SliceStation> stations) {
  std::vector<MeshSlice> slices;
  for (const SliceStation& station : stations) {
    MeshSlice slice{mesh.name, station.fraction, {}};
    for (SliceLoop& loop : slice_mesh(mesh, station.plane)) {
      const SliceShape shape = measure_shape(loop);
      slice.loops.push_back({std::move(loop), shape});
    }
    std::ranges::stable_sort(slice.loops, [](const SliceOutline& a, const SliceOutline& b) {
      return std::abs(a.loop.area) > std::abs(b.loop.area);
    });
    slices.push_back(std::move(slice));
  }
  return slices;
}

SliceSummary summarise_slices(std::span<const MeshSlice> slices) {
  SliceSummary summary;
  std::vector<double> quotients;
  double sum = 0.0;
  std::size_t round = 0, concave = 0, outside = 0, several = 0;
  for (const MeshSlice& slice : slices) {
    if (slice.loops.empty() || !has_area(slice.loops[0].loop)) {
      summary.missed += 1;
      continue;
    }
    const SliceShape& shape = slice.loops[0].shape;
    quotients.push_back(shape.quotient);
    sum += shape.quotient;
    round += shape.quotient > 0.5 ? 1 : 0;
    concave += shape.convex ? 0 : 1;
    outside += shape.centroid_inside ? 0 : 1;
    several += slice.loops.size() > 1 ? 1 : 0;
  }
  summary.slices = quotients.size();
  if (quotients.empty()) return summary;
  std::ranges::sort(quotients);
  const double count = static_cast<double>(quotients.size());
  summary.mean_quotient = sum / count;
  summary.median_quotient = 0.5 * (quotients[(quotients.size() - 1) / 2] + quotients[quotients.size() / 2]);
  summary.share_round = static_cast<double>(round) / count;
  summary.share_concave = static_cast<double>(concave) / count;
  summary.share_centroid_outside = static_cast<double>(outside) / count;
  summary.share_several = static_cast<double>(several) / count;
  return summary;
}

}  // namespace fascicle
