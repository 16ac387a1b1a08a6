// All muscles of one character, solver-ready: what is known at rest and never changes while it moves. One asset is
// shared by every character that uses it; `build_muscle_asset` makes it, components hold the state.
//
// Three orders of data, all flat over the asset's muscles:
//
// - Slots hold one value per section (a_k, u_k, v_k, arc length). Muscles are sorted by section count and packed into
//   blocks of 16 lanes; a block holds row after row, [section][lane]. A frame is a chain of steps along one muscle, so
//   the kernels run 16 muscles side by side. Section k of a muscle lives in slot first_slot + 16 k. Slots of lanes
//   that end early hold copies of the last section's values (the kernels write them, nobody need read them).
// - Radii hold one row of radius_stride floats per section, muscle after muscle; the first |C| are meant.
// - Vertices are what is drawn: per muscle rows of |C| vertices from origin to insertion, the tendon sections in their
//   place among them, then the two cap centres (origin, insertion). No gaps: vertex_count = rows |C| + 2.
//
// Units: m, kg, s, N, rad. Equations: the method's page 1.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/muscle_description.hpp"

namespace fascicle::muscle {

inline constexpr std::uint32_t kLanes = 16;
inline constexpr std::uint32_t kRestartIndex = 0xffffffffu;
inline constexpr float kMuscleDensity = 1059.7f;          // kg/m^3
inline constexpr float kDefaultSpecificTension = 61.0e4f;  // N/m^2

// A point of an action line: (1-s) T_i p_i + s T_j p_j, where p_i = a_i + R_i^-1 mu carries the fit's displacement
// (1.1). Kept ready to multiply: (1-s) p_i and (1-s), s p_j and s.
struct alignas(16) PointBinding {
  std::array<float, 4> first{};   // (1-s) p_i, (1-s)
  std::array<float, 4> second{};  // s p_j, s; all zero where one bone carries the point alone
  std::uint32_t first_bone = 0;
  std::uint32_t second_bone = 0;
  std::uint32_t slot = 0;
  std::uint32_t muscle = 0;
};

// A direction pair fixed in a bone, by which a muscle's end keeps its roll (1.2).
struct EndFrame {
  std::uint32_t bone = 0;
  glm::vec3 tangent{0.0f};    // bone's frame, unit at rest
  glm::vec3 reference{0.0f};  // bone's frame, unit at rest, square to the tangent
};

enum class MuscleEnd { kOrigin = 0, kInsertion = 1 };

// Drawn tendon at one end (1.4).
struct TendonEnd {
  bool drawn = false;    // has a section C_t of its own
  float length = 0.0f;   // m, of free tendon; fixed (a rigid tendon)
};

// Where one muscle's data lies, and its constants.
struct MuscleLayout {
  std::string name;
  std::uint32_t section_vertices = 0;  // |C|
  std::uint32_t section_count = 0;     // t_LON
  std::uint32_t subdivision = 0;       // LSS
  std::uint32_t attachment_count = 0;  // |V| + 2; attachment i is section i << LSS

  std::uint32_t first_slot = 0;        // slot of section 0; section k: first_slot + kLanes * k
  std::uint32_t lane_index = 0;        // block * kLanes + lane
  std::uint32_t first_radius = 0;      // of section 0; section k: first_radius + radius_stride * k
  std::uint32_t radius_stride = 0;     // |C| rounded up to 8
  std::uint32_t first_row = 0;         // drawn rows: sections and tendon sections
  std::uint32_t row_count = 0;
  std::uint32_t first_vertex = 0;
  std::uint32_t vertex_count = 0;      // row_count |C| + 2
  std::uint32_t first_attachment = 0;  // into attachment_points
  std::uint32_t first_strip_index = 0, strip_index_count = 0;
  std::uint32_t first_fan_index = 0, fan_index_count = 0;

