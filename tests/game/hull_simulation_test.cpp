// Surface muscles with coarse hulls in a running scene: as content says, as the command line wants, and while their
// files are edited.
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "engine/animation/joint_systems.hpp"
#include "engine/animation/skeleton.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/content/content_reloader.hpp"
#include "modules/muscle/muscle.hpp"
#include "tests/modules/muscle/content/scratch_surfaces.hpp"
#include "tests/support/allocation_counter.hpp"

namespace fascicle::game {
namespace {

using muscle::SurfaceHull;
using muscle::SurfaceSolver;
using muscle::SurfaceState;
using test::ScratchFolder;
using test::with;

// The limb with a knee that bends, and its ball posed by a hull.
std::string hulled_limb() {
  std::string text = with(std::string(test::kLimb), R"("coordinates": [])",
                          R"("coordinates": [{ "name": "knee", "kind": "rotation", "range": [-1, 1] }])");
  text = with(text, R"("parent_frame": { "translation": [0, -0.2, 0.15] })",
              R"("parent_frame": { "translation": [0, -0.2, 0.15] },
        "rotations": [{ "axis": [1, 0, 0], "coordinate": "knee" }])");
  return with(text, R"("driver": "calf_r")", R"("solver": "coarse_hull", "hull": { "vertices": 60 },
      "action_line": [{ "bone": "trunk", "at": [-150, 95, 10] }, { "bone": "shin_r", "at": [-150, -95, 0] }])");
}

class HullSimulation : public testing::Test {
 protected:
  std::shared_ptr<const muscle::SceneAsset> load(std::string_view text) {
    test::write_limb(folder, text);
    file = folder.write(
        "limb.scene.json", R"({ "version": 1, "name": "limb", "characters": [{ "file": "limb.character.json" }] })");
    const auto scene = muscle::load_scene(file);
    EXPECT_TRUE(scene.ok()) << to_text(scene.diagnostics());
    return scene.ok() ? *scene : nullptr;
  }
  static ecs::Entity ball(const Simulation& simulation) { return simulation.characters().at(0).surfaces.at(0); }
  static void bend(Simulation& simulation, double angle, int steps = 1) {
    simulation.world().get<CoordinatePose>(simulation.characters().at(0).entity).values.at(0) = angle;
    for (int i = 0; i < steps; ++i) simulation.step();
  }
  static std::vector<std::array<float, 3>> points(const Simulation& simulation) {
    std::vector<std::array<float, 3>> places;
    const SurfaceState& state = simulation.world().get<SurfaceState>(ball(simulation));
    for (const muscle::SurfacePoint& p : state.points) places.push_back({p.x, p.y, p.z});
    return places;
  }

  ScratchFolder folder;
  std::filesystem::path file;
};

TEST_F(HullSimulation, ContentOrTheCommandLineChoosesTheSolver) {
  const auto scene = load(hulled_limb());
  ASSERT_TRUE(scene);
  Simulation as_said(scene, {.workers = 1});
  Simulation dynamic(scene, {.workers = 1, .surface_solver = SurfaceSolver::kDynamic});
  for (Simulation* simulation : {&as_said, &dynamic}) bend(*simulation, 0.5, 3);
  EXPECT_EQ(as_said.world().get<SurfaceHull>(ball(as_said)).solver, SurfaceSolver::kCoarseHull);
  EXPECT_EQ(dynamic.world().get<SurfaceHull>(ball(dynamic)).solver, SurfaceSolver::kDynamic);
  EXPECT_NE(points(as_said), points(dynamic));
  EXPECT_NE(as_said.hash(), dynamic.hash());
  // One that has no hull is not forced.
  const auto plain = load(test::kLimb);
  ASSERT_TRUE(plain);
  Simulation unhulled(plain, {.workers = 1, .surface_solver = SurfaceSolver::kCoarseHull});
  unhulled.step();
  EXPECT_FALSE(unhulled.world().has<SurfaceHull>(ball(unhulled)));
  EXPECT_EQ(unhulled.world().get<SurfaceState>(ball(unhulled)).fallbacks, 0u);
}

TEST_F(HullSimulation, PosesHaveNoPast) {
  const auto scene = load(hulled_limb());
  ASSERT_TRUE(scene);
  Simulation simulation(scene, {.workers = 1}), fresh(scene, {.workers = 3});
  for (const double angle : {0.1, 0.9, -0.4, 0.3}) bend(simulation, angle);
  bend(fresh, 0.3);
  EXPECT_EQ(points(simulation), points(fresh));
}

TEST_F(HullSimulation, LiveReloadKeepsRunning) {
  const auto scene = load(hulled_limb());
  ASSERT_TRUE(scene);
  Simulation simulation(scene, {.workers = 2});
  muscle::ContentReloader reloader(file, scene);
  bend(simulation, 0.6, 3);
  const std::size_t before = simulation.world().get<SurfaceHull>(ball(simulation)).asset->rest.size();

  folder.write("limb.character.json", with(hulled_limb(), R"("vertices": 60)", R"("vertices": 40)"));
  auto outcome = reloader.wait();
  ASSERT_TRUE(outcome && outcome->scene);
  simulation.swap_scene(outcome->scene);
  bend(simulation, 0.6);
  const SurfaceHull& hull = simulation.world().get<SurfaceHull>(ball(simulation));
  EXPECT_LT(hull.asset->rest.size(), before);
  EXPECT_EQ(hull.solver, SurfaceSolver::kCoarseHull);
  EXPECT_EQ(hull.blend_left, 0.0f);  // its first shape is its pose
  EXPECT_EQ(simulation.world().get<SurfaceState>(ball(simulation)).fallbacks, 0u);
  Simulation fresh(outcome->scene, {.workers = 1});
  bend(fresh, 0.6);
  EXPECT_EQ(points(simulation), points(fresh));

  // Broken: the last good version goes on.
  folder.write("limb.character.json", with(hulled_limb(), R"("vertices": 60)", R"("vertices": 2)"));
  const std::uint64_t running = simulation.hash();
  outcome = reloader.wait();
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(outcome->scene);
  ASSERT_FALSE(outcome->diagnostics.errors.empty());
  EXPECT_FALSE(outcome->diagnostics.errors[0].remedy.empty());
  EXPECT_EQ(simulation.hash(), running);

  // Another solver.
  folder.write("limb.character.json", with(hulled_limb(), R"("solver": "coarse_hull")", R"("solver": "dynamic")"));
  outcome = reloader.wait();
  ASSERT_TRUE(outcome && outcome->scene);
  simulation.swap_scene(outcome->scene);
  bend(simulation, 0.6, 3);
  EXPECT_FALSE(simulation.world().has<SurfaceHull>(ball(simulation)));
  EXPECT_EQ(simulation.world().get<SurfaceState>(ball(simulation)).fallbacks, 0u);
}

// The walker's driven meshes, some of which have levels: looked at from near, from far and from near again.
class WalkerFromAfar : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto file = std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "scenes" / "walker-surface.scene.json";
    const auto scene = muscle::load_scene(file);
    ASSERT_TRUE(scene.ok()) << to_text(scene.diagnostics());
    scene_ = *scene;
  }
  static void TearDownTestSuite() { scene_.reset(); }

