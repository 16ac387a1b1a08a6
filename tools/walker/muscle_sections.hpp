// Where each belly lies at rest and how wide it is along its way: a curve that follows the action line, is pushed off
// bones and neighbouring bellies until they fit side by side, and carries a bent ellipse at each of its stations.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "tools/walker/bone_shapes.hpp"
#include "tools/walker/muscle_table.hpp"

namespace fascicle::walker {

// A cross section: an ellipse of half width w and half thickness h whose width follows an arc that bends away from v.
struct Section {
  glm::vec3 centre{0.0f}, tangent{0.0f}, u{0.0f}, v{0.0f};
  float w = 0.0f, h = 0.0f;  // m
  float bend = 0.0f;         // rad over the whole width
  float skew = 0.0f;

  // Character space of ellipse coordinates (1 = the rim).
  glm::vec3 point(const glm::vec2& e) const;
  // Ellipse coordinates of a point in the section's plane.
  glm::vec2 coordinates(const glm::vec3& p) const;
};

struct Belly {
  const MuscleSpec* muscle = nullptr;
  std::vector<Section> sections;  // origin to insertion
  float length = 0.0f;            // m, of the curve

  // 0 on the curve, 1 on the ellipses' rim, rising outwards and beyond the ends.
  float normalised_radius(const glm::vec3& p) const;
};

// One belly for each muscle, with `stations[i]` sections.
std::vector<Belly> arrange_bellies(const std::vector<MuscleSpec>& muscles, const std::vector<BoneShape>& bones,
                                   const std::vector<std::size_t>& stations);
// Scales the belly's sections (its ends keep their size) so that its volume changes by `factor`.
void grow_belly(Belly& belly, float factor);

}  // namespace fascicle::walker
