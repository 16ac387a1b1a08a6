#include "modules/muscle/systems/5_present/draw_muscles.hpp"

#include <cstring>
#include <span>

#include "engine/ecs/each_in_parallel.hpp"
#include "engine/render/renderer.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/systems/5_present/resample_surface.hpp"

namespace fascicle::muscle {
namespace {

static_assert(sizeof(SurfaceVertex) == sizeof(DrawVertex));
static_assert(offsetof(SurfaceVertex, normal) == offsetof(DrawVertex, normal));
static_assert(sizeof(SurfaceRow) == sizeof(StripRow) && offsetof(SurfaceRow, muscle) == offsetof(StripRow, item));
static_assert(kRestartIndex == kPrimitiveRestart);

// Section points on attachments are brighter than those between.
const std::uint32_t kAttachmentColour = pack_colour({1.0f, 0.93f, 0.35f, 1.0f});
const std::uint32_t kSubdivisionColour = pack_colour({0.30f, 0.78f, 1.0f, 1.0f});

// A musculature is about 40 kB to copy; several make a chunk worth handing over.
constexpr std::size_t kMusculaturesPerChunk = 4;

void write_action_lines(const Musculature& musculature, const ActionLines& lines, std::span<LineVertex> vertices) {
  const MuscleAsset& asset = *musculature.asset;
  std::size_t next = 0;
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    const MuscleLayout& layout = asset.muscles[m];
    const std::uint32_t attached = musculature.attached[m];
    for (std::uint32_t k = 0; k < layout.section_count; ++k) {
      const std::uint32_t slot = asset.slot(m, k);
      const bool attachment = k % (1u << layout.subdivision) == 0;
      const std::uint32_t colour = attached ? (attachment ? kAttachmentColour : kSubdivisionColour) : 0u;
      vertices[next++] = {{lines.x[slot], lines.y[slot], lines.z[slot]}, colour};
    }
  }
}

// Lets the renderer draw the level that is computed, and no other.
void show_level(const MuscleDetail& detail, Renderer& renderer, DrawnMuscles& drawn) {
  if (detail.level == drawn.level && detail.next == drawn.next) return;
  drawn.level = detail.level;
  drawn.next = detail.next;
  for (std::uint32_t i = 0; i < drawn.levels.size(); ++i) {
    const DrawnMuscles::Level& level = drawn.levels[i];
    renderer.set_visible(level.strips, i == drawn.level);
    if (i != drawn.level && i != drawn.next) renderer.forget(level.strips);
    if (i != drawn.level && level.lines) renderer.forget(level.lines);
  }
}

// The renderer's vertices and rows are laid out like the module's own (see above).
template <class To, class From>
std::span<To> same_layout(std::span<From> from) {
  return {reinterpret_cast<To*>(from.data()), from.size()};
}

}  // namespace

StripTopology make_strip_topology(const MuscleAsset& asset) {
  StripTopology topology;
  for (const MuscleLayout& layout : asset.muscles) {
    append_tube_vertices(layout.row_count, layout.section_vertices, topology);
  }
  topology.strip_indices = asset.strip_indices;
  topology.fan_indices = asset.fan_indices;
  return topology;
}

std::uint32_t action_line_vertex_count(const MuscleAsset& asset) {
  std::uint32_t count = 0;
  for (const MuscleLayout& layout : asset.muscles) count += layout.section_count;
  return count;
}

std::vector<std::uint32_t> make_action_line_indices(const MuscleAsset& asset) {
  std::vector<std::uint32_t> indices;
  std::uint32_t next = 0;
  for (const MuscleLayout& layout : asset.muscles) {
    for (std::uint32_t k = 0; k < layout.section_count; ++k) indices.push_back(next++);
    indices.push_back(kPrimitiveRestart);
  }
  return indices;
}

std::size_t heap_bytes(const DrawnMuscles& drawn) { return drawn.levels.capacity() * sizeof(DrawnMuscles::Level); }

void upload_muscles(
    ecs::View<const Musculature, const MuscleSurfaces, const ActionLines, const Tendons, DrawnMuscles> musculatures,
    ecs::View<const MuscleDetail> details, ecs::View<const BoneMatrices> characters,
    ecs::Resource<const DrawTarget> target) {
  Renderer& renderer = *target->renderer;
  const auto upload = [&](ecs::Entity entity, const Musculature& musculature, const MuscleSurfaces& surfaces,
                          const ActionLines& lines, const Tendons& tendons, DrawnMuscles& drawn) {
    const MuscleDetail* detail = details.try_get<const MuscleDetail>(entity);
    if (detail != nullptr) show_level(*detail, renderer, drawn);
    const DrawnMuscles::Level& level = drawn.levels[drawn.level];
    const std::span<DrawVertex> vertices = renderer.strip_vertices(level.strips);
    std::memcpy(static_cast<void*>(vertices.data()), surfaces.vertices.data(), vertices.size_bytes());
    const std::span<StripRow> rows = renderer.strip_rows(level.strips);
    std::memcpy(static_cast<void*>(rows.data()), surfaces.rows.data(), rows.size_bytes());
    if (level.lines) write_action_lines(musculature, lines, renderer.line_vertices(level.lines));
    if (drawn.next != drawn.level) {
      const DrawnMuscles::Level& next = drawn.levels[drawn.next];
      resample_surface(*detail->levels, drawn.level, tendons, surfaces, drawn.next,
                       same_layout<SurfaceVertex>(renderer.strip_vertices(next.strips)),
                       same_layout<SurfaceRow>(renderer.strip_rows(next.strips)));
    }

    const BoneMatrices* bones = characters.try_get<const BoneMatrices>(musculature.character);
    if (bones != nullptr && bones->teleport_count != drawn.teleport_count) {
      drawn.teleport_count = bones->teleport_count;
      renderer.mark_teleported(level.strips);
      if (level.lines) renderer.mark_teleported(level.lines);
    }
  };
  ecs::each_in_parallel(musculatures, kMusculaturesPerChunk, upload);
}

}  // namespace fascicle::muscle
