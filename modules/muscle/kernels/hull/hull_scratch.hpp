// What posing a muscle by its hull works with, allocated once a muscle, and what it tells about the last pose.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/kernels/hull/hull_kernels.hpp"
#include "modules/muscle/kernels/surface/bone_contact.hpp"

namespace fascicle::muscle {

// A sample that must not come nearer to a bone: normal . (move) >= need.
struct SampleContact {
  std::uint32_t sample = 0, bone = 0;  // `bone`: of those that the muscle collides with
  glm::vec3 normal{0.0f};              // unit, out of the bone
  float need = 0.0f;                   // m; negative: how far it may still go
};

// Each costs a row of a dense problem in every iteration.
inline constexpr std::size_t kMostContacts = 48;
inline constexpr std::size_t kMostRows = kMostContacts + 1;  // the volume first

// The muscle with its hull's vertices moved by some U.
struct HullState {
  AlignedVector<SurfacePoint> moved;      // U, m, by hull vertex
  AlignedVector<SurfacePoint> stiff;      // A U
  AlignedVector<SurfacePoint> samples;    // m: their places
  std::vector<MatrixPack> shape;          // S, by cluster
  std::vector<MatrixPack> rotations;      // R
  std::vector<SampleContact> contacts;    // deepest first
  double energy = 0.0;                    // E / 2
  double volume = 0.0;                    // m^3, of the samples' mesh
};

struct HullScratch {
  std::vector<float> residuals;           // of the last pose, by iteration: how far it moved a hull vertex at most, as a
                                          // part of the muscle's size
  std::vector<float> refined;             // likewise of the full mesh's iterations and vertices
  std::vector<BoneTouch> touches;         // by bone it collides with

  std::vector<SurfaceBone> bones;         // likewise
  std::vector<VertexBall> balls;          // about kBallVertices samples, or vertices
  std::vector<std::uint32_t> near;        // samples, or vertices
  std::vector<std::uint8_t> taken;        // by cluster
  HullState state, trial;
  AlignedVector<SurfacePoint> load;       // by hull vertex
  // Of one iteration, by hull vertex unless said.
  AlignedVector<SurfacePoint> step, residual, direction, conditioned, product;
  AlignedVector<SurfacePoint> columns;    // by column of each cluster's matrix
  AlignedVector<SurfacePoint> volume_row, volume_solution;  // J_0, A^-1 J_0^T
  AlignedVector<SurfacePoint> sample_gradient;              // m^2, by sample
  AlignedVector<SurfacePoint> sample_moves;                 // m, by sample
  double volume_price = 0.0;                                // the volume's multiplier; 0: its curvature is left out
  std::vector<std::array<float, 6>> turn_inverse;           // by cluster: see newton_step.hpp
  // Of the full mesh, by vertex.
  AlignedVector<SurfacePoint> brought;    // m: where the hull brought it, or a bone's surface
  AlignedVector<SurfacePoint> before;     // m: where it was before it was pushed out of bones
  AlignedVector<SurfacePoint> bent;       // 1/m: R_i d_0i - d_i
  AlignedVector<SurfacePoint> gradient;   // m^2
  std::vector<MatrixPack> vertex_shape, vertex_rotations;
  std::vector<EightColumns> columns_of_factor;
};

void lay_out(const SurfaceAsset& surface, const HullAsset& hull, HullScratch& scratch);

}  // namespace fascicle::muscle