  HillParameters hill;
  float specific_tension = kDefaultSpecificTension;  // N/m^2
  float rest_length = 0.0f;          // m, l_AS: along the attachments at rest
  float source_length = 0.0f;        // m, l_A
  float source_rest_length = 0.0f;   // m, l_R
  float scaled_rest_length = 0.0f;   // m, l_RS
  float scaled_tendon_slack_length = 0.0f;  // m, l_TSs
  std::array<TendonEnd, 2> tendons;  // by MuscleEnd
  float rest_volume = 0.0f;          // m^3, of the belly
  std::array<EndFrame, 2> ends;      // by MuscleEnd

  // What table 3 counts: extra via points left out, tendon sections left out.
  std::uint32_t counted_sections = 0;
  std::uint32_t counted_vertices = 0;  // counted_sections |C| + 2
};

// A block of 16 lanes.
struct LaneBlock {
  std::uint32_t first_slot = 0;
  std::uint32_t height = 0;                           // sections of its longest muscle
  alignas(64) std::array<std::int32_t, kLanes> counts{};  // sections per lane; 0: an empty lane
  std::array<std::int32_t, kLanes> muscles{};         // -1: an empty lane
};

// cos and sin of theta_i = 2 pi i / |C|, padded by going round again.
struct CircleTable {
  std::uint32_t section_vertices = 0;
  AlignedVector<float> cosines, sines;
};

struct MuscleAsset {
  std::vector<MuscleLayout> muscles;  // in the descriptions' order
  std::uint32_t bone_count = 0;       // matrices that the character must have

  std::uint32_t slot_count = 0, radius_count = 0, row_count = 0, vertex_count = 0, lane_count = 0;
  std::vector<LaneBlock> blocks;
  std::vector<CircleTable> circles;               // one per distinct |C|
  std::vector<std::uint32_t> circle_of_muscle;    // index into circles

  // Bindings by one bone first, then those between two. Padding slots have none.
  std::vector<PointBinding> points;
  std::uint32_t single_point_count = 0;

  // Rest state, in the order of the components' arrays.
  AlignedVector<float> rest_x, rest_y, rest_z;    // slots; m, in the rest bones' space
  AlignedVector<float> rest_radii;                // m

  // Constant drawing data, indices into the asset's vertices, kRestartIndex after each strip and fan.
  std::vector<std::uint32_t> strip_indices;  // 2 (|C| + 1) a segment
  std::vector<std::uint32_t> fan_indices;    // |C| + 2 a cap
  std::vector<std::uint32_t> vertex_rows;    // a vertex's row; cap centres have their end's row
  std::vector<std::uint32_t> row_muscles;    // a row's muscle

  std::size_t size() const { return muscles.size(); }
  std::uint32_t slot(std::uint32_t muscle, std::uint32_t section) const {
    return muscles[muscle].first_slot + kLanes * section;
  }
  std::uint32_t radius(std::uint32_t muscle, std::uint32_t section) const {
    return muscles[muscle].first_radius + muscles[muscle].radius_stride * section;
  }
};

// The muscle's index, or -1.
std::int32_t find_muscle(const MuscleAsset& asset, std::string_view name);

// Totals as the article's table 3 counts them.
struct MuscleCounts {
  std::uint32_t muscles = 0, sections = 0, vertices = 0;
};
MuscleCounts count_muscles(const MuscleAsset& asset);

// The rest place of a section's centre a_k (m), and of its vertices.
glm::vec3 rest_point(const MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section);

// The muscle's 3 |C| (t_LON - 1) tetrahedra (1.6), matching across shared faces and with the drawn surface's
// diagonals. Node numbers: vertex i of section k is k |C| + i; centre a_k is t_LON |C| + k.
std::vector<std::array<std::uint32_t, 4>> tetrahedra_of(const MuscleAsset& asset, std::uint32_t muscle);

std::size_t heap_bytes(const MuscleAsset& asset);

}  // namespace fascicle::muscle
