#include "modules/muscle/asset/collision/tag_angle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace fascicle::muscle {

namespace {

glm::dvec3 attachment(const MuscleAsset& asset, const MuscleLayout& layout, std::uint32_t i) {
  const std::uint32_t slot = layout.first_attachment_slot + i * layout.attachment_slot_step;
  return {asset.rest_x[slot], asset.rest_y[slot], asset.rest_z[slot]};
}

// The direction from attachment i to the next.
glm::dvec3 segment(const MuscleAsset& asset, const MuscleLayout& layout, std::uint32_t i) {
  const glm::dvec3 step = attachment(asset, layout, i + 1) - attachment(asset, layout, i);
  const double length = glm::length(step);
  return length > 0.0 ? step / length : glm::dvec3(0.0, 1.0, 0.0);
}

// `v` turned by the shortest arc that takes the unit vector `from` to `to`; half a turn is left out.
glm::dvec3 turn(const glm::dvec3& v, const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 axis = glm::cross(from, to);
  const double cosine = glm::dot(from, to);
  if (cosine < -0.999999) return v;
  return v + glm::cross(axis, v) + glm::cross(axis, glm::cross(axis, v)) / (1.0 + cosine);
}

}  // namespace

float tag_angle_offset(const MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section) {
  const MuscleLayout& layout = asset.muscles[muscle];
  const auto frame = [&](std::uint32_t k, glm::dvec3& u, glm::dvec3& v) {
    const std::uint32_t slot = asset.slot(muscle, k);
    u = {asset.rest_ux[slot], asset.rest_uy[slot], asset.rest_uz[slot]};
    v = {asset.rest_vx[slot], asset.rest_vy[slot], asset.rest_vz[slot]};
    return glm::cross(u, v);
  };
  glm::dvec3 u, v;
  glm::dvec3 along = segment(asset, layout, 0);
  const glm::dvec3 normal_0 = frame(0, u, v);
  glm::dvec3 reference = turn(u, normal_0, along);
  const std::uint32_t last_segment = layout.attachment_count - 2;
  const std::uint32_t here = std::min(section >> layout.subdivision, last_segment);
  const auto carry = [&](const glm::dvec3& next) {
    reference = turn(reference, along, next);
    along = next;
  };
  for (std::uint32_t i = 1; i < here; ++i) carry(segment(asset, layout, i));
  if (here > 0) {
    const glm::dvec3 next = segment(asset, layout, here);
    const glm::dvec3 middle = along + next;
    // A section at an attachment stands half way between the two segments.
    if ((here << layout.subdivision) == section && glm::length(middle) > 1.0e-3) {
      carry(glm::normalize(middle));
    } else {
      carry(next);
    }
  }
  const glm::dvec3 normal = frame(section, u, v);
  const glm::dvec3 there = turn(reference, along, normal);
  return static_cast<float>(std::atan2(glm::dot(there, v), glm::dot(there, u)));
}

float wrap_angle(float angle) {
  const float full = 2.0f * std::numbers::pi_v<float>;
  const float wrapped = angle - full * std::floor(angle / full);
  return wrapped < full ? wrapped : 0.0f;
}

}  // namespace fascicle::muscle
