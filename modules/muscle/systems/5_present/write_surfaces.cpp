#include "modules/muscle/systems/5_present/write_surfaces.hpp"

#include <algorithm>

#include "engine/ecs/each_in_parallel.hpp"
#include "modules/muscle/systems/kernel_jobs.hpp"

namespace fascicle::muscle {

void write_rows(const MuscleAsset& asset, const CrossSections& sections, const Tendons& tendons,
                MuscleSurfaces& surfaces) {
  for (const SectionLayout& layout : asset.layouts) {
    const std::uint32_t lane = layout.lane_index;
    const float from = layout.tendon_drawn[0] ? tendons.arc[0][lane] : -1.0e3f;
    const float to = layout.tendon_drawn[1] ? tendons.arc[1][lane] : 1.0e3f;
    SurfaceRow* row = surfaces.rows.data() + layout.first_row;
    for (std::uint32_t k = 0; k < layout.section_count; ++k) {
      const float arc = sections.arc[layout.first_slot + std::size_t{kLanes} * k];
      row++->tendon_coordinate = std::min(std::min(arc - from, to - arc), kNoTendon);
      for (std::size_t end = 0; end < 2; ++end) {
        if (layout.tendon_drawn[end] && tendons.segment[end][lane] == static_cast<std::int32_t>(k)) {
          row++->tendon_coordinate = 0.0f;
        }
      }
    }
  }
}

void write_surfaces(
    ecs::View<const Musculature, const ActionLines, const CrossSections, const Tendons, MuscleSurfaces> musculatures,
    ecs::Resource<const MuscleSettings> settings, ecs::Resource<const CostLedger> ledger) {
  const MtuKernels& kernels = mtu_kernels(settings->simd);
  std::size_t bytes = 0;
  musculatures.each([&](const Musculature& musculature, const ActionLines&, const CrossSections&, const Tendons&,
                        MuscleSurfaces&) { bytes += sizeof(SurfaceVertex) * musculature.asset->vertex_count; });
  const bool stream = bytes > settings->stream_bytes;
  const SystemCosts costs = ledger->system("write_surfaces");
  const auto write = [&](ecs::Entity entity, const Musculature& musculature, const ActionLines& lines,
                         const CrossSections& sections, const Tendons& tendons, MuscleSurfaces& surfaces) {
    const SectionsView view = sections_view(musculature, lines, sections, tendons);
    if (const CostRow row = costs.row(entity)) {
      for (std::uint32_t muscle = 0; muscle < view.muscle_count; ++muscle) {
        const ScopedCost cost(row, muscle);
        kernels.write_surfaces(write_surfaces_job(single_muscle(view, muscle), stream, surfaces));
      }
    } else {
      kernels.write_surfaces(write_surfaces_job(view, stream, surfaces));
    }
    write_rows(*musculature.asset, sections, tendons, surfaces);
  };
  ecs::each_in_parallel(musculatures, kMusculaturesPerChunk, write);
}

}  // namespace fascicle::muscle
