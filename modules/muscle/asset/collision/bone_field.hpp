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

inline constexpr int kBrickSamples = 8;                 // along each side of a brick
inline constexpr int kBrickCells = kBrickSamples - 1;   // neighbours share the samples of the face between them
inline constexpr std::size_t kSamplesPerBrick = 512;
inline constexpr float kNowhere = 1e9f;  // m: the distance of points that are not finite, and from no bone at all

// What a field is made of. Brick (i, j, k) is number (i count.y + j) count.z + k; its samples run the same way.
struct BoneSamples {
  float voxel = 0.0f;                   // m between samples
  float band = 0.0f;                    // m
  glm::vec3 lower{0.0f}, upper{0.0f};   // m: the surface's box
  glm::vec3 origin{0.0f};               // m: the first sample of the first brick
  glm::ivec3 count{0};                  // of bricks; they cover the box and the band about it
  std::vector<std::uint32_t> bricks;    // numbers of those with samples, rising: all that come within the band and a
                                        // voxel of the surface, or hold something inside
  AlignedVector<float> samples;         // m, kSamplesPerBrick each; none is more than the distance outside
};

class BoneField {
 public:
  BoneField() = default;  // no bone: kNowhere from everywhere
  explicit BoneField(BoneSamples samples);

  // m. Points and answers are in the bone's frame. Beyond the samples the answer is a lower bound of the distance, at
  // least `band()`, and the gradient points away from the bone's box.
  float distance(const glm::vec3& point) const;
  FieldValue at(const glm::vec3& point) const;
  // The same for many points; spans of one length. No locks, no allocation.
  void distances(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                 std::span<float> distance) const;

  // m: up to here outside, distances are interpolated; beyond, bounded from below.
  float band() const { return band_; }
  float voxel() const { return voxel_; }             // m
  const glm::vec3& lower() const { return lower_; }  // m: the bone's surface lies within this box
  const glm::vec3& upper() const { return upper_; }
  std::size_t brick_count() const { return samples_.size() / kSamplesPerBrick; }  // those with samples
  std::size_t heap_bytes() const;

 private:
  struct Cell;
  bool find_cell(const glm::vec3& point, Cell& cell) const;
  float interpolate(const Cell& cell) const;
  float far_distance(const glm::vec3& point) const;
  glm::vec3 away(const glm::vec3& point) const;

  float voxel_ = 0.0f, band_ = 0.0f, inverse_voxel_ = 0.0f;
  glm::vec3 lower_{0.0f}, upper_{0.0f}, origin_{0.0f};
  glm::vec3 extent_{-1.0f};  // in samples, from the first to the last of all bricks; negative: no bone
  glm::ivec3 count_{0};
  // By brick: the place of its samples, in bricks; or, with the sign bit set, the bits of -bound, a float in m.
  std::vector<std::uint32_t> table_;
  AlignedVector<float> samples_;
};

}  // namespace fascicle::muscle
