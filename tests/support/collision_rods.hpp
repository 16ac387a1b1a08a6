// Straight muscles of constant thickness that collide: what tests of collision know the answers for.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <gtest/gtest.h>

#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/kernels/collision/place_samples.hpp"
#include "modules/muscle/kernels/collision/solve_collision.hpp"

namespace fascicle::test {

struct Rod {
  glm::vec3 from{0.0f}, to{0.0f};  // m, in the bones' frames, which at rest are the world's
  float radius = 0.02f;            // m
  std::int32_t from_bone = 0, to_bone = 0;
  std::uint32_t section_vertices = 16;
  std::uint32_t subdivision = 3;   // 2^this segments
};

inline muscle::MuscleDescription describe(const Rod& rod, std::size_t number) {
  muscle::MuscleDescription description;
  description.name = "rod_" + std::to_string(number);
  description.attachments = {{rod.from_bone, rod.from, true}, {rod.to_bone, rod.to, true}};
  description.profile = {.fractions = {0.0f, 1.0f}, .radii = {rod.radius, rod.radius}, .absolute = true};
  description.section_vertices = rod.section_vertices;
  description.longitudinal_subdivision = rod.subdivision;
  return description;
}

inline std::shared_ptr<const muscle::MuscleAsset> build_rods(const std::vector<Rod>& rods, std::size_t bones) {
  std::vector<muscle::MuscleDescription> descriptions;
  for (std::size_t i = 0; i < rods.size(); ++i) descriptions.push_back(describe(rods[i], i));
  const auto built = muscle::build_muscle_asset(descriptions, std::vector<glm::mat4>(bones, glm::mat4(1.0f)));
  EXPECT_TRUE(built.ok()) << to_text(built.diagnostics());
  return built.ok() ? *built : nullptr;
}

using BoneFields = std::vector<std::shared_ptr<const muscle::BoneField>>;

inline std::shared_ptr<const muscle::CollisionAsset> build_collision(
    std::shared_ptr<const muscle::MuscleAsset> muscles, const BoneFields& fields,
    const muscle::CollisionDescription& description = {}) {
  return muscle::build_collision_asset(std::move(muscles), description, fields,
                                       std::vector<glm::mat4>(fields.size(), glm::mat4(1.0f)));
}

// A solve's state outside of any world: at rest, all inner sections free, until a test moves something.
struct CollisionState {
  std::shared_ptr<const muscle::CollisionAsset> asset;
  std::vector<glm::mat4> bones;
  muscle::CollisionWork work;

  explicit CollisionState(std::shared_ptr<const muscle::CollisionAsset> collision, std::size_t bone_count)
      : asset(std::move(collision)), bones(bone_count, glm::mat4(1.0f)) {
    const muscle::MuscleAsset& muscles = *asset->muscles;
    work.reserve(*asset);
    for (std::size_t s = 0; s < asset->sections.size(); ++s) {
      const muscle::CollisionSection& section = asset->sections[s];
      const std::uint32_t slot = section.slot;
      work.a[s] = work.driven[s] = {muscles.rest_x[slot], muscles.rest_y[slot], muscles.rest_z[slot]};
      work.u[s] = {muscles.rest_ux[slot], muscles.rest_uy[slot], muscles.rest_uz[slot]};
      work.v[s] = {muscles.rest_vx[slot], muscles.rest_vy[slot], muscles.rest_vz[slot]};
      work.t[s] = glm::cross(work.u[s], work.v[s]);
      work.mobility[s] = section.end ? 0.0f : 1.0f / static_cast<float>(section.count);
      work.area_target[s] = section.rest_area;
      for (std::uint32_t i = section.first_radius; i < section.first_radius + section.count; ++i) {
        work.wanted[i] = work.radii[i] = muscles.rest_radii[i];
        work.least[i] = 0.15f * muscles.rest_radii[i];
        work.most[i] = 3.0f * muscles.rest_radii[i];
      }
    }
    place();
  }

  std::uint32_t section(std::uint32_t m, std::uint32_t k) const { return asset->first_section[m] + k; }
  std::uint32_t section_count(std::uint32_t m) const { return asset->first_section[m + 1] - asset->first_section[m]; }

  void move(std::uint32_t m, const glm::vec3& by) {
    for (std::uint32_t s = asset->first_section[m]; s < asset->first_section[m + 1]; ++s) {
      work.a[s] += by;
      work.driven[s] += by;
    }
  }
  void place() {
    muscle::place_directions(*asset, work);
    muscle::place_samples(*asset, work);
  }
  void find(const muscle::CollisionSettings& settings = {}) {
    muscle::place_directions(*asset, work);
    work.overflow = false;
    muscle::find_contacts(*asset, settings, bones, work);
  }
  float deepest() const {  // m: of the contacts there are; negative where nothing touches
    float depth = -1.0f;
    for (const muscle::Contact& contact : work.contacts) depth = std::max(depth, -contact.found);
    return depth;
  }
};

}  // namespace fascicle::test
