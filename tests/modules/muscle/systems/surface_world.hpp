// A world with one character of a few loose bones, and surface muscles on them.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/spawn_surface_muscles.hpp"
#include "tests/modules/muscle/systems/muscle_world.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {

// A ball of 5 cm; what is further than 4 cm down belongs to bone 0, further up to bone 1.
inline SurfaceMuscleDescription attached_ball(std::uint32_t rings = 12, std::uint32_t segments = 16) {
  SurfaceMuscleDescription description;
  description.name = "ball";
  description.mesh = test::make_sphere(0.05f, rings, segments);
  SurfaceAttachment lower{.bone = 0, .origin = true, .vertices = {}}, upper{.bone = 1, .origin = false, .vertices = {}};
  for (std::uint32_t v = 0; v < description.mesh.positions.size(); ++v) {
    if (description.mesh.positions[v].z < -0.04f) lower.vertices.push_back(v);
    if (description.mesh.positions[v].z > 0.04f) upper.vertices.push_back(v);
  }
  description.attachments = {lower, upper};
  return description;
}

inline SurfaceMuscleDescription free_ball() {
  SurfaceMuscleDescription description = attached_ball();
  description.attachments.clear();
  return description;
}

struct SurfaceWorld : MuscleWorld {
  std::vector<glm::mat4> rest, bones;
  std::vector<std::shared_ptr<const BoneField>> fields;
  ecs::Entity character;
  std::vector<ecs::Entity> muscles;

  explicit SurfaceWorld(std::vector<glm::mat4> rest_bones, std::vector<std::shared_ptr<const BoneField>> bone_fields = {},
                        int workers = 1, const MuscleSettings& settings = {})
      : MuscleWorld(workers, settings), rest(std::move(rest_bones)), bones(rest), fields(std::move(bone_fields)) {
    character = add_character(bones);
  }

  ecs::Entity add(const SurfaceMuscleDescription& description, const MuscleAsset* drivers = nullptr,
                  ecs::Entity musculature = ecs::kNoEntity) {
    const auto asset = build_surface_asset(description, static_cast<std::uint32_t>(rest.size()), drivers);
    EXPECT_TRUE(asset.ok()) << to_text(asset.diagnostics());
    muscles.push_back(spawn_surface_muscle(world, character, *asset, rest, fields, musculature));
    return muscles.back();
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) {
      pose(character, bones);
      step();
    }
  }
  // Brings a bone there in equal steps.
  void bring(std::size_t bone, const glm::mat4& to, int frames) {
    const glm::vec3 from(bones[bone][3]), by = glm::vec3(to[3]) - from;
    for (int i = 1; i <= frames; ++i) {
      bones[bone] = to;
      bones[bone][3] = glm::vec4(from + by * (static_cast<float>(i) / static_cast<float>(frames)), 1.0f);
      steps(1);
    }
  }

  SurfaceState& state(std::size_t i = 0) { return world.get<SurfaceState>(muscles[i]); }
  const SurfaceAsset& asset(std::size_t i = 0) { return *world.get<SurfaceMuscle>(muscles[i]).asset; }
  const SurfaceContacts& contacts(std::size_t i = 0) { return world.get<SurfaceContacts>(muscles[i]); }
  glm::vec3 point(std::uint32_t v, std::size_t i = 0) {
    const SurfacePoint& p = state(i).points[v];
    return {p.x, p.y, p.z};
  }
  glm::vec3 rest_point(std::uint32_t v, std::size_t i = 0) {
    const SurfacePoint& p = asset(i).rest[v];
    return {p.x, p.y, p.z};
  }
  glm::vec3 world_point(std::uint32_t v, std::size_t i = 0) {
    return glm::vec3(state(i).frame * glm::vec4(point(v, i), 1.0f));
  }
  // m: the furthest that a vertex is from its place at rest.
  float rest_distance(std::size_t i = 0) {
    float furthest = 0.0f;
    for (std::uint32_t v = 0; v < asset(i).vertex_count; ++v) {
      furthest = std::max(furthest, glm::distance(point(v, i), rest_point(v, i)));
    }
    return furthest;
  }
  // In sixths of m^3 no more: V / V_0, summed here anew.
  double volume_ratio(std::size_t i = 0) {
    double sum = 0.0;
    const std::vector<std::uint32_t>& triangles = asset(i).triangles;
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
      sum += glm::dot(glm::dvec3(point(triangles[t], i)),
                      glm::cross(glm::dvec3(point(triangles[t + 1], i)), glm::dvec3(point(triangles[t + 2], i))));
    }
    return sum / 6.0 / asset(i).volume;
  }
  // Kicks all free vertices by up to `by` (m), the same way each time.
  void kick(float by, std::size_t i = 0) {
    test::Numbers numbers(7);
    for (std::uint32_t v = 0; v < asset(i).vertex_count; ++v) {
      SurfacePoint& p = state(i).points[v];
      if (!(p.inverse_mass > 0.0f)) continue;
      p.x += by * (2.0f * numbers.next() - 1.0f);
      p.y += by * (2.0f * numbers.next() - 1.0f);
      p.z += by * (2.0f * numbers.next() - 1.0f);
    }
  }
};

inline std::vector<glm::mat4> still_bones(std::size_t count) { return std::vector<glm::mat4>(count, glm::mat4(1.0f)); }

}  // namespace fascicle::muscle