  static void look_from(Simulation& simulation, float distance) {
    const auto& bones = simulation.world().get<BoneMatrices>(simulation.characters().at(0).entity).world;
    simulation.set_viewer({.enabled = true, .eye = glm::vec3(bones[1][3]) + glm::vec3(distance, 0.0f, 0.0f),
                           .pixels_per_radian = 1000.0f});
  }
  // 6 steps each at 1 m, 15 m and 1 m.
  static float distance_at(int step) { return step < 6 || step >= 12 ? 1.0f : 15.0f; }

  static std::shared_ptr<const muscle::SceneAsset> scene_;
};
std::shared_ptr<const muscle::SceneAsset> WalkerFromAfar::scene_;

TEST_F(WalkerFromAfar, HullsPoseWhatIsSmallAndDynamicsGoOn) {
  ASSERT_TRUE(scene_);
  Simulation simulation(scene_, {.workers = 1});
  std::size_t hulled = 0;
  for (int step = 0; step < 18; ++step) {
    look_from(simulation, distance_at(step));
    simulation.step();
    hulled = 0;
    for (const ecs::Entity entity : simulation.characters()[0].surfaces) {
      const auto& state = simulation.world().get<SurfaceState>(entity);
      EXPECT_EQ(state.fallbacks, 0u);
      EXPECT_NEAR(state.volume / simulation.world().get<muscle::SurfaceMuscle>(entity).asset->volume, 1.0, 0.01);
      const SurfaceHull* hull = simulation.world().try_get<SurfaceHull>(entity);
      if (hull == nullptr) continue;
      ++hulled;
      EXPECT_EQ(hull->solver, distance_at(step) > 2.0f ? SurfaceSolver::kCoarseHull : SurfaceSolver::kDynamic) << step;
    }
  }
  ASSERT_GT(hulled, 0u);
  for (const ecs::Entity entity : simulation.characters()[0].surfaces) {
    const SurfaceHull* hull = simulation.world().try_get<SurfaceHull>(entity);
    if (hull != nullptr) {
      EXPECT_EQ(hull->switches, 2u);
    }
  }
}

TEST_F(WalkerFromAfar, ChangesOfSolverAreTheSameForAnyThreadsAndAllocateNothing) {
  ASSERT_TRUE(scene_);
  Simulation one(scene_, {.workers = 1}), three(scene_, {.workers = 3});
  for (int step = 0; step < 18; ++step) {
    for (Simulation* simulation : {&one, &three}) look_from(*simulation, distance_at(step));
    three.step();
    const test::AllocationScope count;
    one.step();
    if (step >= 3) {
      EXPECT_EQ(count.allocations(), 0u) << step;
    }
    EXPECT_EQ(one.hash(), three.hash()) << step;
  }
}

}  // namespace
}  // namespace fascicle::game
