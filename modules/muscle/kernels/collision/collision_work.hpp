// Scratch of one musculature's collision in one step: its state in the order that the solve wants, and the contacts
// found. Nothing in here outlives the step; `reserve` sizes everything before the first one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/math/aligned_vector.hpp"

namespace fascicle::muscle {

struct CollisionAsset;

inline constexpr std::uint32_t kCentreRow = 0xffffffffu;  // a contact of a section's centre

// A sample of a surface that may not get deeper into a bone or another muscle: C = n . (c - q) - base >= 0, linear in
// the centres and radii that carry the sample c and, of another muscle, the point q of its outline.
struct Contact {
  glm::vec3 normal{0.0f};              // unit, world: out of the other
  float base = 0.0f;                   // m
  std::uint32_t section = 0;           // the sample lies between this section and the next
  float weight[2] = {};                // of the two sections
  std::uint32_t radius[4] = {};        // of the vertices that it hangs on, two of each
  float share[4] = {};                 // of these vertices
  float lever[4] = {};                 // dC/dr
  std::int32_t bone = -1;              // >= 0: place in CollisionAsset::bones; else another muscle's:
  std::uint32_t other_section = 0;     // before q
  float other_weight[2] = {};
  std::uint32_t other_radius[4] = {};  // two vertices of each section
  float other_lever[4] = {};           // dC/dr
  float inverse_mass = 0.0f;           // of the constraint: 1 / (sum of w |dC|^2)
  float found = 0.0f;                  // m: C where it was found; negative: too deep
  float bias = 0.0f;                   // m, <= 0: what C may still be in this substep
  float value = 0.0f;                  // m: C when it was last looked at
  float push = 0.0f;                   // what it has pushed in this solve (its multiplier), >= 0
  std::uint32_t row = 0, sample = 0;   // which: of the row
  float allowed = 0.0f;                // m: depth that there is at rest
  glm::vec3 place{0.0f};               // m, world: of the sample where it was found
};

struct Bounds {
  glm::vec3 lower{0.0f}, upper{0.0f};  // m, world
};

// A row of samples as a flat disc about its centre.
struct RowDisc {
  glm::vec3 centre{0.0f}, normal{0.0f};      // m, world; unit
  float radius = 0.0f, thickness = 0.0f;     // m: no sample is further from the centre, or from the plane
};

struct CollisionWork {
  // By section (CollisionAsset::sections).
  std::vector<glm::vec3> a, driven;    // m, world: the centre, and where the bones carry it
  std::vector<glm::vec3> u, v, t;      // unit
  std::vector<float> mobility;         // inverse mass of a_k; 0 at ends
  std::vector<float> area_target;      // m^2
  std::vector<float> widest;           // m: the largest radius
  std::vector<std::uint8_t> turned;    // 1: has negative radii

  std::vector<std::uint8_t> absent;    // by muscle: 1: detached, touches nobody

  // By MuscleAsset::radius.
  AlignedVector<float> radii, wanted;                    // m; the wanted ones have the target area
  AlignedVector<float> least, most;                      // m
  AlignedVector<float> sector;                           // m: the largest radius about those of vertex i and i + 1
  AlignedVector<float> dir_x, dir_y, dir_z;              // unit, from a_k to the vertex
  AlignedVector<float> vertex_x, vertex_y, vertex_z;     // m, world
  std::vector<std::uint8_t> pressed;                     // 1: a contact holds the radius

  // By sample.
  AlignedVector<float> sample_x, sample_y, sample_z;     // m, world

  // Boxes of the segments (by the section before), rows and muscles.
  std::vector<Bounds> segment_boxes, row_boxes, muscle_boxes;
  std::vector<RowDisc> row_discs;

  // The broad phase's grid: hashed cells, each a run of segments.
  float cell = 0.0f;                   // m
  std::vector<std::uint32_t> cell_starts, cell_segments, stamps;

  std::vector<Contact> contacts;       // capacity is fixed
  bool overflow = false;               // more contacts than there was room for

  void reserve(const CollisionAsset& asset);
};

std::size_t heap_bytes(const CollisionWork& work);

}  // namespace fascicle::muscle
