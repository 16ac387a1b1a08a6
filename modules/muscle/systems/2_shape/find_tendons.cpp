#include "modules/muscle/systems/2_shape/find_tendons.hpp"

#include "engine/ecs/each_in_parallel.hpp"
#include "modules/muscle/systems/kernel_jobs.hpp"

namespace fascicle::muscle {

void find_tendons(ecs::View<const Musculature, const CrossSections, Tendons> musculatures,
                  ecs::Resource<const MuscleSettings> settings, ecs::Resource<const CostLedger> ledger) {
  const MtuKernels& kernels = mtu_kernels(settings->simd);
  const SystemCosts costs = ledger->system("find_tendons");
  const auto find = [&](ecs::Entity entity, const Musculature& musculature, const CrossSections& sections,
                        Tendons& tendons) {
    const ScopedCost cost(costs.row(entity), ScopedCost::kWhole);
    kernels.find_tendons(find_tendons_job(*musculature.asset, sections, tendons));
  };
  ecs::each_in_parallel(musculatures, kMusculaturesPerChunk, find);
}

}  // namespace fascicle::muscle
