#include "modules/muscle/systems/4_solve/section_frame.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

// Where a section's centre and directions are read from.
struct SectionArrays {
  const AlignedVector<float>&x, &y, &z, &ux, &uy, &uz, &vx, &vy, &vz;
};

glm::mat4 frame_at(const MuscleAsset& asset, const SectionArrays& from, std::uint32_t muscle, float place) {
  const MuscleLayout& layout = asset.muscles[muscle];
  const float section = glm::clamp(place * static_cast<float>(1u << layout.subdivision), 0.0f,
                                   static_cast<float>(layout.section_count - 1));
  const auto before = std::min(static_cast<std::uint32_t>(section), layout.section_count - 2);
  const float f = section - static_cast<float>(before);
  const std::uint32_t i = asset.slot(muscle, before), j = asset.slot(muscle, before + 1);
  const auto mix = [&](const AlignedVector<float>& a, const AlignedVector<float>& b, const AlignedVector<float>& c) {
    return glm::mix(glm::vec3(a[i], b[i], c[i]), glm::vec3(a[j], b[j], c[j]), f);
  };
  const glm::vec3 u = glm::normalize(mix(from.ux, from.uy, from.uz));
  const glm::vec3 v = mix(from.vx, from.vy, from.vz);
  const glm::vec3 square = glm::normalize(v - glm::dot(v, u) * u);
  return {glm::vec4(u, 0.0f), glm::vec4(square, 0.0f), glm::vec4(glm::cross(u, square), 0.0f),
          glm::vec4(mix(from.x, from.y, from.z), 1.0f)};
}

}  // namespace

glm::mat4 section_frame(const MuscleAsset& asset, const ActionLines& lines, const CrossSections& sections,
                        std::uint32_t muscle, float place) {
  return frame_at(asset, {lines.x, lines.y, lines.z, sections.ux, sections.uy, sections.uz, sections.vx, sections.vy,
                          sections.vz}, muscle, place);
}

glm::mat4 rest_section_frame(const MuscleAsset& asset, std::uint32_t muscle, float place) {
  return frame_at(asset, {asset.rest_x, asset.rest_y, asset.rest_z, asset.rest_ux, asset.rest_uy, asset.rest_uz,
                          asset.rest_vx, asset.rest_vy, asset.rest_vz}, muscle, place);
}

}  // namespace fascicle::muscle
