#include "modules/muscle/content/tag_place.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "modules/muscle/asset/collision/tag_angle.hpp"
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

float radius_at(const MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section, float angle) {
  const std::uint32_t count = asset.muscles[muscle].section_vertices;
  const float at = wrap_angle(angle) / kTurn * static_cast<float>(count);
  const auto below = static_cast<std::uint32_t>(at);
  const float* radii = &asset.rest_radii[asset.radius(muscle, section)];
  return radii[below % count] + (at - std::floor(at)) * (radii[(below + 1) % count] - radii[below % count]);
}

// Where the tag's angle is on one section.
glm::vec3 place_on(const MuscleAsset& asset, const SectionTag& tag, std::uint32_t section) {
  const Frame frame = section_frame(asset, tag.muscle, section);
  const float angle = tag.angle + tag_angle_offset(asset, tag.muscle, section);
  return frame.centre + radius_at(asset, tag.muscle, section, angle) *
                            (std::cos(angle) * frame.u + std::sin(angle) * frame.v);
}

std::uint32_t nearest_section(const MuscleAsset& asset, std::uint32_t muscle, float fraction) {
  const LineSpot spot = find_spot(asset, muscle, fraction);
  return spot.below + (spot.share > 0.5f ? 1 : 0);
}

}  // namespace

SectionTag tag_of(const MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section, std::uint32_t vertex) {
  const MuscleLayout& layout = asset.muscles[muscle];
  const float length = asset.rest_arc[asset.slot(muscle, layout.section_count - 1)];
  const float angle = kTurn * static_cast<float>(vertex) / static_cast<float>(layout.section_vertices);
  return {muscle, asset.rest_arc[asset.slot(muscle, section)] / length,
          wrap_angle(angle - tag_angle_offset(asset, muscle, section))};
}

glm::vec3 tagged_place(const MuscleAsset& asset, const SectionTag& tag) {
  const LineSpot spot = find_spot(asset, tag.muscle, tag.fraction);
  return glm::mix(place_on(asset, tag, spot.below), place_on(asset, tag, spot.below + 1), spot.share);
}

SectionTag mirror_tag(const MuscleAsset& asset, const SectionTag& tag, std::uint32_t other, int axis) {
  const std::uint32_t here = nearest_section(asset, tag.muscle, tag.fraction);
  const std::uint32_t there = nearest_section(asset, other, tag.fraction);
  const Frame from = section_frame(asset, tag.muscle, here), to = section_frame(asset, other, there);
  const float angle = tag.angle + tag_angle_offset(asset, tag.muscle, here);
  const glm::vec3 direction = mirror_point(std::cos(angle) * from.u + std::sin(angle) * from.v, axis);
  const float mirrored = std::atan2(glm::dot(direction, to.v), glm::dot(direction, to.u));
  return {other, tag.fraction, wrap_angle(mirrored - tag_angle_offset(asset, other, there))};
}

}  // namespace fascicle::muscle
