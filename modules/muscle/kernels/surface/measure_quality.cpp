#include "modules/muscle/kernels/surface/measure_quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace fascicle::muscle {
namespace {

constexpr double kNearRest = 1.0;  // rad

glm::dvec3 place(const SurfacePoint& point) { return {point.x, point.y, point.z}; }

// To -pi..pi.
double wrap(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

// Signed, flat 0 (4.1).
double angle_of(const glm::dvec3& p1, const glm::dvec3& p2, const glm::dvec3& p3, const glm::dvec3& p4) {
  const glm::dvec3 e = p2 - p1, n1 = glm::cross(e, p3 - p1), n2 = glm::cross(p4 - p1, e);
  const double length = glm::length(e);
  if (!(length > 0.0)) return 0.0;
  return std::atan2(glm::dot(glm::cross(n1, n2), e) / length, glm::dot(n1, n2));
}

double volume_of(const SurfaceAsset& asset, std::span<const SurfacePoint> points) {
  if (points.empty()) return 0.0;
  const glm::dvec3 origin = place(points[0]);
  double sum = 0.0;
  for (std::size_t t = 0; t + 2 < asset.triangles.size(); t += 3) {
    const glm::dvec3 a = place(points[asset.triangles[t]]) - origin, b = place(points[asset.triangles[t + 1]]) - origin,
                     c = place(points[asset.triangles[t + 2]]) - origin;
    sum += glm::dot(a, glm::cross(b, c));
  }
  return sum / 6.0;
}

void measure_edges(const SurfaceAsset& asset, std::span<const SurfacePoint> points, SurfaceQuality& quality) {
  const std::size_t count = asset.hinges.size();
  quality.ratios.resize(count);
  double sum = 0.0, off = 0.0, least = std::numeric_limits<double>::max(), most = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Hinge& hinge = asset.hinges[i];
    const double length = glm::distance(place(points[hinge.vertex[0]]), place(points[hinge.vertex[1]]));
    const double ratio = hinge.length > 0.0f ? length / static_cast<double>(hinge.length) : 1.0;
    quality.ratios[i] = static_cast<float>(ratio);
    sum += ratio;
    off += std::abs(ratio - 1.0);
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  if (count == 0) return;
  quality.edge_ratio_mean = sum / static_cast<double>(count);
  quality.edge_ratio_abs_mean = off / static_cast<double>(count);
  quality.edge_ratio_min = least;
  quality.edge_ratio_max = most;
  const auto percentile = [&](double share) {
    const auto rank = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(count - 1)));
    std::nth_element(quality.ratios.begin(), quality.ratios.begin() + rank, quality.ratios.end());
    return static_cast<double>(quality.ratios[static_cast<std::size_t>(rank)]);
  };
  quality.edge_ratio_p5 = percentile(0.05);
  quality.edge_ratio_p50 = percentile(0.50);
  quality.edge_ratio_p95 = percentile(0.95);
}

void measure_angles(const SurfaceAsset& asset, std::span<const SurfacePoint> points, SurfaceQuality& quality) {
  const std::size_t count = asset.hinges.size();
  if (quality.angles.size() != count) {
    quality.angles.resize(count);
    for (std::size_t i = 0; i < count; ++i) quality.angles[i] = asset.hinges[i].angle;
  }
  double sum = 0.0, most = 0.0, largest = 0.0;
  quality.folded = quality.turned = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Hinge& hinge = asset.hinges[i];
    const double rest = static_cast<double>(hinge.angle);
    const double angle = angle_of(place(points[hinge.vertex[0]]), place(points[hinge.vertex[1]]),
                                  place(points[hinge.vertex[2]]), place(points[hinge.vertex[3]]));
    const double off_rest = wrap(angle - rest), change = std::abs(off_rest);
    const double before = static_cast<double>(quality.angles[i]);
    // Near rest it is right side out, whichever way it came.
    const double followed = change < kNearRest ? rest + off_rest : before + wrap(angle - before);
    quality.angles[i] = static_cast<float>(followed);
    sum += change;
    most = std::max(most, change);
    largest = std::max(largest, std::abs(angle));
    if (std::abs(angle) >= kFoldedAngle && std::abs(rest) < kFoldedAngle) ++quality.folded;
    if (std::abs(followed) > std::numbers::pi) ++quality.turned;
  }
  quality.dihedral_change_mean = count > 0 ? sum / static_cast<double>(count) : 0.0;
  quality.dihedral_change_max = most;
  quality.angle_max = largest;
}

double furthest_from_rest(const SurfaceAsset& asset, std::span<const SurfacePoint> points) {
  double furthest = 0.0;
  for (std::uint32_t v = 0; v < asset.vertex_count; ++v) {
    furthest = std::max(furthest, glm::distance(place(points[v]), place(asset.rest[v])));
  }
  return furthest;
}

double worst_attachment(const SurfaceAsset& asset, std::span<const SurfacePoint> points,
                        std::span<const glm::mat4> bones) {
  double worst = 0.0;
  for (const AttachedVertex& attached : asset.attached) {
    const std::int32_t bone = asset.attachments[attached.attachment].bone;
    if (bone < 0 || static_cast<std::size_t>(bone) >= bones.size()) continue;
    const glm::dmat4 motion{bones[static_cast<std::size_t>(bone)]};
    const glm::dvec3 there(motion * glm::dvec4(place(asset.rest[attached.vertex]), 1.0));
    worst = std::max(worst, glm::distance(place(points[attached.vertex]), there));
  }
  return worst;
}

}  // namespace

void measure_quality(const SurfaceAsset& asset, std::span<const SurfacePoint> points, std::span<const glm::mat4> bones,
                     SurfaceQuality& quality) {
  if (asset.volume > 0.0) quality.volume_ratio = volume_of(asset, points) / asset.volume;
  measure_edges(asset, points, quality);
  measure_angles(asset, points, quality);
  quality.rest_distance_max = furthest_from_rest(asset, points);
  quality.attachment_error_max = worst_attachment(asset, points, bones);
}

}  // namespace fascicle::muscle
