// The walker and gait2392 with collision, as they are played: bounds on penetration in a walk, after disturbances and
// standing still, the same bits for any number of workers, and what games read of contacts. What is measured, and that
// it is beyond the rest pose, is measure/'s; without the solver, and in the thesis's own mode, the same checks fail.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <tuple>

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include "engine/parallel/worker_arena.hpp"
#include "game/penetration_report.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/muscle.hpp"
#include "tests/support/test_data.hpp"
#include "tools/fascicle_cook/collide_extremes.hpp"
#include "tools/fascicle_cook/collide_run.hpp"

namespace fascicle::cook {
namespace {

using muscle::MuscleContact;

constexpr float kCoarse = 0.006f;        // m between measured points, where many steps are
constexpr double kJitterBound = 1.0e-5;  // m, root mean square

std::shared_ptr<const muscle::SceneAsset> load(const char* name) {
  const auto file = std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "scenes" /
                    (std::string(name) + ".scene.json");
  auto scene = muscle::load_scene(file, {.data_folder = test::data_folder()});
  EXPECT_TRUE(scene.ok()) << to_text(scene.diagnostics());
  return scene.ok() ? *scene : nullptr;
}

// Each figure's worst over the frames that count.
struct Worst {
  muscle::DepthsBeyond beyond;
  float area = 0.0f;

  explicit Worst(const CollideReport& report, CollideMode mode) {
    for (const CollideRun& run : report.runs) {
      for (const CollideFrame& frame : run.frames) {
        if (run.mode != mode || frame.frame < report.options.first) continue;
        beyond.bone = std::max(beyond.bone, frame.beyond.bone);
        beyond.muscle = std::max(beyond.muscle, frame.beyond.muscle);
        beyond.bone_pair = std::max(beyond.bone_pair, frame.beyond.bone_pair);
        beyond.muscle_pair = std::max(beyond.muscle_pair, frame.beyond.muscle_pair);
        area = std::max(area, frame.area.relative);
      }
    }
  }
};

void expect_steady(const CollideRun& run) {
  EXPECT_EQ(run.unstable, 0u);
  EXPECT_LT(run.jitter_rms, kJitterBound);
  ASSERT_FALSE(run.frames.empty());
  EXPECT_EQ(run.frames.back().fallbacks, 0u);
  EXPECT_EQ(run.frames.back().held, 0u);
}

TEST(WalkerCollision, AWalkStaysWithinItsBounds) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  const CollideReport solved = run_collide(scene, {CollideMode::kWith}, {.frames = 77, .every = 11});
  ASSERT_EQ(solved.runs.size(), 1u);
  expect_steady(solved.runs[0]);
  const Worst with(solved, CollideMode::kWith);
  EXPECT_LT(with.beyond.bone, kBoneBound);
  EXPECT_LT(with.beyond.muscle, kMuscleBound);
  EXPECT_LT(with.area, kAreaBound);

  // Without the solver none of this holds. One muscle's depth at rest excuses another's now, unless pairs are told
  // apart.
  const CollideReport other = run_collide(scene, {CollideMode::kWithout, CollideMode::kLegacy},
                                          {.frames = 66, .every = 22});
  ASSERT_EQ(other.runs.size(), 2u);
  const Worst without(other, CollideMode::kWithout), legacy(other, CollideMode::kLegacy);
  EXPECT_GT(without.beyond.bone, 2.0f * kBoneBound);
  EXPECT_GT(without.beyond.bone_pair, 3.0f * kBoneBound);
  EXPECT_GT(without.beyond.muscle_pair, 3.0f * kMuscleBound);
  EXPECT_LT(with.beyond.bone_pair, 0.5f * without.beyond.bone_pair);
  EXPECT_LT(with.beyond.muscle_pair, 0.5f * without.beyond.muscle_pair);
  // The thesis's mode does worse than nothing.
  EXPECT_GT(legacy.beyond.bone, without.beyond.bone);
  EXPECT_GT(other.runs[1].jitter_rms, kJitterBound);
}

TEST(WalkerCollision, TheHashIsTheSameForAnyNumberOfWorkers) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  const auto hash = [&](int workers, bool collision) {
    game::Simulation simulation(scene, {.workers = workers, .collision = collision, .skin_meshes = false});
    for (int i = 0; i < 60; ++i) simulation.step();
    return simulation.hash();
  };
  const std::uint64_t one = hash(1, true);
  EXPECT_EQ(hash(2, true), one);
  EXPECT_EQ(hash(3, true), one);
  EXPECT_NE(hash(1, false), one);  // it does something
}

