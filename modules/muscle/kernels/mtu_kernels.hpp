// The kernels of the musculotendon unit: pure functions over plain arrays, one per geometric idea, in frame order.
// Each exists once per instruction set, and beside it a reference: the same equations in plain scalar code, the tests'
// oracle and the benchmarks' yardstick.
//
//   check_bones     are all bone matrices finite?
//   place_points    bones -> the points a_k                         (1.1)  place_points.hpp
//   build_frames    a_k -> directions u_k, v_k, arc length, twist   (1.2)  build_frames.hpp
//   find_tendons    arc length -> where the tendons end             (1.4)  find_tendons.hpp
//   write_surfaces  all of it -> positions and normals              (1.3)  write_surfaces.hpp
//   measure_volume  all of it -> volume of the belly                (1.6)  measure_volume.hpp
//
// All pointers are to arrays as MuscleAsset and the components lay them out. Instruction sets agree bit for bit;
// the reference agrees to rounding.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/math/simd_level.hpp"
#include "modules/muscle/kernels/kernel_data.hpp"

namespace fascicle::muscle {

// Bone matrices whose entries are larger count as diverged (m, and per axis).
inline constexpr float kLargestBoneEntry = 1.0e5f;

struct PlacePointsJob {
  const float* bones = nullptr;           // 16 floats each, by columns
  const PointBinding* points = nullptr;   // single_count by one bone, then those by two
  const PointBinding* targets = nullptr;  // what the points become, by the same bones; null: nothing
  float morph = 0.0f;                     // how far they have, 0..1
  std::size_t single_count = 0;
  std::size_t count = 0;
  const std::uint8_t* held = nullptr;     // by muscle: 1 keeps its points; null: none
  float* x = nullptr;                     // by slot, m
  float* y = nullptr;
  float* z = nullptr;
};

struct BuildFramesJob {
  const float* bones = nullptr;
  const LaneBlock* blocks = nullptr;
  std::size_t block_count = 0;
  const EndFrame* ends = nullptr;         // by lane, origin's then insertion's
  const std::int32_t* held = nullptr;     // by lane: -1 keeps its frames, 0 does not; null: none
  bool restart_twist = false;             // after a jump: the twist nearest to zero, not to the last
  const float* x = nullptr;               // by slot, m
  const float* y = nullptr;
  const float* z = nullptr;
  float* ux = nullptr;                    // by slot
  float* uy = nullptr;
  float* uz = nullptr;
  float* vx = nullptr;
  float* vy = nullptr;
  float* vz = nullptr;
  float* arc = nullptr;                   // by slot, m
  float* twist = nullptr;                 // by lane, rad; read and written
};

struct FindTendonsJob {
  const LaneBlock* blocks = nullptr;
  std::size_t block_count = 0;
  const float* origin_lengths = nullptr;     // by lane, m
  const float* insertion_lengths = nullptr;
  const float* arc = nullptr;                // by slot, m
  // By lane, for the origin's and the insertion's border.
  std::int32_t* segment[2] = {};
  float* fraction[2] = {};
  float* border_arc[2] = {};                 // m from the origin
};

// What the surface and volume kernels read.
struct SectionsView {
  const SectionLayout* layouts = nullptr;  // by muscle
  std::size_t muscle_count = 0;
  const Circle* circles = nullptr;
  const float* x = nullptr;                // by slot
  const float* y = nullptr;
  const float* z = nullptr;
  const float* ux = nullptr;
  const float* uy = nullptr;
  const float* uz = nullptr;
  const float* vx = nullptr;
  const float* vy = nullptr;
  const float* vz = nullptr;
  const float* radii = nullptr;            // by MuscleAsset::radius, m
  const std::int32_t* segment[2] = {};     // by lane: tendon borders
  const float* fraction[2] = {};
  const std::uint8_t* attached = nullptr;  // by muscle: 0 collapses it; null: all are
};

struct WriteSurfacesJob {
  SectionsView sections;
  float* vertices = nullptr;  // 4 floats a vertex: position (m), normal packed 10:10:10:2; aligned to 32 bytes
  bool stream = false;        // store past the caches
};

struct MeasureVolumeJob {
  SectionsView sections;
  float* volumes = nullptr;   // by muscle, m^3
};

struct MtuKernels {
  // True when all `count` matrices are finite and within kLargestBoneEntry.
  bool (*check_bones)(const float* bones, std::size_t count);
  void (*place_points)(const PlacePointsJob& job);
  void (*build_frames)(const BuildFramesJob& job);
  void (*find_tendons)(const FindTendonsJob& job);
  void (*write_surfaces)(const WriteSurfacesJob& job);
  void (*measure_volume)(const MeasureVolumeJob& job);
};

// The kernels of a level; the caller sees to it that the processor has it.
const MtuKernels& mtu_kernels(SimdLevel level);

// The plain scalar twins, compiled with the same flags as that level's kernels.
const MtuKernels& mtu_reference_kernels(SimdLevel level);

}  // namespace fascicle::muscle
