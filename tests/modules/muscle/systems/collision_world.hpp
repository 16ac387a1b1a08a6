// A world with one character whose rods collide with each other and with bones that are formulas.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/loop/frame_time.hpp"
#include "modules/muscle/kernels/inflate_section.hpp"
#include "tests/modules/muscle/systems/muscle_world.hpp"
#include "tests/support/analytic_bones.hpp"
#include "tests/support/collision_rods.hpp"

namespace fascicle::muscle {

struct RodWorld : MuscleWorld {
  std::shared_ptr<const MuscleAsset> muscles;
  std::shared_ptr<const CollisionAsset> asset;
  std::vector<glm::mat4> bones;  // as they are now
  ecs::Entity character, musculature;

  RodWorld(const std::vector<test::Rod>& rods, const test::BoneFields& fields,
           const CollisionDescription& description = {}, int workers = 1)
      : MuscleWorld(workers), muscles(test::build_rods(rods, fields.size())),
        asset(test::build_collision(muscles, fields, description)), bones(fields.size(), glm::mat4(1.0f)) {
    character = add_character(bones);
    musculature = spawn_musculature(world, character, muscles);
    add_collision(world, musculature, std::vector{asset}, description.settings);
  }

  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  void place_bone(std::size_t bone, const glm::mat4& place) {
    bones[bone] = place;
    pose(character, bones);
  }
  // Moves a bone there at a walking pace, so that nothing jumps through anything.
  void bring_bone(std::size_t bone, const glm::vec3& to, int frames = 20) {
    const glm::vec3 from(bones[bone][3]);
    for (int i = 1; i <= frames; ++i) {
      glm::mat4 place = bones[bone];
      place[3] = glm::vec4(glm::mix(from, to, static_cast<float>(i) / static_cast<float>(frames)), 1.0f);
      place_bone(bone, place);
      step();
    }
  }

  MuscleCollision& collision() { return world.get<MuscleCollision>(musculature); }
  const MuscleContacts& contacts() { return world.get<MuscleContacts>(musculature); }
  const ActionLines& lines() { return world.get<ActionLines>(musculature); }
  const CrossSections& sections() { return world.get<CrossSections>(musculature); }
  glm::vec3 centre(std::uint32_t m, std::uint32_t k) { return line_point(*muscles, lines(), m, k); }
  std::span<const float> radii(std::uint32_t m, std::uint32_t k) {
    return std::span(sections().radii).subspan(muscles->radius(m, k), muscles->muscles[m].section_vertices);
  }
  float rest_radius(std::uint32_t m, std::uint32_t k, std::uint32_t i) const {
    return muscles->rest_radii[muscles->radius(m, k) + i];
  }
  glm::vec3 direction(std::uint32_t m, std::uint32_t k, std::uint32_t i) {
    const std::uint32_t slot = muscles->slot(m, k);
    const Circle& circle = muscles->circles[muscles->layouts[m].circle];
    const CrossSections& s = sections();
    return circle.cosines[i] * glm::vec3(s.ux[slot], s.uy[slot], s.uz[slot]) +
           circle.sines[i] * glm::vec3(s.vx[slot], s.vy[slot], s.vz[slot]);
  }

  // m: how deep the surfaces are in anything now, by a search of its own; negative where nothing touches.
  float deepest() {
    test::CollisionState state(asset, bones.size());
    state.bones = bones;
    const CrossSections& s = sections();
    for (std::size_t i = 0; i < asset->sections.size(); ++i) {
      const std::uint32_t slot = asset->sections[i].slot;
      state.work.a[i] = {lines().x[slot], lines().y[slot], lines().z[slot]};
      state.work.u[i] = {s.ux[slot], s.uy[slot], s.uz[slot]};
      state.work.v[i] = {s.vx[slot], s.vy[slot], s.vz[slot]};
      state.work.t[i] = glm::cross(state.work.u[i], state.work.v[i]);
    }
    std::copy(s.radii.begin(), s.radii.end(), state.work.radii.begin());
    state.find();
    return state.deepest();
  }
  bool finite() {
    for (const AlignedVector<float>* axis : {&lines().x, &lines().y, &lines().z}) {
      for (const float value : *axis) {
        if (!std::isfinite(value)) return false;
      }
    }
    for (std::uint32_t m = 0; m < muscles->size(); ++m) {
      for (std::uint32_t k = 0; k < muscles->muscles[m].section_count; ++k) {
        for (const float radius : radii(m, k)) {
          if (!std::isfinite(radius)) return false;
        }
      }
    }
    for (const SurfaceVertex& vertex : world.get<MuscleSurfaces>(musculature).vertices) {
      if (!std::isfinite(vertex.position.x + vertex.position.y + vertex.position.z)) return false;
    }
    return true;
  }
  // How far centres and radii are from the shape at rest, m.
  float deformation() {
    float furthest = 0.0f;
    for (const CollisionSection& section : asset->sections) {
      const MuscleCollision& c = collision();
      furthest = std::max(furthest, glm::length(glm::vec3(c.offset_x[section.slot], c.offset_y[section.slot],
                                                          c.offset_z[section.slot])));
      for (std::uint32_t i = 0; i < section.count; ++i) {
        const float now = radii(section.muscle, section.section)[i];
        furthest = std::max(furthest, std::abs(now - rest_radius(section.muscle, section.section, i)));
      }
    }
    return furthest;
  }
  glm::vec3 rest_centre(std::uint32_t m, std::uint32_t k) const { return rest_point(*muscles, m, k); }
};

inline test::Rod rod_along_z(float x = 0.0f, float y = 0.0f) {
  return {.from = {x, y, -0.1f}, .to = {x, y, 0.1f}};
}

// Bone 1's surface is at y = -30 mm, 10 mm below a rod on bone 0.
inline test::BoneFields ground() {
  return {nullptr, test::box_bone({-0.08f, -0.1f, -0.15f}, {0.08f, -0.03f, 0.15f})};
}

// Rods on two bones that cross at a right angle, 10 mm apart in y; bone 1 carries the upper one.
inline std::vector<test::Rod> crossing_rods() {
  return {{.from = {0, 0, -0.1f}, .to = {0, 0, 0.1f}},
          {.from = {-0.1f, 0.05f, 0}, .to = {0.1f, 0.05f, 0}, .from_bone = 1, .to_bone = 1}};
}

}  // namespace fascicle::muscle
