// The components' small functions: access by muscle, and memory for statistics.
#include <algorithm>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/components/muscle_detail.hpp"
#include "modules/muscle/components/muscle_measures.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/components/tendons.hpp"

namespace fascicle::muscle {
namespace {

template <class... Arrays>
std::size_t bytes_of(const Arrays&... arrays) {
  return (std::size_t{0} + ... + (arrays.capacity() * sizeof(arrays[0])));
}

}  // namespace

std::size_t heap_bytes(const Musculature& musculature) {
  return bytes_of(musculature.muscles, musculature.attached);
}

std::size_t heap_bytes(const ActionLines& lines) {
  return bytes_of(lines.x, lines.y, lines.z, lines.held, lines.held_lanes);
}

std::size_t heap_bytes(const CrossSections& sections) {
  return bytes_of(sections.ux, sections.uy, sections.uz, sections.vx, sections.vy, sections.vz, sections.arc,
                  sections.radii, sections.twist, sections.ends);
}

std::size_t heap_bytes(const MuscleCollision& c) {
  return bytes_of(c.levels, c.offset_x, c.offset_y, c.offset_z, c.radii, c.rest_radii, c.pose, c.carried[0], c.carried[1],
                  c.carried[2], c.carried[3], c.target_area, c.area, c.depth, c.cost);
}

std::size_t heap_bytes(const MuscleContacts& contacts) {
  return bytes_of(contacts.now, contacts.began, contacts.ended, contacts.gone);
}

std::size_t heap_bytes(const MuscleDetail& detail) { return bytes_of(detail.twist); }

std::size_t heap_bytes(const Tendons& tendons) {
  std::size_t sum = 0;
  for (std::size_t end = 0; end < 2; ++end) {
    sum += bytes_of(tendons.segment[end], tendons.fraction[end], tendons.arc[end]);
  }
  return sum;
}

std::size_t heap_bytes(const MuscleSurfaces& surfaces) { return bytes_of(surfaces.vertices, surfaces.rows); }

std::size_t heap_bytes(const MuscleMeasures& measures) {
  return bytes_of(measures.length, measures.drawn_length, measures.volume, measures.mass, measures.pcsa, measures.force,
                  measures.tendon_point);
}

glm::vec3 line_point(const MuscleAsset& asset, const ActionLines& lines, std::uint32_t muscle, std::uint32_t section) {
  const std::uint32_t slot = asset.slot(muscle, section);
  return {lines.x[slot], lines.y[slot], lines.z[slot]};
}

LinePlace tendon_border(const MuscleAsset& asset, const Tendons& tendons, std::uint32_t muscle, MuscleEnd end) {
  const std::uint32_t lane = asset.muscles[muscle].lane_index;
  const std::size_t e = static_cast<std::size_t>(end);
  return {tendons.segment[e][lane], tendons.fraction[e][lane], tendons.arc[e][lane]};
}

glm::vec3 unpack_surface_normal(std::uint32_t packed) {
  const auto component = [&](int shift) {
    const std::int32_t bits = static_cast<std::int32_t>(packed << (22 - shift)) >> 22;
    return std::max(static_cast<float>(bits) / 511.0f, -1.0f);
  };
  return {component(0), component(10), component(20)};
}

MuscleSurfaceView surface_of(const MuscleAsset& asset, const MuscleSurfaces& surfaces, std::uint32_t muscle) {
  const MuscleLayout& layout = asset.muscles[muscle];
  MuscleSurfaceView view;
  view.vertices = std::span(surfaces.vertices).subspan(layout.first_vertex, layout.vertex_count);
  view.rows = std::span(surfaces.rows).subspan(layout.first_row, layout.row_count);
  view.strips = std::span(asset.strip_indices).subspan(layout.first_strip_index, layout.strip_index_count);
  view.fans = std::span(asset.fan_indices).subspan(layout.first_fan_index, layout.fan_index_count);
  view.first_vertex = layout.first_vertex;
  view.section_vertices = layout.section_vertices;
  return view;
}

}  // namespace fascicle::muscle
