#include "modules/muscle/systems/5_present/measure_muscles.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/ecs/each_in_parallel.hpp"
#include "modules/muscle/systems/kernel_jobs.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kSmallestVolume = 1.0e-12f;  // m^3

// Along the attachments alone.
float measure_length(const MuscleLayout& layout, const ActionLines& lines) {
  const auto place = [&](std::uint32_t i) {
    const std::uint32_t slot = layout.first_attachment_slot + layout.attachment_slot_step * i;
    return glm::vec3(lines.x[slot], lines.y[slot], lines.z[slot]);
  };
  float length = 0.0f;
  glm::vec3 before = place(0);
  for (std::uint32_t i = 1; i < layout.attachment_count; ++i) {
    const glm::vec3 here = place(i);
    length += glm::distance(before, here);
    before = here;
  }
  return length;
}

// Everything but the volume, and what follows from it.
void measure_line(const MuscleAsset& asset, const ActionLines& lines, const CrossSections& sections,
                  const Tendons& tendons, std::uint32_t muscle, MuscleMeasures& measures) {
  const MuscleLayout& layout = asset.muscles[muscle];
  measures.length[muscle] = measure_length(layout, lines);
  measures.drawn_length[muscle] = sections.arc[asset.slot(muscle, layout.section_count - 1)];
  const LinePlace border = tendon_border(asset, tendons, muscle, MuscleEnd::kInsertion);
  const std::uint32_t segment = static_cast<std::uint32_t>(border.segment);
  measures.tendon_point[muscle] = glm::mix(line_point(asset, lines, muscle, segment),
                                           line_point(asset, lines, muscle, segment + 1), border.fraction);
}

void measure_strength(const MuscleLayout& layout, std::uint32_t muscle, MuscleMeasures& measures) {
  const float volume = measures.volume[muscle];
  const float fibre_length = layout.hill.optimal_fibre_length;
  measures.mass[muscle] = volume * kMuscleDensity;
  measures.pcsa[muscle] = fibre_length > 0.0f ? volume * std::cos(layout.hill.pennation) / fibre_length : 0.0f;
  measures.force[muscle] = measures.pcsa[muscle] * layout.specific_tension;
}

void clear(std::uint32_t muscle, MuscleMeasures& measures) {
  measures.length[muscle] = measures.drawn_length[muscle] = measures.volume[muscle] = 0.0f;
  measures.mass[muscle] = measures.pcsa[muscle] = measures.force[muscle] = 0.0f;
  measures.tendon_point[muscle] = glm::vec3(0.0f);
}

// The finest level's volume at rest by the present one's. On its way between two, radii are: the volume's root.
float volume_scale(const MuscleDetail& detail, float morph, std::uint32_t muscle) {
  const std::vector<std::shared_ptr<const MuscleAsset>>& assets = detail.levels->assets;
  const auto volume = [&](std::uint32_t level) { return assets[level]->muscles[muscle].rest_volume; };
  if (detail.level == 0 && morph == 0.0f) return 1.0f;
  float here = volume(detail.level);
  if (morph > 0.0f) {
    const float next = volume(detail.level + 1);
    const float root = glm::mix(std::sqrt(std::max(here, 0.0f)), std::sqrt(std::max(next, 0.0f)), morph);
    here = root * root;
  }
  return here > kSmallestVolume ? volume(0) / here : 1.0f;
}

}  // namespace

void measure_muscle(const Musculature& musculature, const ActionLines& lines, const CrossSections& sections,
                    const Tendons& tendons, const MtuKernels& kernels, std::uint32_t muscle, MuscleMeasures& measures,
                    float volume_scale) {
  if (musculature.attached[muscle] == 0) {
    clear(muscle, measures);
    return;
  }
  MeasureVolumeJob job;
  job.sections = single_muscle(sections_view(musculature, lines, sections, tendons), muscle);
  job.volumes = measures.volume.data() + muscle;
  kernels.measure_volume(job);
  measures.volume[muscle] *= volume_scale;
  measure_line(*musculature.asset, lines, sections, tendons, muscle, measures);
  measure_strength(musculature.asset->muscles[muscle], muscle, measures);
}

void measure_muscles(
    ecs::View<const Musculature, const ActionLines, const CrossSections, const Tendons, MuscleMeasures> musculatures,
    ecs::View<const MuscleDetail> details, ecs::Resource<const MuscleSettings> settings,
    ecs::Resource<const CostLedger> ledger) {
  const MtuKernels& kernels = mtu_kernels(settings->simd);
  const SystemCosts costs = ledger->system("measure_muscles");
  const auto measure = [&](ecs::Entity entity, const Musculature& musculature, const ActionLines& lines,
                           const CrossSections& sections, const Tendons& tendons, MuscleMeasures& measures) {
    const CostRow row = costs.row(entity);
    const MuscleDetail* detail = details.try_get<const MuscleDetail>(entity);
    for (std::uint32_t muscle = 0; muscle < musculature.asset->size(); ++muscle) {
      const ScopedCost cost(row, muscle);
      const float scale = detail == nullptr ? 1.0f : volume_scale(*detail, musculature.morph, muscle);
      measure_muscle(musculature, lines, sections, tendons, kernels, muscle, measures, scale);
    }
  };
  ecs::each_in_parallel(musculatures, kMusculaturesPerChunk, measure);
}

}  // namespace fascicle::muscle
