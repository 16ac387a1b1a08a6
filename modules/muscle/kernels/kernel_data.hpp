// The plain records that assets hold and kernels read. No library types with inline functions in here: the kernels'
// source files are compiled once per instruction set (see engine/math/wide_float.hpp).
#pragma once

#include <cstdint>

namespace fascicle::muscle {

// Muscles that a frame kernel runs side by side.
inline constexpr std::uint32_t kLanes = 16;
inline constexpr std::uint32_t kMaxSectionVertices = 256;

// A point of an action line: (1-s) T_i p_i + s T_j p_j, where p_i = a_i + R_i^-1 mu carries the fit's displacement
// (1.1). Kept ready to multiply: (1-s) p_i and (1-s); s p_j and s, all zero where one bone carries the point alone.
struct alignas(16) PointBinding {
  float first[4] = {};
  float second[4] = {};
  std::uint32_t first_bone = 0;
  std::uint32_t second_bone = 0;
  std::uint32_t slot = 0;
  std::uint32_t muscle = 0;
};

// A direction pair fixed in a bone, by which a muscle's end keeps its roll (1.2).
struct alignas(16) EndFrame {
  float tangent[4] = {1.0f, 0.0f, 0.0f, 0.0f};    // bone's frame; unit in the rest bones' space
  float reference[4] = {0.0f, 1.0f, 0.0f, 0.0f};  // likewise, square to the tangent
  std::uint32_t bone = 0;
  std::uint32_t fixed = 0;  // 1: the end section stands square to `tangent`, however the line runs (a wide attachment)
  std::uint32_t unused[2] = {};
};

// 16 muscles side by side; see MuscleAsset.
struct alignas(64) LaneBlock {
  std::int32_t counts[kLanes] = {};   // sections per lane; 0: an empty lane
  std::int32_t muscles[kLanes] = {};  // -1: an empty lane
  std::uint32_t first_slot = 0;
  std::uint32_t height = 0;           // sections of its longest muscle
};

// Where one muscle's sections, radii, rows and vertices lie.
struct SectionLayout {
  std::uint32_t section_vertices = 0;  // |C|
  std::uint32_t section_count = 0;     // t_LON
  std::uint32_t first_slot = 0;        // of section 0; section k: first_slot + kLanes * k
  std::uint32_t lane_index = 0;        // block * kLanes + lane
  std::uint32_t first_radius = 0;      // of section 0; section k: first_radius + radius_stride * k
  std::uint32_t radius_stride = 0;     // |C| rounded up to 8
  std::uint32_t first_row = 0;         // drawn rows: sections and tendon sections
  std::uint32_t row_count = 0;
  std::uint32_t first_vertex = 0;
  std::uint32_t vertex_count = 0;      // row_count |C| + 2
  std::uint32_t circle = 0;            // index into the asset's circles
  bool tendon_drawn[2] = {};           // at the origin, at the insertion: has a section C_t of its own
};

// cos and sin of theta_i = 2 pi i / |C|, going round for 16 numbers before i = 0 and after i = |C| too.
struct Circle {
  const float* cosines = nullptr;
  const float* sines = nullptr;
};

// A place on an action line: in segment (section, section + 1), at this fraction of it.
struct LinePlace {
  std::int32_t segment = 0;
  float fraction = 0.0f;
  float arc = 0.0f;  // m from the origin
};

// 4 bytes x 4: position (m) and packed normal.
inline constexpr std::uint32_t kFloatsPerVertex = 4;

}  // namespace fascicle::muscle
