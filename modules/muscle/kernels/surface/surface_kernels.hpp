// The constraints of surface muscles (4.1), solved over packs of hinges, one instruction set a file. All instruction
// sets give the same bits; `surface_reference.hpp` holds the same equations in plain scalar code.
#pragma once

#include <cstdint>
#include <span>

#include "engine/math/simd_level.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/asset/surface/vertex_rings.hpp"

namespace fascicle::muscle {

// Hinges below these are left alone: they have no direction to act in.
inline constexpr float kShortestEdge = 1.0e-7f;     // m
inline constexpr float kSmallestArea2 = 1.0e-20f;   // m^4, of |N|^2

// One pass over all hinges in the packs' order: each hinge's edge, then its angle.
//   edge   C = |p_2 - p_1| - d,      d lambda = -C / (w_1 + w_2 + alpha / (k h^2))
//   angle  C = wrap(theta - theta_0), d lambda = -C / (sum w_i |grad_i C|^2 + alpha_b / h^2)
// Points gain w_i grad_i C d lambda. A hinge without an area on one side, or an edge without a length, is left alone.
struct HingeJob {
  std::span<const HingePack> packs;
  std::span<SurfacePoint> points;     // with padding
  float inverse_h2 = 0.0f;            // 1/s^2
};

// The volume (4.1): C = V - V_0 with V = sum p_a . (p_b x p_c) over the triangles, about the mesh's first point; one
// Newton step on the whole constraint. Sums run over fixed chunks, so they do not depend on lanes.
struct VolumeJob {
  std::span<const std::uint32_t> triangles;
  std::uint32_t vertex_count = 0;
  std::span<SurfacePoint> points;
  std::span<SurfacePoint> gradient;   // scratch, vertex_count
  double rest = 0.0;                  // V_0: six times the volume, as the same kernel measures it at rest
  float compliance = 0.0f;            // alpha_v / h^2, in the constraint's own units (six volumes)
  const VertexRings* rings = nullptr; // of the triangles; without them the plain code does it
};

// Starts a substep: carried points go with their carriers, `before` keeps where they are, velocities fade and act, and
// what holds the muscle in place pulls: point += pull (anchor - point).
struct PredictJob {
  std::span<const CarryWeights> carry;    // empty: nothing carries
  std::span<const float> moved;           // 12 a carrier: rows of how it moves in this substep, less the identity
  std::uint32_t vertex_count = 0;
  std::span<SurfacePoint> points, before, velocity;
  float h = 0.0f;                         // s
  float keep = 1.0f;                      // exp(-damping h)
  std::span<const SurfacePoint> anchors;  // m, by vertex; unused without a pull
  float pull = 0.0f;                      // 0..1, w / (w + alpha_a / h^2)
};

// Where carriers bring points: out = rest + the weighted sum of what each does to it.
struct CarryJob {
  std::span<const CarryWeights> carry;    // empty: nothing carries
  std::span<const float> moved;           // 12 a carrier: rows of its matrix, less the identity
  std::uint32_t vertex_count = 0;
  std::span<const SurfacePoint> rest;
  std::span<SurfacePoint> out;
};

// Velocities' differences along edges fade (4.3's muscles do not ring): one pass over the packs, in which each edge's
// ends give each other `share` of what they differ by, the lighter one the most. Momentum is kept; held points stay.
struct ViscosityJob {
  std::span<const HingePack> packs;
  std::span<const SurfacePoint> points;   // with padding: masses
  std::span<SurfacePoint> velocity;       // with padding
  float share = 0.0f;                     // 0..1: 1 - exp(-viscosity t)
};

struct SurfaceKernels {
  void (*project_hinges)(const HingeJob& job);
  // Returns six times the volume before the step.
  double (*project_volume)(const VolumeJob& job);
  // Six times the volume, nothing moved.
  double (*measure_volume)(const VolumeJob& job);
  void (*carry)(const CarryJob& job);
  void (*predict)(const PredictJob& job);
  // velocity = (points - before) / h.
  void (*take_velocities)(const PredictJob& job);
  // Lengths (m) and angles (rad) of all lanes, by the code of project_hinges, so that a mesh at rest is exactly so.
  void (*measure_hinges)(std::span<const HingePack> packs, std::span<const SurfacePoint> points,
                         std::span<float> lengths, std::span<float> angles);
  void (*fade_differences)(const ViscosityJob& job);
};

// Of the level or the best below it that the processor has.
const SurfaceKernels& surface_kernels(SimdLevel level);

}  // namespace fascicle::muscle
