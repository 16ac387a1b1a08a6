// A character brought out of its walk in all ways that collide_scenarios.hpp knows, and measured while that lasts and
// from half a second after it: what `fascicle-cook collide --extremes` prints.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/fascicle_cook/collide_run.hpp"
#include "tools/fascicle_cook/collide_scenarios.hpp"

namespace fascicle::cook {

// The bounds that a walk keeps, beyond the rest pose.
inline constexpr float kBoneBound = 1.0e-3f, kMuscleBound = 2.0e-3f;  // m
inline constexpr float kAreaBound = 0.02f;                            // of the target

// The worst of some measured steps.
struct ExtremeFigures {
  muscle::DepthsBeyond beyond;
  muscle::PairDepth bone, muscle;         // those of beyond.bone_pair and muscle_pair
  float area = 0.0f;                      // of the target, without sign
  bool finite = true;

  bool within_bounds() const {
    return finite && beyond.bone < kBoneBound && beyond.muscle < kMuscleBound && area < kAreaBound;
  }
  bool pairs_within_bounds() const {
    return within_bounds() && beyond.bone_pair < kBoneBound && beyond.muscle_pair < kMuscleBound;
  }
};

struct ExtremeRun {
  std::string name;  // the scenario's
  CollideMode mode = CollideMode::kWithout;
  ExtremeFigures during;  // the disturbance
  ExtremeFigures after;   // the walk, from half a second after its end on
  double recovery = 0.0;  // s from its end to the last measured step out of bounds; 0: none was
  std::uint64_t fallbacks = 0, held = 0;
};

struct ExtremeOptions {
  std::uint64_t before = 12;  // steps of the walk before the disturbance
  std::uint64_t after = 96;   // and after it
  std::uint64_t every = 6;    // one in so many is measured
  int workers = 0;            // 0: one for each core
  float spacing = muscle::kSampleSpacing;  // m between the points that are measured
};

ExtremeRun run_extreme(const CollideSubject& subject, const CollideScenario& scenario, CollideMode mode,
                       const ExtremeOptions& options);

struct ExtremesReport {
  CollideSubject subject;
  std::vector<ExtremeRun> runs;  // scenario after scenario
};
// All scenarios, or those whose names have `only` in them.
ExtremesReport run_extremes(const muscle::SceneAsset& scene, const std::vector<CollideMode>& modes,
                            const ExtremeOptions& options, const std::string& only = {});

// A row for each run: worst during, worst after half a second, each by state and by pair with the pair's name, area,
// recovery, fallbacks.
std::string to_table(const ExtremesReport& report);

}  // namespace fascicle::cook
