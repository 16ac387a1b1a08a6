// One step of a surface muscle: XPBD (Macklin et al. 2016) in small substeps (2019), each with one pass, or some, over
// all constraints of 4.1.
//
//   predict    vertices go with their carriers; then their own velocity, which fades, moves them, and what holds them
//              in place pulls weakly
//   attach     attached vertices stand where their bones have them at the substep's end
//   hinges     edges and dihedral angles, colour after colour
//   volume     one Newton step of the whole mesh
//   contacts   what has come too near to other parts of the muscle, or to other muscles, is pushed apart
//              (surface_pairs.hpp)
//   bones      vertices are pushed out of level sets (bone_contact.hpp)
//   velocities from what all this has moved, beside the carriers; once a step their differences along edges fade
//
// **Why inertia.** One pass over constraints moves what is wrong by an edge's length; a muscle of a hundred edges from
// end to end would need thousands of passes to come to rest. With velocities a pass continues what the last one
// began, so errors travel like waves, and few substeps do what many passes without would (a heavy ball, as optimisers
// call it). Velocities are counted beside the carriers' motion and damped, so a character that runs does not shake its
// muscles: what is seen is close to the resting shape of the pose.
//
// **Why compliances.** The change of a constraint's multiplier is -C / (w + alpha / h^2): how far a constraint gives
// way depends on alpha and on what it works against, not on the number of substeps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/kernels/surface/bone_contact.hpp"
#include "modules/muscle/kernels/surface/surface_kernels.hpp"
#include "modules/muscle/kernels/surface/surface_pairs.hpp"

namespace fascicle::muscle {

// Scratch of one muscle's step, allocated once.
struct SurfaceScratch {
  AlignedVector<SurfacePoint> before, gradient;  // by vertex
  AlignedVector<SurfacePoint> anchors;           // by vertex: where the carriers bring the rest shape
  std::vector<std::uint32_t> near;               // bone after bone
  std::vector<std::size_t> first_near;           // by bone it collides with, and one more
  std::vector<VertexBall> balls;                 // about each kBallVertices vertices, at the step's start
  std::vector<glm::mat4> attached;               // by attachment: rest space -> simulation's frame, in a substep
  std::vector<float> moved;                      // 12 a carrier, see PredictJob
  std::vector<BoneTouch> touches;                // by bone it collides with
  std::vector<SurfaceBone> bones;                // likewise
  SurfaceBoxes boxes;                            // none where it has no contacts but with bones
  SurfacePairs itself;                           // contacts with itself
  float nearer = 0.0f;                           // m: how much nearer two of its parts may come in this step
  float pull = 0.0f;                             // see PredictJob
  double six_volumes = 0.0;                      // m^3, at the last pass
  std::uint32_t restarts = 0;                    // how often it was put where its carriers bring it
};
void lay_out(const SurfaceAsset& asset, SurfaceScratch& scratch);

// All matrices map the rest space to the simulation's frame, where a thing is at the step's start and at its end.
struct RigidMotion {
  glm::mat4 from{1.0f}, to{1.0f};
};
// Part of the way, 0..1: turned evenly, moved straight. Its ends are exact.
glm::dmat4 part_of(const RigidMotion& motion, double fraction);

struct SurfaceStep {
  const SurfaceAsset* asset = nullptr;
  const SurfaceKernels* kernels = nullptr;
  SurfaceSettings settings;                          // the asset's, or a game's own
  float step = 0.0f;                                 // s
  std::span<const RigidMotion> attachments;              // by attachment
  std::span<const RigidMotion> carriers;                 // by carrier
  std::span<const RigidMotion> bones;                    // by bone it collides with
  std::span<const BoneField* const> fields;          // likewise; null: none
  std::span<const glm::mat4> rest_to_bone;           // likewise: rest space -> the field's frame
  std::span<SurfacePoint> points;                    // with padding
  std::span<SurfacePoint> velocity;                  // m/s, with padding
};

// Returns the volume (m^3) at the last pass.
double step_surface(const SurfaceStep& step, SurfaceScratch& scratch);

// The same in parts, for muscles that touch each other and so go together, substep by substep:
//   begin_step; in each substep move_and_constrain, contacts between muscles, finish_substep; end_step.
void begin_step(const SurfaceStep& step, SurfaceScratch& scratch);
void move_and_constrain(const SurfaceStep& step, std::uint32_t substep, SurfaceScratch& scratch);
void finish_substep(const SurfaceStep& step, std::uint32_t substep, SurfaceScratch& scratch);
double end_step(const SurfaceStep& step, SurfaceScratch& scratch);

// Where the carriers bring the rest shape, attached vertices where their bones have them, without velocities: how a
// muscle starts, and what it falls back to. `step.*.to` counts. At rest the answer is the rest shape exactly.
// Returns its volume (m^3).
double carry_rest_shape(const SurfaceStep& step, SurfaceScratch& scratch);

// Finite, no vertex further from the first than a muscle can stretch, `volume` (m^3) one that it can have.
bool is_sound(const SurfaceAsset& asset, std::span<const SurfacePoint> points, double volume);

}  // namespace fascicle::muscle
