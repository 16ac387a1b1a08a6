#include "tools/fascicle_cook/collide_run.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "engine/animation/motion.hpp"
#include "engine/animation/pose_systems.hpp"
#include "engine/animation/joint_systems.hpp"
#include "engine/ecs/monotonic_clock.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/measure/jitter.hpp"
#include "modules/muscle/measure/rest_surfaces.hpp"
#include "modules/muscle/muscle.hpp"

namespace fascicle::cook {
namespace {

using namespace muscle;

// A first character without its fellows and where it stands: depths do not depend on either.
std::shared_ptr<const SceneAsset> alone(const SceneAsset& scene) {
  auto copy = std::make_shared<SceneAsset>(scene);
  copy->characters.resize(1);
  return copy;
}

void stand_still(ecs::World& world, ecs::Entity character) {
  if (ClipPlayer* clip = world.try_get<ClipPlayer>(character)) clip->speed = 0.0f;
  if (MotionPlayer* motion = world.try_get<MotionPlayer>(character)) motion->speed = 0.0;
}

// The deepest of every pair.
class Pairs {
 public:
  void add(const std::vector<PairDepth>& pairs, std::uint64_t frame) {
    for (const PairDepth& pair : pairs) {
      CollidePair& kept = pairs_[{pair.bone, std::min(pair.muscle, pair.bone >= 0 ? pair.muscle : pair.other),
                                  std::max(pair.muscle, pair.bone >= 0 ? pair.muscle : pair.other)}];
      if (pair.depth > kept.deepest.depth) {
        kept.deepest = pair;
        kept.frame = frame;
      }
    }
  }
  std::vector<CollidePair> worst_first(const Penetration& rest) const {
    std::vector<CollidePair> list;
    for (const auto& [key, pair] : pairs_) {
      list.push_back(pair);
      list.back().rest = depth_of(pair.deepest, rest);
    }
    std::stable_sort(list.begin(), list.end(), [](const CollidePair& a, const CollidePair& b) {
      return a.deepest.depth - a.rest > b.deepest.depth - b.rest;
    });
    return list;
  }

