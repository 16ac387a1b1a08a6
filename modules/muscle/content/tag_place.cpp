#include "modules/muscle/content/tag_place.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "modules/muscle/content/mirror.hpp"

namespace fascicle::muscle {

namespace {

constexpr float kTurn = 2.0f * std::numbers::pi_v<float>;

// A place on the rest line: between section `below` and the next.
struct LineSpot {
  std::uint32_t below = 0;
  float share = 0.0f;  // 0 at `below`, 1 at the next
};

LineSpot find_spot(const MuscleAsset& asset, std::uint32_t muscle, float fraction) {
  const std::uint32_t last = asset.muscles[muscle].section_count - 1;
  const float arc = fraction * asset.rest_arc[asset.slot(muscle, last)];
  std::uint32_t below = 0;
  while (below + 1 < last && asset.rest_arc[asset.slot(muscle, below + 1)] <= arc) ++below;
  const float from = asset.rest_arc[asset.slot(muscle, below)];
  const float length = asset.rest_arc[asset.slot(muscle, below + 1)] - from;
  return {below, length > 0.0f ? std::clamp((arc - from) / length, 0.0f, 1.0f) : 0.0f};
}

struct Frame {
  glm::vec3 centre, u, v;
};

Frame section_frame(const MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section) {
  const std::uint32_t s = asset.slot(muscle, section);
  return {{asset.rest_x[s], asset.rest_y[s], asset.rest_z[s]},
          {asset.rest_ux[s], asset.rest_uy[s], asset.rest_uz[s]},
          {asset.rest_vx[s], asset.rest_vy[s], asset.rest_vz[s]}};
}

Frame frame_at(const MuscleAsset& asset, std::uint32_t muscle, const LineSpot& spot) {
  const Frame a = section_frame(asset, muscle, spot.below), b = section_frame(asset, muscle, spot.below + 1);
  return {glm::mix(a.centre, b.centre, spot.share), glm::mix(a.u, b.u, spot.share), glm::mix(a.v, b.v, spot.share)};
}

float radius_at(const MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section, float angle) {
  const std::uint32_t count = asset.muscles[muscle].section_vertices;
  const float at = angle / kTurn * static_cast<float>(count);
  const auto below = static_cast<std::uint32_t>(at);
  const float* radii = &asset.rest_radii[asset.radius(muscle, section)];
  return radii[below % count] + (at - std::floor(at)) * (radii[(below + 1) % count] - radii[below % count]);
}

}  // namespace

glm::vec3 rest_vertex(const MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section, std::uint32_t vertex) {
  const Frame frame = section_frame(asset, muscle, section);
  const float angle =
      kTurn * static_cast<float>(vertex) / static_cast<float>(asset.muscles[muscle].section_vertices);
  return frame.centre + asset.rest_radii[asset.radius(muscle, section) + vertex] *
                            (std::cos(angle) * frame.u + std::sin(angle) * frame.v);
}

SectionTag tag_of(const MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section, std::uint32_t vertex) {
  const MuscleLayout& layout = asset.muscles[muscle];
  const float length = asset.rest_arc[asset.slot(muscle, layout.section_count - 1)];
  return {muscle, asset.rest_arc[asset.slot(muscle, section)] / length,
          kTurn * static_cast<float>(vertex) / static_cast<float>(layout.section_vertices)};
}

glm::vec3 tagged_place(const MuscleAsset& asset, const SectionTag& tag) {
  const LineSpot spot = find_spot(asset, tag.muscle, tag.fraction);
  const Frame frame = frame_at(asset, tag.muscle, spot);
  const float radius = std::lerp(radius_at(asset, tag.muscle, spot.below, tag.angle),
                                 radius_at(asset, tag.muscle, spot.below + 1, tag.angle), spot.share);
  return frame.centre + radius * (std::cos(tag.angle) * frame.u + std::sin(tag.angle) * frame.v);
}

SectionTag mirror_tag(const MuscleAsset& asset, const SectionTag& tag, std::uint32_t other, int axis) {
  const Frame from = frame_at(asset, tag.muscle, find_spot(asset, tag.muscle, tag.fraction));
  const Frame to = frame_at(asset, other, find_spot(asset, other, tag.fraction));
  const glm::vec3 direction = mirror_point(std::cos(tag.angle) * from.u + std::sin(tag.angle) * from.v, axis);
  float angle = std::atan2(glm::dot(direction, to.v), glm::dot(direction, to.u));
  if (angle < 0.0f) angle += kTurn;
  return {other, tag.fraction, angle < kTurn ? angle : 0.0f};
}

}  // namespace fascicle::muscle
