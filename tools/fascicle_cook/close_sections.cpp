#include "tools/fascicle_cook/close_sections.hpp"

#include <algorithm>
#include <map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/animation/skeleton.hpp"

namespace fascicle::cook {

Bounds::Bounds(std::span<const glm::vec3> points) {
  if (points.empty()) return;
  lower = upper = points.front();
  for (const glm::vec3& point : points) {
    lower = glm::min(lower, point);
    upper = glm::max(upper, point);
  }
}

bool Bounds::near(const glm::vec3& point, float distance) const {
  return glm::all(glm::greaterThanEqual(point, lower - distance)) &&
         glm::all(glm::lessThanEqual(point, upper + distance));
}

bool Bounds::near(const Bounds& other, float distance) const {
  return glm::all(glm::lessThanEqual(lower - distance, other.upper)) &&
         glm::all(glm::lessThanEqual(other.lower, upper + distance));
}

Solid::Solid(const TriangleMesh& mesh) : bounds_(mesh.positions), surface_(mesh), winding_(mesh) {}

std::optional<float> Solid::distance(const glm::vec3& point, float near) const {
  if (!bounds_.near(point, near)) return std::nullopt;
  const float distance = surface_.at(point).distance;
  if (bounds_.near(point, 0.0f) && winding_.inside(point)) return -distance;
  return distance < near ? std::optional(distance) : std::nullopt;
}

std::vector<CloseSection> close_sections(const PosedMuscles& muscles, std::uint32_t muscle,
                                         std::span<const glm::vec3> vertices, const Solid& other,
                                         const glm::mat4& to_other, float near) {
  const muscle::MuscleLayout& layout = muscles.asset().muscles[muscle];
  const std::uint32_t count = layout.section_vertices;
  std::vector<CloseSection> found;
  for (std::uint32_t k = 1; k + 1 < layout.section_count; ++k) {
    CloseSection section{.section = k};
    std::uint32_t close = 0, inside = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::vec3& place = vertices[count * k + i];
      const std::optional<float> distance = other.distance(glm::vec3(to_other * glm::vec4(place, 1.0f)), near);
      if (!distance) continue;
      inside += *distance < 0.0f ? 1 : 0;
      if (close++ > 0 && *distance >= section.distance) continue;
      section.vertex = i;
      section.distance = *distance;
      section.place = place;
    }
    if (close == 0) continue;
    section.buried = 2 * inside > count;
    const glm::vec3 arm = section.place - muscles.centre(muscle, k);
    const float length = glm::length(arm);
    section.outward = length > 0.0f ? arm / length : glm::vec3(0.0f);
    found.push_back(section);
  }
  return found;
}

std::vector<std::unique_ptr<const Solid>> bone_solids(const muscle::CharacterAsset& character) {
  std::map<std::int32_t, TriangleMesh> meshes;
  for (const muscle::BoneMesh& part : character.bone_meshes) {
    TriangleMesh& mesh = meshes[part.bone];
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec3& position : part.mesh->positions) {
      mesh.positions.emplace_back(part.transform * glm::vec4(position, 1.0f));
    }
    for (const std::uint32_t index : part.mesh->indices) mesh.indices.push_back(first + index);
  }
  std::vector<std::unique_ptr<const Solid>> solids(character.skeleton->size());
  for (const auto& [bone, mesh] : meshes) {
    solids[static_cast<std::size_t>(bone)] = std::make_unique<const Solid>(mesh);
  }
  return solids;
}

}  // namespace fascicle::cook
