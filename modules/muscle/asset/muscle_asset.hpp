// All muscles of one character, solver-ready: what is known at rest and never changes while it moves. One asset is
// shared by every character that uses it; `build_muscle_asset` makes it, components hold the state.
//
// Three orders of data, all flat over the asset's muscles:
//
// - Slots hold one value per section (a_k, u_k, v_k, arc length). Muscles are sorted by section count and packed into
//   blocks of 16 lanes; a block holds row after row, [section][lane]. A frame is a chain of steps along one muscle, so
//   the kernels run 16 muscles side by side. Section k of a muscle lives in slot first_slot + 16 k. Slots of lanes
//   that end early hold copies of the last section's values (the kernels write them, nobody need read them).
// - Radii hold one row of radius_stride floats per section, muscle after muscle; the first |C| are meant. There are 16
//   unused floats before the first row and after the last.
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
#include "modules/muscle/kernels/kernel_data.hpp"

namespace fascicle::muscle {

inline constexpr std::uint32_t kRestartIndex = 0xffffffffu;
inline constexpr float kMuscleDensity = 1059.7f;          // kg/m^3
inline constexpr float kDefaultSpecificTension = 61.0e4f;  // N/m^2

enum class MuscleEnd { kOrigin = 0, kInsertion = 1 };

// One muscle: where its data lies (SectionLayout), and its constants.
struct MuscleLayout : SectionLayout {
  std::string name;
  std::uint32_t subdivision = 0;       // LSS
  std::uint32_t attachment_count = 0;  // |V| + 2; attachment i is section i << LSS
  // Slot of attachment 0 and the step to the next: the functional length reads these. Attachments that a fit has
  // displaced have slots of their own, behind all sections'.
  std::uint32_t first_attachment_slot = 0, attachment_slot_step = 0;
  std::uint32_t first_strip_index = 0, strip_index_count = 0;
  std::uint32_t first_fan_index = 0, fan_index_count = 0;

  HillParameters hill;
  float specific_tension = kDefaultSpecificTension;  // N/m^2
  float rest_length = 0.0f;          // m, l_AS: along the attachments at rest
  float source_length = 0.0f;        // m, l_A
  float source_rest_length = 0.0f;   // m, l_R
  float scaled_rest_length = 0.0f;   // m, l_RS
  float scaled_tendon_slack_length = 0.0f;  // m, l_TSs
  std::array<float, 2> tendon_lengths{};    // m, by MuscleEnd: free tendon drawn; fixed (a rigid tendon)
  float rest_volume = 0.0f;          // m^3, of the belly

  // What table 3 counts: extra via points left out, tendon sections left out.
  std::uint32_t counted_sections = 0;
  std::uint32_t counted_vertices = 0;  // counted_sections |C| + 2
};

// The table that a Circle points into.
struct CircleTable {
  std::uint32_t section_vertices = 0;
  AlignedVector<float> cosines, sines;
};

struct MuscleAsset {
  std::vector<MuscleLayout> muscles;  // in the descriptions' order
  std::uint32_t bone_count = 0;       // matrices that the character must have

  std::uint32_t slot_count = 0, radius_count = 0, row_count = 0, vertex_count = 0, lane_count = 0;
  std::vector<SectionLayout> layouts;             // by muscle: the part that kernels walk over, by itself
  std::vector<LaneBlock> blocks;
  std::vector<CircleTable> circle_tables;         // one per distinct |C|
  std::vector<Circle> circles;                    // pointers into them, by SectionLayout::circle
  std::vector<EndFrame> ends;                     // by lane: the origin's, the insertion's
  std::array<AlignedVector<float>, 2> tendon_lengths;  // by MuscleEnd and lane, m

  // Bindings by one bone first, then those between two. Padding slots have none.
  std::vector<PointBinding> points;
  std::uint32_t single_point_count = 0;

  // Rest state, in the order of the components' arrays.
  AlignedVector<float> rest_x, rest_y, rest_z;    // slots; m, in the rest bones' space
  AlignedVector<float> rest_ux, rest_uy, rest_uz, rest_vx, rest_vy, rest_vz;  // slots
  AlignedVector<float> rest_arc;                  // slots; m
  AlignedVector<float> rest_radii;                // m

  // Constant drawing data, indices into the asset's vertices, kRestartIndex after each strip and fan.
  std::vector<std::uint32_t> strip_indices;  // 2 (|C| + 1) a segment
  std::vector<std::uint32_t> fan_indices;    // |C| + 2 a cap
  std::vector<std::uint32_t> vertex_rows;    // a vertex's row; cap centres have their end's row
  std::vector<std::uint32_t> row_muscles;    // a row's muscle

  MuscleAsset() = default;
  MuscleAsset(const MuscleAsset&) = delete;  // circles point into it
  MuscleAsset& operator=(const MuscleAsset&) = delete;

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

// The rest place of a section's centre a_k (m).
glm::vec3 rest_point(const MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section);

// The muscle's 3 |C| (t_LON - 1) tetrahedra (1.6), matching across shared faces and with the drawn surface's
// diagonals. Node numbers: vertex i of section k is k |C| + i; centre a_k is t_LON |C| + k.
std::vector<std::array<std::uint32_t, 4>> tetrahedra_of(const MuscleAsset& asset, std::uint32_t muscle);

std::size_t heap_bytes(const MuscleAsset& asset);

}  // namespace fascicle::muscle
