// Which muscle a ray meets first, and the section and vertex of its surface that are nearest to where.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "engine/render/pick.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/tendons.hpp"

namespace fascicle::muscle {

struct MusclePick {
  float distance = 0.0f;       // m along the ray
  glm::vec3 place{0.0f};       // m, world
  std::uint32_t muscle = 0, section = 0, vertex = 0;  // never a muscle's first or last section: those are its ends
};

// Of the drawn surfaces; `hidden` by muscle, 1: it is seen through (may be empty). Nothing where no muscle is met.
std::optional<MusclePick> pick_muscle(const MuscleAsset& asset, const MuscleSurfaces& surfaces, const Tendons& tendons,
                                      std::span<const std::uint8_t> hidden, const Ray& ray);

}  // namespace fascicle::muscle
