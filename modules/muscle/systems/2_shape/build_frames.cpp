#include "modules/muscle/systems/2_shape/build_frames.hpp"

#include "engine/ecs/each_in_parallel.hpp"
#include "modules/muscle/systems/kernel_jobs.hpp"

namespace fascicle::muscle {

void build_frames(ecs::View<const Musculature, const ActionLines, CrossSections> musculatures,
                  ecs::View<const BoneMatrices> characters, ecs::Resource<const MuscleSettings> settings,
                  ecs::Resource<const CostLedger> ledger) {
  const MtuKernels& kernels = mtu_kernels(settings->simd);
  const SystemCosts costs = ledger->system("build_frames");
  const auto build = [&](ecs::Entity entity, const Musculature& musculature, const ActionLines& lines,
                         CrossSections& sections) {
    const ScopedCost cost(costs.row(entity), ScopedCost::kWhole);
    const BoneMatrices* bones = characters.try_get<const BoneMatrices>(musculature.character);
    if (!has_bones(*musculature.asset, bones)) return;
    const bool jumped = sections.fresh || sections.teleport_count != bones->teleport_count;
    kernels.build_frames(build_frames_job(musculature, *bones, lines, jumped, sections));
    if (jumped && lines.any_held) {
      // A muscle that was held over the jump starts its twist afresh once it is free again.
      for (std::size_t lane = 0; lane < sections.twist.size(); ++lane) {
        if (lines.held_lanes[lane] != 0) sections.twist[lane] = 0.0f;
      }
    }
    sections.teleport_count = bones->teleport_count;
    sections.fresh = false;
  };
  ecs::each_in_parallel(musculatures, kMusculaturesPerChunk, build);
}

}  // namespace fascicle::muscle