// Bones before other muscles.
auto key_of(const MuscleContact& contact) {
  return std::tuple(contact.muscle, contact.bone < 0, contact.bone, contact.other);
}

bool holds(const std::vector<MuscleContact>& list, const MuscleContact& contact) {
  return std::any_of(list.begin(), list.end(), [&](const auto& other) { return key_of(other) == key_of(contact); });
}

void expect_sound(const std::vector<MuscleContact>& list, const muscle::CollisionAsset& asset) {
  const std::size_t muscles = asset.first_section.size() - 1;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const MuscleContact& contact = list[i];
    ASSERT_LT(contact.muscle, muscles);
    if (contact.bone < 0) {
      ASSERT_LT(contact.other, muscles);
      EXPECT_LT(contact.muscle, contact.other);
      EXPECT_NE(asset.muscles_touch[contact.muscle * muscles + contact.other] +
                    asset.muscles_touch[contact.other * muscles + contact.muscle], 0);
    } else {
      EXPECT_THAT(asset.bones, testing::Contains(contact.bone));
    }
    EXPECT_GT(contact.points, 0u);
    EXPECT_GE(contact.depth, 0.0f);
    EXPECT_GE(contact.left, 0.0f);
    EXPECT_LT(std::max(contact.depth, contact.left), 0.1f);
    EXPECT_NEAR(glm::length(contact.normal), 1.0f, 1e-3f);
    EXPECT_TRUE(std::isfinite(contact.place.x + contact.place.y + contact.place.z));
    if (i > 0) {
      EXPECT_LT(key_of(list[i - 1]), key_of(contact));
    }
  }
}

TEST(WalkerCollision, ContactsBeginAndEndOnce) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  game::Simulation simulation(scene, {.workers = 1, .skin_meshes = false});
  const ecs::Entity musculature = simulation.characters().front().musculature;
  std::vector<MuscleContact> before;
  std::size_t began = 0, ended = 0, with_bones = 0, with_muscles = 0;
  for (int step = 0; step < 40; ++step) {
    simulation.step();
    const auto& contacts = simulation.world().get<muscle::MuscleContacts>(musculature);
    const auto& collision = simulation.world().get<muscle::MuscleCollision>(musculature);
    expect_sound(contacts.now, *collision.asset);
    expect_sound(contacts.began, *collision.asset);
    expect_sound(contacts.ended, *collision.asset);
    for (const MuscleContact& contact : contacts.now) {
      EXPECT_EQ(holds(contacts.began, contact), !holds(before, contact));
      EXPECT_GE(collision.depth[contact.muscle], contact.left);
      if (contact.bone < 0) {
        EXPECT_GE(collision.depth[contact.other], contact.left);
      }
      ++(contact.bone < 0 ? with_muscles : with_bones);
    }
    for (const MuscleContact& contact : before) {
      EXPECT_EQ(holds(contacts.ended, contact), !holds(contacts.now, contact));
    }
    EXPECT_EQ(before.size() + contacts.began.size(), contacts.now.size() + contacts.ended.size());
    EXPECT_EQ(collision.overflows, 0u);
    began += contacts.began.size();
    ended += contacts.ended.size();
    before = contacts.now;
  }
  EXPECT_GT(with_bones, 40u);
  EXPECT_GT(with_muscles, 40u);
  EXPECT_GT(began, 20u);
  EXPECT_GT(ended, 0u);
}

TEST(WalkerCollision, AReportCarriesItsFigures) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  game::Simulation simulation(scene, {.workers = 0, .skin_meshes = false});
  game::PenetrationReport penetration;
  game::Report report;
  for (int i = 0; i < 2; ++i) {
    report.begin_frame();
    simulation.step();
    simulation.record_metrics(report);
    penetration.record(simulation, report);
  }
  const std::string json = report.to_json(scene->name, simulation.hash());
  for (const char* key : {"penetration.bone_max_mm", "penetration.muscle_max_mm", "section_area_error_max",
                          "solve.fallbacks"}) {
    EXPECT_THAT(json, testing::HasSubstr(std::string("\"") + key + "\"")) << key;
  }
}

