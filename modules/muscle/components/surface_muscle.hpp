// State: a muscle that is a deforming mesh, on an entity of its own. Its points live in the *simulation's frame*: the
// character's rest space, moved with the asset's frame bone, so that a character may stand anywhere and turn as it
// likes. world = frame * point.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/ecs/entity.hpp"
#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/collision/bone_field.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/kernels/surface/step_surface.hpp"

namespace fascicle::muscle {

struct SurfaceMuscle {
  std::shared_ptr<const SurfaceAsset> asset;
  ecs::Entity character;     // has BoneMatrices
  ecs::Entity musculature = ecs::kNoEntity;  // of the driver; kNoEntity: its bones carry it
  std::uint32_t driver = 0;  // index of the driving muscle in it
  std::vector<glm::mat4> rest_bones;                       // by bone: their frames -> rest space, at rest
  std::vector<std::shared_ptr<const BoneField>> fields;    // by bone; null where it has none
  SurfaceSettings settings;  // the asset's, until a game changes them
};

struct SurfaceState {
  AlignedVector<SurfacePoint> points;       // m, simulation's frame; vertices and padding
  AlignedVector<SurfacePoint> velocity;     // m/s beside the carriers' motion; inverse_mass unused
  std::vector<glm::mat4> bones;             // rest space -> simulation's frame, by bone, at the last step
  std::vector<RigidMotion> attachment_motion, carrier_motion, bone_motion;  // in the last step; as in SurfaceStep
  std::vector<const BoneField*> fields;     // likewise: of SurfaceMuscle::fields
  std::vector<glm::mat4> rest_to_bone;      // likewise
  glm::mat4 frame{1.0f};                    // simulation's frame -> world
  double volume = 0.0;                      // m^3, at the last pass
  std::uint64_t fallbacks = 0;              // steps at which it went back to where its carriers bring its rest shape
  std::uint32_t teleport_count = 0;         // of the bones at the last step
  bool enabled = true;                      // false: carried only, nothing is solved
  bool started = false;
  SurfaceScratch scratch;
};

// What is drawn or read by a game: world space, unit normals packed, in the asset's order of vertices.
struct DrawnSurface {
  AlignedVector<SurfaceVertex> vertices;
};

// A bone that the muscle touches after a step.
struct SurfaceContact {
  std::int32_t bone = -1;
  std::uint32_t vertices = 0;  // held at the bone's surface
  float depth = 0.0f;          // m: the furthest that one had to be pushed in a substep
  glm::vec3 place{0.0f};       // m, world: of that vertex
};
struct SurfaceContacts {
  std::vector<SurfaceContact> now;
};

// 4.3, by systems/5_present/measure_surfaces where a muscle has this component.
struct SurfaceQuality {
  double volume_ratio = 1.0;
  double edge_ratio_mean = 1.0, edge_ratio_abs_mean = 0.0, edge_ratio_max = 1.0, edge_ratio_min = 1.0;
  double edge_ratio_p5 = 1.0, edge_ratio_p50 = 1.0, edge_ratio_p95 = 1.0;
  double dihedral_change_mean = 0.0, dihedral_change_max = 0.0;  // rad
  double angle_max = 0.0;                    // rad: of two triangles that meet; pi is one turned inside out
  std::uint32_t folded = 0;                  // edges bent to 170 degrees or more that were not at rest
  std::uint32_t turned = 0;                  // edges whose triangles have swung through each other since rest
  double rest_distance_max = 0.0;            // m, from the places at rest in the simulation's frame
  double attachment_error_max = 0.0;         // m, from where their bones have the attached vertices
  std::vector<float> ratios;                 // scratch: by edge, in no order
  std::vector<float> angles;                 // rad, by edge: the dihedral angle, followed from rest beyond pi
};

// Fibres bound to the surface (4.4), on a surface muscle's entity.
struct FibreBundleAsset;  // asset/fibres/
struct FibreBundle {
  std::shared_ptr<const FibreBundleAsset> asset;
  AlignedVector<SurfacePoint> points;        // m, simulation's frame, fibre after fibre
  std::vector<float> length;                 // m, by fibre
  float length_ratio_mean = 1.0f;            // to rest
};

}  // namespace fascicle::muscle
