// Measures how deep muscles are in bones and in each other, from nothing but what is drawn: points every few
// millimetres on each muscle's surface (sample_surface.hpp) against the bones' original triangles and against the
// other muscles' closed surfaces, caps included. It shares no data and no code with the solve, so that one can be
// held to the other.
//
//   PenetrationMeter meter(asset, make_bone_solids(character.bone_meshes));
//   const Penetration rest = meter.measure(...), now = meter.measure(...);
//   report(beyond(now, rest));
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/tendons.hpp"
#include "modules/muscle/measure/bone_solids.hpp"
#include "modules/muscle/measure/penetration.hpp"

namespace fascicle::muscle {

inline constexpr float kSampleSpacing = 0.003f;  // m

class PenetrationMeter {
 public:
  PenetrationMeter(std::shared_ptr<const MuscleAsset> asset, std::shared_ptr<const BoneSolids> bones,
                   float spacing = kSampleSpacing);

  // Surfaces and tendons of the asset, with the bones (bone to world, rigid) that they were made with. In parallel on
  // the caller's arena; the result does not depend on it.
  Penetration measure(const MuscleSurfaces& surfaces, const Tendons& tendons, std::span<const glm::mat4> bones);

 private:
  // One muscle's surface as others are measured against it.
  struct Solid {
    SolidTree tree;
    std::vector<glm::vec3> positions;
    std::vector<float> row_places;
    std::vector<Box> bands;  // between two drawn rows
    Box box;
    bool usable = false;
  };
  struct Task;

  void move(std::uint32_t muscle, const MuscleSurfaces& surfaces, const Tendons& tendons);

  std::shared_ptr<const MuscleAsset> asset_;
  std::shared_ptr<const BoneSolids> bones_;
  float spacing_;
  std::vector<Solid> solids_;  // by muscle
};

}  // namespace fascicle::muscle
