// How far a point is from a bone's surface: the bone's level set in a flat form, made for being asked by many points a
// frame. Immutable, shared by all characters of an asset; `build_bone_field` (bone_fields/) makes it from the bone's
// meshes by way of an OpenVDB level set.
//
// Distances are signed: negative inside, where the field is filled to the bone's middle. Space is cut into bricks;
// those near the surface or inside hold samples to interpolate between, the others a lower bound of the distance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/math/aligned_vector.hpp"

namespace fascicle::muscle {

struct FieldValue {
  float distance = 0.0f;      // m, negative inside
  glm::vec3 gradient{0.0f};   // unit, away from the bone; zero where the field is flat
};

class BoneField {
 public:
  // m. Points and answers are in the bone's frame. Beyond the samples the answer is a lower bound of the distance, at
  // least `band()`, and the gradient points away from the bone's box.
  float distance(const glm::vec3& point) const;
  FieldValue at(const glm::vec3& point) const;
  // The same for many points; spans of one length. No locks, no allocation.
  void distances(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                 std::span<float> distance) const;

  float band() const;            // m: up to here outside, distances are interpolated; beyond, bounded from below
  float voxel() const;           // m
  glm::vec3 lower() const;       // m: the bone's surface lies within this box
  glm::vec3 upper() const;
  std::size_t heap_bytes() const;
};

}  // namespace fascicle::muscle
