#include "game/penetration_report.hpp"

#include <algorithm>

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/measure/rest_surfaces.hpp"
#include "modules/muscle/measure/section_areas.hpp"
#include "modules/muscle/muscle.hpp"

namespace fascicle::game {

PenetrationReport::Level& PenetrationReport::level_of(const std::shared_ptr<const muscle::CharacterAsset>& character,
                                                      const std::shared_ptr<const muscle::MuscleAsset>& asset) {
  auto known = std::find_if(characters_.begin(), characters_.end(),
                            [&](const Character& c) { return c.asset == character; });
  if (known == characters_.end()) {
    characters_.push_back({character, muscle::make_bone_solids(character->bone_meshes)});
    known = std::prev(characters_.end());
  }
  for (Level& level : known->levels) {
    if (level.asset == asset) return level;
  }
  Level& level = known->levels.emplace_back(Level{asset, {asset, known->bones}, {}});
  const std::vector<glm::mat4>& bones = character->skeleton->rest_world;
  const muscle::RestSurfaces rest = muscle::make_rest_surfaces(asset, bones);
  level.rest = level.meter.measure(rest.surfaces, rest.tendons, bones);
  return level;
}

void PenetrationReport::record(Simulation& simulation, Report& report) {
  muscle::DepthsBeyond most;
  float bone = 0.0f, other = 0.0f, area = 0.0f;
  double fallbacks = 0.0, left_out = 0.0;
  bool any = false;
  const ecs::World& world = simulation.world();
  simulation.workers().execute([&] {
    for (const SpawnedCharacter& character : simulation.characters()) {
      if (character.musculature == ecs::kNoEntity) continue;
      any = true;
      const auto& musculature = world.get<muscle::Musculature>(character.musculature);
      const auto& surfaces = world.get<muscle::MuscleSurfaces>(character.musculature);
      const auto& tendons = world.get<muscle::Tendons>(character.musculature);
      Level& level = level_of(character.asset, musculature.asset);
      const muscle::Penetration now =
          level.meter.measure(surfaces, tendons, world.get<BoneMatrices>(character.entity).world);
      const muscle::DepthsBeyond beyond = muscle::beyond(now, level.rest);
      most = {.bone = std::max(most.bone, beyond.bone), .muscle = std::max(most.muscle, beyond.muscle),
              .bone_pair = std::max(most.bone_pair, beyond.bone_pair),
              .muscle_pair = std::max(most.muscle_pair, beyond.muscle_pair)};
      bone = std::max(bone, deepest(now.bones).depth);
      other = std::max(other, deepest(now.muscles).depth);
      left_out += static_cast<double>(now.left_out);
      const auto* collision = world.try_get<muscle::MuscleCollision>(character.musculature);
      if (collision == nullptr) continue;
      fallbacks += static_cast<double>(collision->fallbacks);
      muscle::measure_section_areas(*musculature.asset, surfaces, tendons, areas_);
      const muscle::AreaError worst = muscle::worst_area_error(*musculature.asset, areas_, collision->target_area);
      area = std::max(area, worst.relative);
    }
  });
  if (!any) return;
  const auto mm = [](float metres) { return 1e3 * static_cast<double>(metres); };
  report.record("penetration.bone_max_mm", mm(most.bone));
  report.record("penetration.muscle_max_mm", mm(most.muscle));
  report.record("penetration.bone_pair_max_mm", mm(most.bone_pair));
  report.record("penetration.muscle_pair_max_mm", mm(most.muscle_pair));
  report.record("penetration.bone_deepest_mm", mm(bone));
  report.record("penetration.muscle_deepest_mm", mm(other));
  report.record("penetration.left_out", left_out);
  report.record("section_area_error_max", static_cast<double>(area));
  report.record("solve.fallbacks", fallbacks);
}

}  // namespace fascicle::game
