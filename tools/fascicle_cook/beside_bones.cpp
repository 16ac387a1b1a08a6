#include "tools/fascicle_cook/beside_bones.hpp"

#include <algorithm>

#include <glm/matrix.hpp>

#include "modules/muscle/kernels/transversal.hpp"

namespace fascicle::cook {

std::vector<BesideBone> find_beside_bones(const muscle::MuscleAsset& asset, std::uint32_t muscle,
                                          std::span<const glm::vec3> vertices,
                                          std::span<const std::unique_ptr<const Solid>> bones,
                                          std::span<const glm::mat4> rest, float near) {
  const muscle::MuscleLayout& layout = asset.muscles[muscle];
  const std::uint32_t count = layout.section_vertices;
  std::vector<BesideBone> found;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    if (!bones[b]) continue;
    const glm::mat4 to_bone = glm::inverse(rest[b]);
    for (std::uint32_t k = 1; k + 1 < layout.section_count; ++k) {
      BesideBone beside{.section = k, .bone = static_cast<std::int32_t>(b), .distance = near};
      bool inside = false, close = false;
      glm::vec3 nearest(0.0f);
      for (std::uint32_t i = 0; i < count && !inside; ++i) {
        const glm::vec3 place(to_bone * glm::vec4(vertices[count * k + i], 1.0f));
        const std::optional<float> distance = bones[b]->distance(place, near);
        if (!distance) continue;
        inside = *distance < 0.0f;
        if (*distance >= beside.distance) continue;
        close = true;
        beside.vertex = i;
        beside.distance = *distance;
        nearest = place;
      }
      if (inside || !close) continue;
      beside.point = bones[b]->nearest(nearest);
      found.push_back(beside);
    }
  }
  return found;
}

void follow_beside_bones(const PosedMuscles& muscles, std::uint32_t muscle, std::span<const glm::vec3> vertices,
                         std::span<const std::unique_ptr<const Solid>> bones, std::span<const glm::mat4> matrices,
                         std::span<BesideBone> sections) {
  const std::uint32_t count = muscles.asset().muscles[muscle].section_vertices;
  for (BesideBone& beside : sections) {
    if (!beside.stays) continue;
    const auto b = static_cast<std::size_t>(beside.bone);
    const glm::vec3 point(matrices[b] * glm::vec4(beside.point, 1.0f));
    const glm::vec3 vertex = vertices[count * beside.section + beside.vertex];
    const glm::vec3 centre = muscles.centre(muscle, beside.section);
    const muscle::TransversalDepth depth = muscle::measure_transversal({vertex, centre}, {point, point});
    const glm::mat4 to_bone = glm::inverse(matrices[b]);
    const auto distance = [&](const glm::vec3& p, float near) {
      return bones[b]->distance(glm::vec3(to_bone * glm::vec4(p, 1.0f)), near);
    };
    const bool past = depth.overlap > depth.x.radius && distance(centre, 0.0f).value_or(0.0f) >= 0.0f;
    beside.stays = depth.x.lateral < depth.x.radius && !past;
    beside.distance = std::min(beside.distance, distance(vertex, beside.distance).value_or(beside.distance));
  }
}

}  // namespace fascicle::cook
