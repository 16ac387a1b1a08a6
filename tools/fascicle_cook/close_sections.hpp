// Sections that are close to each other in one pose.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "tools/fascicle_cook/posed_muscles.hpp"

namespace fascicle::cook {

struct Bounds {
  glm::vec3 lower{0.0f}, upper{0.0f};  // m
  explicit Bounds(std::span<const glm::vec3> points);
  bool near(const glm::vec3& point, float distance) const;
  bool near(const Bounds& other, float distance) const;
};

// A closed surface that can be asked how far a point is from it: m, negative inside.
class Solid {
 public:
  explicit Solid(const TriangleMesh& mesh);
  // Nothing where the point is further than `near` outside.
  std::optional<float> distance(const glm::vec3& point, float near) const;
  // The nearest point of the surface.
  glm::vec3 nearest(const glm::vec3& point) const { return surface_.at(point).position; }
  const Bounds& bounds() const { return bounds_; }

 private:
  Bounds bounds_;
  ClosestPoints surface_;
  WindingField winding_;
};

// A section that is close to something.
struct CloseSection {
  std::uint32_t section = 0;
  std::uint32_t vertex = 0;   // the nearest or deepest
  float distance = 0.0f;      // m, its, negative inside
  glm::vec3 place{0.0f};      // m, where it is
  glm::vec3 outward{0.0f};    // unit, from the section's centre to it
  bool buried = false;        // more than half of the section's vertices are inside
};

// What sections of `muscle` other than its ends are closer than `near` to `other`, in order. `vertices` are the
// muscle's (PosedMuscles::vertices); `to_other` takes them to the space of `other`.
std::vector<CloseSection> close_sections(const PosedMuscles& muscles, std::uint32_t muscle,
                                         std::span<const glm::vec3> vertices, const Solid& other,
                                         const glm::mat4& to_other, float near);

// Bones' meshes in their bones' frames, by bone; null where a bone has none.
std::vector<std::unique_ptr<const Solid>> bone_solids(const muscle::CharacterAsset& character);

}  // namespace fascicle::cook
