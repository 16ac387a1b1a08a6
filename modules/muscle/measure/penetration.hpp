// What a PenetrationMeter finds at one moment: how deep each muscle's drawn surface is in bones and in other muscles,
// and how much of that there is beyond another moment, usually the rest pose.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace fascicle::muscle {

// The deepest point of one muscle's surface in one bone or one other muscle.
struct PairDepth {
  std::uint32_t muscle = 0;   // whose surface it is a point of
  std::int32_t bone = -1;     // >= 0: what it is inside of, else
  std::uint32_t other = 0;    // the muscle that it is inside of
  float depth = 0.0f;         // m to the nearest place outside, above zero
  glm::vec3 position{0.0f};   // m, world
  float place = 0.0f;         // along the muscle's line, in sections from the origin
};

struct Penetration {
  std::vector<PairDepth> bones;    // by muscle, then bone
  std::vector<PairDepth> muscles;  // by the lower index of the two, then the higher: the deeper of both surfaces
  std::uint32_t points = 0;        // that were measured
  std::uint32_t left_out = 0;      // muscles with no surface, or one that is not finite
};

// The deepest of some pairs; a default one (of no depth) where there are none.
PairDepth deepest(const std::vector<PairDepth>& pairs);

// m, never below zero.
struct DepthsBeyond {
  // The deepest now less the deepest then, whichever pairs they belong to.
  float bone = 0.0f, muscle = 0.0f;
  // Each pair's depth now less the same pair's depth then (zero where they did not meet), and of these the largest:
  // never less than the above, for one pair's deep rest does not excuse another's.
  float bone_pair = 0.0f, muscle_pair = 0.0f;
};
DepthsBeyond beyond(const Penetration& now, const Penetration& rest);

// The depth of this pair there (m), zero where it does not meet.
float depth_of(const PairDepth& pair, const Penetration& there);

}  // namespace fascicle::muscle
