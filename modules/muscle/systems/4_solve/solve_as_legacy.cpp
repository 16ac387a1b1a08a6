#include "modules/muscle/systems/4_solve/solve_as_legacy.hpp"

#include <algorithm>

#include "engine/ecs/each_in_parallel.hpp"
#include "modules/muscle/kernels/inflate_section.hpp"
#include "modules/muscle/systems/4_solve/carry_deformation.hpp"
#include "modules/muscle/systems/kernel_jobs.hpp"

namespace fascicle::muscle {
namespace {

void show(const CollisionAsset& asset, MuscleCollision& collision, CrossSections& sections) {
  std::copy(collision.radii.begin(), collision.radii.end(), sections.radii.begin());
  for (std::size_t s = 0; s < asset.sections.size(); ++s) {
    const CollisionSection& section = asset.sections[s];
    collision.area[s] = section_area(std::span(collision.radii).subspan(section.first_radius, section.count));
    collision.target_area[s] = section.rest_area;
  }
}

}  // namespace

std::vector<std::shared_ptr<const TriangleTree>> make_legacy_bones(std::span<const LegacyBoneMesh> meshes,
                                                                   std::size_t bone_count) {
  std::vector<std::shared_ptr<const TriangleTree>> bones(bone_count);
  for (std::size_t bone = 0; bone < bone_count; ++bone) {
    TriangleMesh all;
    for (const LegacyBoneMesh& part : meshes) {
      if (part.mesh == nullptr || part.bone != static_cast<std::int32_t>(bone)) continue;
      const auto first = static_cast<std::uint32_t>(all.positions.size());
      for (const glm::vec3& p : part.mesh->positions) all.positions.emplace_back(part.to_bone * glm::vec4(p, 1.0f));
      for (const std::uint32_t index : part.mesh->indices) all.indices.push_back(first + index);
    }
    if (!all.indices.empty()) bones[bone] = std::make_shared<const TriangleTree>(build_triangle_tree(all));
  }
  return bones;
}

void add_legacy_collision(ecs::World& world, ecs::Entity musculature,
                          std::vector<std::shared_ptr<const TriangleTree>> bones, bool only_marked) {
  const MuscleCollision* collision = world.try_get<MuscleCollision>(musculature);
  if (collision == nullptr) return;
  LegacyCollision legacy;
  for (const auto& level : collision->levels) legacy.plans.push_back(make_legacy_plan(*level, bones, only_marked));
  if (LegacyCollision* present = world.try_get<LegacyCollision>(musculature)) *present = std::move(legacy);
  else world.add(musculature, std::move(legacy));
}

void solve_as_legacy(ecs::View<const Musculature, LegacyCollision, MuscleCollision, ActionLines, CrossSections>
                         musculatures,
                     ecs::View<const BoneMatrices> characters, ecs::Resource<const CostLedger> ledger) {
  const SystemCosts costs = ledger->system("solve_as_legacy");
  const auto solve = [&](ecs::Entity entity, const Musculature& musculature, LegacyCollision& legacy,
                         MuscleCollision& collision, ActionLines& lines, CrossSections& sections) {
    const ScopedCost cost(costs.row(entity), ScopedCost::kWhole);
    const BoneMatrices* bones = characters.try_get<const BoneMatrices>(musculature.character);
    const bool wanted = collision.settings.enabled && collision.settings.mode == CollisionMode::kLegacy;
    if (!wanted || !has_bones(*musculature.asset, bones)) return;
    carry_deformation(musculature, collision);
    if (collision.asset == nullptr || bones->world.size() < collision.asset->bone_count) return;
    displace_lines(collision, bones->world, lines);
    const auto level = std::find_if(collision.levels.begin(), collision.levels.end(),
                                    [&](const auto& asset) { return asset.get() == collision.asset; });
    const auto index = static_cast<std::size_t>(level - collision.levels.begin());
    if (index < legacy.plans.size() && legacy.steps++ % kLegacyInterval == 0) {
      legacy.last = respond_as_legacy(**level, legacy.plans[index], bones->world, sections, lines, collision);
      collision.fallbacks += legacy.last.clamped;
    }
    show(*collision.asset, collision, sections);
  };
  ecs::each_in_parallel(musculatures, 1, solve);
}

std::size_t heap_bytes(const LegacyCollision& collision) {
  std::size_t bytes = collision.plans.capacity() * sizeof(LegacyPlan);
  for (const LegacyPlan& plan : collision.plans) bytes += heap_bytes(plan);
  return bytes;
}

}  // namespace fascicle::muscle