 private:
  std::map<std::tuple<std::int32_t, std::uint32_t, std::uint32_t>, CollidePair> pairs_;
};

CollideRun run_mode(const std::shared_ptr<const SceneAsset>& scene, CollideMode mode, PenetrationMeter& meter,
                    const Penetration& rest, const CollideOptions& options) {
  game::Simulation simulation(scene, {.workers = options.workers, .skin_meshes = false});
  if (options.level) simulation.set_viewer({.enabled = true, .level = options.level});
  const game::SpawnedCharacter character = simulation.characters().front();
  ecs::World& world = simulation.world();
  set_mode(simulation, mode);

  CollideRun run;
  run.mode = mode;
  Pairs pairs;
  std::vector<float> areas;
  std::int64_t stepping = 0, measuring = 0;
  for (std::uint64_t frame = 1; frame <= options.frames; ++frame) {
    const std::int64_t start = monotonic_ns();
    simulation.step();
    stepping += monotonic_ns() - start;
    if (frame % options.every != 0) continue;
    const std::int64_t measure_start = monotonic_ns();
    const Penetration now = measure_now(simulation, meter);
    measuring += monotonic_ns() - measure_start;

    const MuscleCollision* collision = world.try_get<MuscleCollision>(character.musculature);
    const CollideFrame measured{.frame = frame, .bone = deepest(now.bones), .muscle = deepest(now.muscles),
                                .beyond = beyond(now, rest), .area = measure_areas_now(simulation, areas),
                                .fallbacks = collision == nullptr ? 0 : collision->fallbacks,
                                .held = simulation.held_steps()};
    run.frames.push_back(measured);
    if (now.left_out > 0) ++run.unstable;
    if (frame < options.first) continue;
    pairs.add(now.bones, frame);
    pairs.add(now.muscles, frame);
  }
  run.pairs = pairs.worst_first(rest);
  run.step_ms = 1e-6 * static_cast<double>(stepping) / static_cast<double>(std::max<std::uint64_t>(options.frames, 1));
  run.measure_ms =
      1e-6 * static_cast<double>(measuring) / static_cast<double>(std::max<std::size_t>(run.frames.size(), 1));

  stand_still(world, character.entity);
  const int second = static_cast<int>(scene->step_hz);
  Jitter jitter;
  for (int i = 0; i < 2 * second; ++i) {
    simulation.step();
    if (i < second) continue;
    jitter.add(*world.get<Musculature>(character.musculature).asset, world.get<ActionLines>(character.musculature));
  }
  run.jitter_rms = jitter.rms();
  run.jitter_largest = jitter.largest();
  return run;
}

}  // namespace

const char* to_string(CollideMode mode) {
  switch (mode) {
    case CollideMode::kWithout: return "without";
    case CollideMode::kWith: return "with";
    case CollideMode::kLegacy: return "legacy";
  }
  return "";
}

void set_mode(game::Simulation& simulation, CollideMode mode) {
  const game::SpawnedCharacter& character = simulation.characters().front();
  MuscleCollision* collision = simulation.world().try_get<MuscleCollision>(character.musculature);
  if (collision == nullptr) return;
  collision->settings.enabled = mode != CollideMode::kWithout;
  collision->settings.mode = mode == CollideMode::kLegacy ? CollisionMode::kLegacy : CollisionMode::kReduced;
  if (mode == CollideMode::kLegacy) game::add_legacy_collision(simulation.world(), character);
}

Penetration measure_now(game::Simulation& simulation, PenetrationMeter& meter) {
  const ecs::World& world = simulation.world();
  const game::SpawnedCharacter& character = simulation.characters().front();
  Penetration now;
  simulation.workers().execute([&] {
    now = meter.measure(world.get<MuscleSurfaces>(character.musculature), world.get<Tendons>(character.musculature),
                        world.get<BoneMatrices>(character.entity).world);
  });
  return now;
}

AreaError measure_areas_now(const game::Simulation& simulation, std::vector<float>& areas) {
  const ecs::World& world = simulation.world();
  const ecs::Entity musculature = simulation.characters().front().musculature;
  const MuscleCollision* collision = world.try_get<MuscleCollision>(musculature);
  if (collision == nullptr) return {};
  const MuscleAsset& asset = *world.get<Musculature>(musculature).asset;
  measure_section_areas(asset, world.get<MuscleSurfaces>(musculature), world.get<Tendons>(musculature), areas);
  return worst_area_error(asset, areas, collision->target_area);
}

CollideSubject prepare_subject(const SceneAsset& scene, const CollideOptions& options) {
  CollideSubject subject;
  subject.scene = alone(scene);
  game::Simulation probe(subject.scene, {.workers = options.workers, .skin_meshes = false});
  if (options.level) probe.set_viewer({.enabled = true, .level = options.level});
  for (int i = 0; i < 2; ++i) probe.step();
  const ecs::Entity musculature = probe.characters().front().musculature;
  subject.asset = probe.world().get<Musculature>(musculature).asset;
  subject.collides = probe.world().try_get<MuscleCollision>(musculature) != nullptr;
  const CharacterAsset& character = *subject.scene->characters.front().character;
  subject.meter = std::make_unique<PenetrationMeter>(subject.asset, make_bone_solids(character.bone_meshes),
                                                     options.spacing);
  const RestSurfaces rest = make_rest_surfaces(subject.asset, character.skeleton->rest_world);
  subject.rest = subject.meter->measure(rest.surfaces, rest.tendons, character.skeleton->rest_world);
  return subject;
}

CollideReport run_collide(const std::shared_ptr<const SceneAsset>& scene, const std::vector<CollideMode>& modes,
                          const CollideOptions& options) {
  CollideReport report;
  parallel::WorkerArena workers(options.workers);
  workers.execute([&] {
    const CollideSubject subject = prepare_subject(*scene, options);
    report.scene = scene->name;
    report.step_hz = scene->step_hz;
    report.options = options;
    report.character = subject.scene->characters.front().character;
    report.asset = subject.asset;
    report.rest = subject.rest;
    for (const CollideMode mode : modes) {
      if (!subject.has(mode)) continue;
      report.runs.push_back(run_mode(subject.scene, mode, *subject.meter, subject.rest, options));
    }
  });
  return report;
}

}  // namespace fascicle::cook
