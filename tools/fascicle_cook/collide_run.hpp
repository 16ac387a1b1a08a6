// A character played through its animation and measured on the way: what `fascicle-cook collide` prints.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "modules/muscle/content/scene_asset.hpp"
#include "modules/muscle/measure/penetration_meter.hpp"
#include "modules/muscle/measure/section_areas.hpp"

namespace fascicle::game {
class Simulation;
}

namespace fascicle::cook {

enum class CollideMode { kWithout, kWith, kLegacy };
const char* to_string(CollideMode mode);

struct CollideOptions {
  std::uint64_t frames = 0;            // steps
  std::uint64_t every = 1;             // one in so many steps is measured
  std::uint64_t first = 11;            // the first step that counts
  std::optional<std::uint32_t> level;  // of detail; absent: the finest
  int workers = 0;                     // 0: one for each core
  float spacing = muscle::kSampleSpacing;  // m between the points that are measured
};

// One measured step.
struct CollideFrame {
  std::uint64_t frame = 0;  // from 1
  muscle::PairDepth bone, muscle;  // the deepest
  muscle::DepthsBeyond beyond;
  muscle::AreaError area;
  std::uint64_t fallbacks = 0, held = 0;  // so far
};

// One pair over the steps that count.
struct CollidePair {
  muscle::PairDepth deepest;
  std::uint64_t frame = 0;
  float rest = 0.0f;  // m, the same pair at rest
};

// One mode's run.
struct CollideRun {
  CollideMode mode = CollideMode::kWithout;
  std::vector<CollideFrame> frames;
  std::vector<CollidePair> pairs;  // those with most beyond rest first
  std::uint64_t unstable = 0;      // measured steps with a surface that is not finite
  double jitter_rms = 0.0, jitter_largest = 0.0;  // m, standing still from one second after the run on
  double step_ms = 0.0, measure_ms = 0.0;         // means
};

// The scene's first character, alone, in all modes that it has: without collision always, the others where its
// musculature has collision.
struct CollideReport {
  std::string scene;
  float step_hz = 0.0f;
  CollideOptions options;
  std::shared_ptr<const muscle::MuscleAsset> asset;
  std::shared_ptr<const muscle::CharacterAsset> character;
  muscle::Penetration rest;
  std::vector<CollideRun> runs;
};
CollideReport run_collide(const std::shared_ptr<const muscle::SceneAsset>& scene, const std::vector<CollideMode>& modes,
                          const CollideOptions& options);

// What all runs of a scene's first character share.
struct CollideSubject {
  std::shared_ptr<const muscle::SceneAsset> scene;  // with that character alone
  std::shared_ptr<const muscle::MuscleAsset> asset;  // that is played
  bool collides = false;                             // modes other than kWithout make sense
  std::unique_ptr<muscle::PenetrationMeter> meter;
  muscle::Penetration rest;

  bool has(CollideMode mode) const { return collides || mode == CollideMode::kWithout; }
};
// In parallel on the caller's arena.
CollideSubject prepare_subject(const muscle::SceneAsset& scene, const CollideOptions& options);

// Lets the simulation's first character collide in this mode from the next step on.
void set_mode(game::Simulation& simulation, CollideMode mode);

// The first character's penetration as it is now.
muscle::Penetration measure_now(game::Simulation& simulation, muscle::PenetrationMeter& meter);
// And its worst section; nothing where it has no collision. `areas` is scratch.
muscle::AreaError measure_areas_now(const game::Simulation& simulation, std::vector<float>& areas);

}  // namespace fascicle::cook
