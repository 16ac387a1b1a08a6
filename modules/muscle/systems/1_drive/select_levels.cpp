#include "modules/muscle/systems/1_drive/select_levels.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

#include "engine/ecs/each_in_parallel.hpp"
#include "modules/muscle/asset/muscle_levels.hpp"
#include "modules/muscle/components/lay_out_state.hpp"
#include "modules/muscle/systems/kernel_jobs.hpp"

namespace fascicle::muscle {
namespace {

// Where the muscles' middle is now.
glm::vec3 anchor_place(const PointBinding& anchor, const BoneMatrices& bones) {
  const auto share = [&](std::uint32_t bone, const float* p) {
    return glm::vec3(bones.world[bone] * glm::vec4(p[0], p[1], p[2], p[3]));
  };
  return share(anchor.first_bone, anchor.first) + share(anchor.second_bone, anchor.second);
}

LevelChoice choose_level(const MuscleLevels& levels, const BoneMatrices& bones, const Viewer& viewer) {
  if (!viewer.enabled) return {};
  const std::uint32_t coarsest = static_cast<std::uint32_t>(levels.assets.size()) - 1;
  if (viewer.level) return {std::min(*viewer.level, coarsest), 0.0f};
  const float distance = glm::distance(viewer.eye, anchor_place(levels.anchor, bones)) - levels.radius;
  return choose_level(levels, std::max(distance, 0.0f) / viewer.pixels_per_radian, viewer.tolerance);
}

void mix(std::span<const float> from, std::span<const float> to, float s, std::span<float> result) {
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = from[i] + s * (to[i] - from[i]);
}

void mix(std::span<const EndFrame> from, std::span<const EndFrame> to, float s, std::span<EndFrame> result) {
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i].bone = from[i].bone;
    result[i].fixed = from[i].fixed;
    mix(from[i].tangent, to[i].tangent, s, result[i].tangent);
    mix(from[i].reference, to[i].reference, s, result[i].reference);
  }
}

// Exchanges the asset. What follows from the bones is laid out at rest and made by the frame's other systems.
void switch_level(std::uint32_t level, MuscleDetail& detail, Musculature& musculature, ActionLines& lines,
                  CrossSections& sections, MuscleSurfaces& surfaces) {
  const std::vector<MuscleLayout>& before = musculature.asset->muscles;
  for (std::size_t m = 0; m < before.size(); ++m) detail.twist[m] = sections.twist[before[m].lane_index];
  const MuscleAsset& asset = *detail.levels->assets[level];
  lay_out(asset, lines);
  lay_out(asset, sections);
  lay_out(asset, surfaces);
  for (std::size_t m = 0; m < asset.size(); ++m) sections.twist[asset.muscles[m].lane_index] = detail.twist[m];
  musculature.asset = detail.levels->assets[level];
  musculature.coarser = level < detail.levels->morphs.size() ? &detail.levels->morphs[level] : nullptr;
  musculature.morph = 0.0f;
  detail.level = detail.next = level;
  ++detail.switches;
}

// What a step is to bring a musculature to that `wanted` is meant for.
LevelChoice next_choice(LevelChoice wanted, MuscleDetail& detail) {
  const bool coarser = wanted.level == detail.level + 1, finer = wanted.level + 1 == detail.level;
  if ((coarser || finer) && detail.next != wanted.level) {
    detail.next = wanted.level;
    return {detail.level, coarser ? 1.0f : 0.0f};
  }
  detail.next = wanted.level;
  return wanted;
}

}  // namespace

LevelChoice choose_level(const MuscleLevels& levels, float metres_per_pixel, float tolerance) {
  std::uint32_t level = 0;
  for (const LevelMorph& morph : levels.morphs) {
    const float begin = morph.complete / kMorphBand;
    const float way = (metres_per_pixel * tolerance - begin) / (morph.complete - begin);
    if (!(way > 0.0f)) return {level, 0.0f};
    if (way < 1.0f) return {level, way};
    ++level;
  }
  return {level, 0.0f};
}

void set_level(LevelChoice choice, MuscleDetail& detail, Musculature& musculature, ActionLines& lines,
               CrossSections& sections, MuscleSurfaces& surfaces) {
  if (choice.level != detail.level) switch_level(choice.level, detail, musculature, lines, sections, surfaces);
  if (choice.morph == musculature.morph) return;
  const MuscleAsset& asset = *musculature.asset;
  const LevelMorph& target = *musculature.coarser;
  mix(asset.rest_radii, target.radii, choice.morph, sections.radii);
  mix(asset.ends, target.ends, choice.morph, sections.ends);
  musculature.morph = choice.morph;
}

void select_levels(ecs::View<MuscleDetail, Musculature, ActionLines, CrossSections, MuscleSurfaces> musculatures,
                   ecs::View<const BoneMatrices> characters, ecs::Resource<const Viewer> viewer,
                   ecs::Resource<const MuscleSettings> settings, ecs::Resource<const CostLedger> ledger) {
  const MtuKernels& kernels = mtu_kernels(settings->simd);
  const SystemCosts costs = ledger->system("select_levels");
  const auto select = [&](ecs::Entity entity, MuscleDetail& detail, Musculature& musculature, ActionLines& lines,
                          CrossSections& sections, MuscleSurfaces& surfaces) {
    const ScopedCost cost(costs.row(entity), ScopedCost::kWhole);
    const BoneMatrices* bones = characters.try_get<const BoneMatrices>(musculature.character);
    if (!has_bones(*musculature.asset, bones)) return;
    const LevelChoice choice = choose_level(*detail.levels, *bones, *viewer);
    if (choice.level == detail.level && detail.next == detail.level && choice.morph == musculature.morph) return;
    if (!kernels.check_bones(&bones->world[0][0][0], musculature.asset->bone_count)) return;
    set_level(next_choice(choice, detail), detail, musculature, lines, sections, surfaces);
  };
  ecs::each_in_parallel(musculatures, kMusculaturesPerChunk, select);
}

}  // namespace fascicle::muscle
