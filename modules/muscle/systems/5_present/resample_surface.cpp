#include "modules/muscle/systems/5_present/resample_surface.hpp"

#include <array>
#include <cassert>
#include <cmath>

#include <glm/geometric.hpp>

#include "modules/muscle/asset/muscle_levels.hpp"

namespace fascicle::muscle {
namespace {

// A row or a column of one level as two of the other's, between which it lies; the same twice where it is one of them.
struct Pair {
  std::uint32_t first = 0, second = 0;
};

// Which section the tendon's border lies behind; beyond all where no border is drawn.
struct Borders {
  std::uint32_t behind[2];

  std::uint32_t row_of_section(std::uint32_t k) const { return k + (behind[0] < k ? 1 : 0) + (behind[1] < k ? 1 : 0); }
  std::uint32_t row_of_border(std::size_t end) const {
    const std::uint32_t other = behind[1 - end];
    const bool other_first = other < behind[end] || (end == 1 && other == behind[end]);
    return behind[end] + 1 + (other_first ? 1 : 0);
  }
};
constexpr std::uint32_t kNoBorder = 0xffffffffu;

// Normals of length 511 to 10:10:10 bits; those that cancel each other out point nowhere.
std::uint32_t pack_surface_normal(const glm::vec3& sum) {
  const float length = glm::length(sum);
  const glm::vec3 normal = length > 0.0f ? (511.0f / length) * sum : glm::vec3(0.0f);
  const auto bits = [](float x) { return static_cast<std::uint32_t>(std::lround(x)) & 0x3ffu; };
  return bits(normal.x) | bits(normal.y) << 10 | bits(normal.z) << 20;
}

SurfaceVertex middle(const std::array<SurfaceVertex, 4>& corners) {
  glm::vec3 place(0.0f), normal(0.0f);
  for (const SurfaceVertex& corner : corners) {
    place += 0.25f * corner.position;
    normal += unpack_surface_normal(corner.normal);
  }
  return {place, pack_surface_normal(normal)};
}

// One muscle's rows from one level to another.
class Resampler {
 public:
  Resampler(const MuscleLevels& levels, std::uint32_t from, const Tendons& tendons, const MuscleSurfaces& surfaces,
            std::uint32_t to, std::uint32_t muscle)
      : from_(levels.assets[from]->muscles[muscle]), to_(levels.assets[to]->muscles[muscle]), refines_(to < from),
        shift_(levels.morphs[refines_ ? to : from].shifts[muscle]),
        vertices_(surfaces.vertices.data() + from_.first_vertex), rows_(surfaces.rows.data() + from_.first_row) {
    const bool halved = from_.subdivision != to_.subdivision;
    for (std::size_t end = 0; end < 2; ++end) {
      from_borders_.behind[end] = to_borders_.behind[end] = kNoBorder;
      if (!from_.tendon_drawn[end]) continue;
      const std::uint32_t segment = static_cast<std::uint32_t>(tendons.segment[end][from_.lane_index]);
      const bool late = tendons.fraction[end][from_.lane_index] >= 0.5f;
      from_borders_.behind[end] = segment;
      to_borders_.behind[end] = !halved ? segment : refines_ ? 2 * segment + (late ? 1 : 0) : segment / 2;
    }
    section_step_ = halved ? 2 : 1;
    vertex_step_ = refines_ ? to_.section_vertices / from_.section_vertices
                            : from_.section_vertices / to_.section_vertices;
  }

  void write(SurfaceVertex* vertices, SurfaceRow* rows) const {
    for (std::uint32_t k = 0; k < to_.section_count; ++k) {
      const Pair sections = place(k, section_step_);
      write_row({from_borders_.row_of_section(sections.first), from_borders_.row_of_section(sections.second)}, vertices,
                rows);
      for (std::size_t end = 0; end < 2; ++end) {
        if (to_borders_.behind[end] != k) continue;
        const std::uint32_t border = from_borders_.row_of_border(end);
        write_row({border, border}, vertices, rows);
      }
    }
    const SurfaceVertex* centres = vertices_ + std::size_t{from_.row_count} * from_.section_vertices;
    *vertices++ = centres[0];
    *vertices++ = centres[1];
  }

 private:
  // Of the target's index i, where the finer level has `step` times as many.
  Pair place(std::uint32_t i, std::uint32_t step) const {
    if (!refines_) return {i * step, i * step};
    return {i / step, (i + step - 1) / step};
  }

  Pair columns(std::uint32_t i) const {
    if (refines_) {
      const std::uint32_t count = to_.section_vertices;
      const Pair pair = place((i + shift_) % count, vertex_step_);
      return {pair.first, pair.second % from_.section_vertices};
    }
    const std::uint32_t count = from_.section_vertices;
    const std::uint32_t column = (i * vertex_step_ + count - shift_) % count;
    return {column, column};
  }

  void write_row(Pair from, SurfaceVertex*& vertices, SurfaceRow*& rows) const {
    const SurfaceVertex* first = vertices_ + std::size_t{from.first} * from_.section_vertices;
    const SurfaceVertex* second = vertices_ + std::size_t{from.second} * from_.section_vertices;
    for (std::uint32_t i = 0; i < to_.section_vertices; ++i) {
      const Pair column = columns(i);
      *vertices++ = column.first == column.second && from.first == from.second
                        ? first[column.first]
                        : middle({first[column.first], first[column.second], second[column.first],
                                  second[column.second]});
    }
    const float coordinate = 0.5f * (rows_[from.first].tendon_coordinate + rows_[from.second].tendon_coordinate);
    *rows++ = {coordinate, rows_[from.first].muscle};
  }

  const MuscleLayout& from_;
  const MuscleLayout& to_;
  bool refines_;
  std::uint32_t shift_;
  const SurfaceVertex* vertices_;
  const SurfaceRow* rows_;
  Borders from_borders_, to_borders_;
  std::uint32_t section_step_ = 1, vertex_step_ = 1;
};

}  // namespace

void resample_surface(const MuscleLevels& levels, std::uint32_t from, const Tendons& tendons,
                      const MuscleSurfaces& surfaces, std::uint32_t to, std::span<SurfaceVertex> vertices,
                      std::span<SurfaceRow> rows) {
  const MuscleAsset& asset = *levels.assets[to];
  assert((from + 1 == to || to + 1 == from) && vertices.size() == asset.vertex_count && rows.size() == asset.row_count);
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    const Resampler resampler(levels, from, tendons, surfaces, to, m);
    resampler.write(vertices.data() + asset.muscles[m].first_vertex, rows.data() + asset.muscles[m].first_row);
  }
}

}  // namespace fascicle::muscle
