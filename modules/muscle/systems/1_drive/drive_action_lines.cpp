#include "modules/muscle/systems/1_drive/drive_action_lines.hpp"

#include <algorithm>

#include "engine/ecs/each_in_parallel.hpp"
#include "modules/muscle/systems/kernel_jobs.hpp"

namespace fascicle::muscle {
namespace {

// Marks the muscles that cannot follow their bones now.
void hold_muscles(const MuscleAsset& asset, const BoneMatrices* bones, const MtuKernels& kernels, ActionLines& lines) {
  const bool usable = has_bones(asset, bones);
  lines.any_held = !usable || !kernels.check_bones(&bones->world[0][0][0], asset.bone_count);
  if (!lines.any_held) return;
  std::fill(lines.held.begin(), lines.held.end(), usable ? 0 : 1);
  if (usable) {
    const auto is_good = [&](std::uint32_t bone) { return kernels.check_bones(&bones->world[bone][0][0], 1); };
    for (const PointBinding& point : asset.points) {
      if (!is_good(point.first_bone) || !is_good(point.second_bone)) lines.held[point.muscle] = 1;
    }
  }
  // Empty lanes are held too: they follow bone 0, whatever it is.
  std::fill(lines.held_lanes.begin(), lines.held_lanes.end(), -1);
  for (std::size_t m = 0; m < asset.size(); ++m) {
    if (lines.held[m] == 0) lines.held_lanes[asset.layouts[m].lane_index] = 0;
    else ++lines.held_steps;
  }
}

}  // namespace

void drive_action_lines(ecs::View<const Musculature, ActionLines> musculatures,
                        ecs::View<const BoneMatrices> characters, ecs::Resource<const MuscleSettings> settings,
                        ecs::Resource<const CostLedger> ledger) {
  const MtuKernels& kernels = mtu_kernels(settings->simd);
  const SystemCosts costs = ledger->system("drive_action_lines");
  const auto drive = [&](ecs::Entity entity, const Musculature& musculature, ActionLines& lines) {
    const ScopedCost cost(costs.row(entity), ScopedCost::kWhole);
    const MuscleAsset& asset = *musculature.asset;
    const BoneMatrices* bones = characters.try_get<const BoneMatrices>(musculature.character);
    hold_muscles(asset, bones, kernels, lines);
    if (has_bones(asset, bones)) kernels.place_points(place_points_job(musculature, *bones, lines));
  };
  ecs::each_in_parallel(musculatures, kMusculaturesPerChunk, drive);
}

}  // namespace fascicle::muscle
