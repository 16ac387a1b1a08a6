#include "modules/muscle/systems/5_present/pick_muscle.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <glm/geometric.hpp>

#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {
namespace {

struct SurfaceHit {
  float distance = std::numeric_limits<float>::infinity();  // m
  std::array<std::uint32_t, 3> corners{};                   // of the muscle's vertices
};

// Strips and fans are runs of indices between restarts.
template <class F>
void each_triangle(std::span<const std::uint32_t> indices, bool fan, F visit) {
  std::size_t start = 0;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] == kRestartIndex) {
      start = i + 1;
    } else if (i >= start + 2) {
      visit(indices[fan ? start : i - 2], indices[i - 1], indices[i]);
    }
  }
}

void hit_surface(const MuscleSurfaceView& surface, const Ray& ray, SurfaceHit& nearest) {
  const auto visit = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const std::array<std::uint32_t, 3> corners = {a - surface.first_vertex, b - surface.first_vertex,
                                                  c - surface.first_vertex};
    const auto place = [&](std::size_t i) -> const glm::vec3& { return surface.vertices[corners[i]].position; };
    const auto t = hit_triangle(ray, place(0), place(1), place(2));
    if (t && *t < nearest.distance) nearest = {*t, corners};
  };
  each_triangle(surface.strips, false, visit);
  each_triangle(surface.fans, true, visit);
}

// Drawn rows are the sections and, behind the section that it follows, each tendon's border.
std::uint32_t section_before(const MuscleLayout& layout, const Tendons& tendons, std::uint32_t row) {
  std::uint32_t next = 0;
  for (std::uint32_t k = 0; k < layout.section_count; ++k) {
    ++next;
    for (std::size_t end = 0; end < 2; ++end) {
      if (layout.tendon_drawn[end] && tendons.segment[end][layout.lane_index] == static_cast<std::int32_t>(k)) ++next;
    }
    if (row < next) return k;
  }
  return layout.section_count - 1;
}

std::uint32_t row_of_section(const MuscleLayout& layout, const Tendons& tendons, std::uint32_t section) {
  std::uint32_t row = section;
  for (std::size_t end = 0; end < 2; ++end) {
    if (layout.tendon_drawn[end] && tendons.segment[end][layout.lane_index] < static_cast<std::int32_t>(section)) {
      ++row;
    }
  }
  return row;
}

std::uint32_t section_after(const MuscleLayout& layout, const Tendons& tendons, std::uint32_t row) {
  const std::uint32_t before = section_before(layout, tendons, row);
  return row_of_section(layout, tendons, before) == row ? before : before + 1;
}

}  // namespace

std::optional<MusclePick> pick_muscle(const MuscleAsset& asset, const MuscleSurfaces& surfaces, const Tendons& tendons,
                                      std::span<const std::uint8_t> hidden, const Ray& ray) {
  SurfaceHit hit;
  MusclePick pick;
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    if (m < hidden.size() && hidden[m] != 0) continue;
    const float before = hit.distance;
    hit_surface(surface_of(asset, surfaces, m), ray, hit);
    if (hit.distance < before) pick.muscle = m;
  }
  if (!(hit.distance < std::numeric_limits<float>::infinity())) return std::nullopt;
  const MuscleLayout& layout = asset.muscles[pick.muscle];
  if (layout.section_count < 3) return std::nullopt;
  pick.distance = hit.distance;
  pick.place = ray.origin + hit.distance * ray.direction;

  // Of the sections about the triangle, the vertex nearest to the place among the triangle's own columns; a cap's
  // centre is in no column, and all of them count.
  const std::uint32_t count = layout.section_vertices, rows = layout.row_count;
  const MuscleSurfaceView surface = surface_of(asset, surfaces, pick.muscle);
  const bool on_cap = std::any_of(hit.corners.begin(), hit.corners.end(),
                                  [&](std::uint32_t corner) { return corner >= rows * count; });
  std::uint32_t first_row = rows, last_row = 0;
  for (const std::uint32_t corner : hit.corners) {
    const std::uint32_t row = corner < rows * count ? corner / count : corner - rows * count == 0 ? 0 : rows - 1;
    first_row = std::min(first_row, row);
    last_row = std::max(last_row, row);
  }
  const std::uint32_t last = layout.section_count - 2;
  const std::uint32_t from = std::clamp(section_before(layout, tendons, first_row), 1u, last);
  const std::uint32_t to = std::clamp(section_after(layout, tendons, last_row), from, last);
  float nearest = std::numeric_limits<float>::infinity();
  for (std::uint32_t k = from; k <= to; ++k) {
    const std::uint32_t row = row_of_section(layout, tendons, k);
    for (std::uint32_t i = 0; i < count; ++i) {
      const bool own = std::any_of(hit.corners.begin(), hit.corners.end(),
                                   [&](std::uint32_t corner) { return corner % count == i; });
      if (!on_cap && !own) continue;
      const float distance = glm::distance(surface.vertices[row * count + i].position, pick.place);
      if (distance >= nearest) continue;
      nearest = distance;
      pick.section = k;
      pick.vertex = i;
    }
  }
  return pick;
}

}  // namespace fascicle::muscle
