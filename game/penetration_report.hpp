// The metrics of a run's report that are measured on the drawn surfaces: how deep muscles are in bones and in each
// other, and how far sections are from their areas (modules/muscle/measure). That takes some tens of milliseconds a
// character and step, so it is done only where a report was asked for; it changes nothing in the simulation.
//
// In mm: penetration.bone_deepest_mm and muscle_deepest_mm; bone_max_mm and muscle_max_mm, the same beyond the deepest
// at rest; bone_pair_max_mm and muscle_pair_max_mm, the most by which a pair is deeper than the same pair at rest. Of
// several characters the largest counts. Then section_area_error_max (a fraction; 0 where nothing has a target),
// solve.fallbacks (all characters', so far) and penetration.left_out (muscles that could not be measured).
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "game/report.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/measure/penetration_meter.hpp"

namespace fascicle::game {

class PenetrationReport {
 public:
  // Of the step that was just made. The rest pose is measured when a character's level of detail is first seen.
  void record(Simulation& simulation, Report& report);

 private:
  struct Level {
    std::shared_ptr<const muscle::MuscleAsset> asset;
    muscle::PenetrationMeter meter;
    muscle::Penetration rest;
  };
  struct Character {
    std::shared_ptr<const muscle::CharacterAsset> asset;
    std::shared_ptr<const muscle::BoneSolids> bones;
    std::deque<Level> levels = {};
  };

  Level& level_of(const std::shared_ptr<const muscle::CharacterAsset>& character,
                  const std::shared_ptr<const muscle::MuscleAsset>& asset);

  std::deque<Character> characters_;
  std::vector<float> areas_;
};

}  // namespace fascicle::game