// Scenarios with `name` in theirs: with collision the walk is within its bounds half a second later, without it is not.
void expect_recovery(const std::string& name, std::size_t count) {
  static const CollideSubject walker = [] {
    CollideSubject subject;
    const auto scene = load("walker");
    parallel::WorkerArena workers(0);
    if (scene) workers.execute([&] { subject = prepare_subject(*scene, {.spacing = kCoarse}); });
    return subject;
  }();
  ASSERT_TRUE(walker.scene);
  std::size_t found = 0;
  for (const CollideScenario& scenario : collide_scenarios(*walker.scene->characters.front().character)) {
    if (scenario.name.find(name) == std::string::npos) continue;
    ++found;
    SCOPED_TRACE(scenario.name);
    const ExtremeRun with = run_extreme(walker, scenario, CollideMode::kWith, {.after = 72, .every = 18});
    EXPECT_TRUE(with.during.finite && with.after.finite);
    EXPECT_EQ(with.held, 0u);
    EXPECT_LT(with.after.beyond.bone, kBoneBound);
    EXPECT_LT(with.after.beyond.muscle, kMuscleBound);
    EXPECT_LT(with.after.area, kAreaBound);
    EXPECT_LE(with.recovery, 0.5);

    const ExtremeRun without = run_extreme(walker, scenario, CollideMode::kWithout, {.after = 72, .every = 36});
    EXPECT_FALSE(without.after.within_bounds());
    EXPECT_GT(without.after.beyond.bone, kBoneBound);
    EXPECT_GT(without.after.beyond.muscle_pair, kMuscleBound);
    EXPECT_GT(without.recovery, 0.5);
  }
  EXPECT_EQ(found, count);
}

TEST(WalkerCollision, ASweepOfHipsAndKneesIsGotOver) { expect_recovery("sweep", 1); }

TEST(WalkerCollision, MusclesBeyondABoneComeBack) { expect_recovery("beyond femur", 3); }

TEST(WalkerCollision, TeleportsPausesAndLongFramesAreGotOver) {
  expect_recovery("teleport", 2);
  expect_recovery("pause", 1);
  expect_recovery("frame of", 1);
}

// How much deeper pairs were than at rest, each at its worst, all together, m.
float sum_beyond(const CollideRun& run, bool bones) {
  float sum = 0.0f;
  for (const CollidePair& pair : run.pairs) {
    if ((pair.deepest.bone >= 0) == bones) sum += std::max(pair.deepest.depth - pair.rest, 0.0f);
  }
  return sum;
}

// Its round muscles are up to 30 mm deep in each other at rest and 14 mm in bones, so that the deepest of all tells
// little of what the walk adds, with collision or without: pairs do.
TEST(Gait2392Collision, HalvesWhatItsWalkPressesIn) {
  FASCICLE_SKIP_WITHOUT_DATA("opensim/walk.mot");
  const auto scene = load("gait2392");
  ASSERT_TRUE(scene);
  const CollideReport report = run_collide(scene, {CollideMode::kWithout, CollideMode::kWith},
                                           {.frames = 80, .every = 10});
  ASSERT_EQ(report.runs.size(), 2u);
  expect_steady(report.runs[1]);
  const Worst with(report, CollideMode::kWith), without(report, CollideMode::kWithout);
  EXPECT_GT(without.beyond.muscle, 0.0f);
  EXPECT_LE(with.beyond.muscle, 0.5f * without.beyond.muscle);
  EXPECT_LT(with.area, kAreaBound);
  EXPECT_LE(with.beyond.bone_pair, 0.5f * without.beyond.bone_pair);
  EXPECT_LE(with.beyond.muscle_pair, 0.5f * without.beyond.muscle_pair);
  for (const bool bones : {true, false}) {
    EXPECT_LE(sum_beyond(report.runs[1], bones), 0.5f * sum_beyond(report.runs[0], bones)) << "bones " << bones;
  }
}

}  // namespace
}  // namespace fascicle::cook
