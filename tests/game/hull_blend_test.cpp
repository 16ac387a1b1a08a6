// The hip's muscles change their solver while the femur moves, measured by code of its own: what is blended stays out
// of the bone, keeps its volume and goes no further in a step than the fade allows.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "engine/animation/joint_systems.hpp"
#include "game/simulation.hpp"
#include "game/surface_figures.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/kernels/hull/blend_surface.hpp"
#include "modules/muscle/muscle.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::game {
namespace {

using muscle::SurfaceHull;
using muscle::SurfaceSolver;
using muscle::SurfaceState;

class HullBlend : public testing::Test {
 protected:
  void SetUp() override {
    FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
    const auto file = std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "scenes" / "hip-hull.scene.json";
    const auto scene = muscle::load_scene(file, {.data_folder = test::data_folder()});
    ASSERT_TRUE(scene.ok()) << to_text(scene.diagnostics());
    simulation_ = std::make_unique<Simulation>(*scene, SimulationOptions{.surface_solver = SurfaceSolver::kDynamic});
    simulation_->world().remove<MotionPlayer>(character().entity);
  }
  const SpawnedCharacter& character() const { return simulation_->characters().at(0); }
  void force(SurfaceSolver solver) {
    for (const ecs::Entity entity : character().surfaces) simulation_->world().get<SurfaceHull>(entity).forced = solver;
  }
  void bend(double by) {
    angle_ += by;
    simulation_->world().get<CoordinatePose>(character().entity).values.at(0) = angle_;
    simulation_->step();
  }
  std::vector<std::vector<muscle::SurfacePoint>> points() const {
    std::vector<std::vector<muscle::SurfacePoint>> all;
    for (const ecs::Entity entity : character().surfaces) {
      const auto& state = simulation_->world().get<SurfaceState>(entity);
      all.emplace_back(state.points.begin(), state.points.end());
    }
    return all;
  }
  float difference(ecs::Entity entity) const {  // m, at the change
    float most = 0.0f;
    for (const muscle::SurfacePoint& d : simulation_->world().get<SurfaceHull>(entity).difference) {
      most = std::max(most, std::hypot(d.x, d.y, d.z));
    }
    return most;
  }
  std::uint32_t touching() const {
    std::uint32_t vertices = 0;
    for (const ecs::Entity entity : character().surfaces) {
      for (const auto& contact : simulation_->world().get<muscle::SurfaceContacts>(entity).now) {
        vertices += contact.vertices;
      }
    }
    return vertices;
  }
  std::vector<SurfaceFigures> measure() { return meters_.measure(*simulation_); }

  std::unique_ptr<Simulation> simulation_;
  SurfaceMeters meters_;
  double angle_ = 0.0;
};

// m: the furthest that a vertex of any muscle has moved.
float furthest(const std::vector<std::vector<muscle::SurfacePoint>>& a,
               const std::vector<std::vector<muscle::SurfacePoint>>& b) {
  float distance = 0.0f;
  for (std::size_t m = 0; m < a.size(); ++m) {
    for (std::size_t v = 0; v < a[m].size(); ++v) {
      distance = std::max(distance, std::hypot(a[m][v].x - b[m][v].x, a[m][v].y - b[m][v].y, a[m][v].z - b[m][v].z));
    }
  }
  return distance;
}

TEST_F(HullBlend, ChangesToAndFroWhileTheFemurMoves) {
  constexpr double kStep = 0.015;  // rad
  auto before = points();
  const auto moved = [&] {
    bend(kStep);
    auto now = points();
    const float by = furthest(now, before);
    before = std::move(now);
    return by;
  };
  const auto expect_sound = [&](const char* when, int i) {
    for (const SurfaceFigures& figures : measure()) {
      EXPECT_LT(figures.depths.free.depth, 0.0005) << figures.asset->name << when << i;
      EXPECT_NEAR(figures.quality->volume_ratio, 1.0, 0.01) << figures.asset->name << when << i;
      EXPECT_LT(figures.attachment_error, 0.0001) << figures.asset->name << when << i;
      EXPECT_EQ(figures.fallbacks, 0u) << figures.asset->name << when << i;
    }
  };
  float usual = 0.0f;  // m a step, with dynamics alone
  for (int i = 0; i < 54; ++i) usual = std::max(usual, moved());

  force(SurfaceSolver::kCoarseHull);
  float share = 1.0f, apart = 0.0f;
  for (int i = 0; i < 13; ++i) {
    const float by = moved();
    if (i == 0) {
      for (const ecs::Entity entity : character().surfaces) apart = std::max(apart, difference(entity));
      ASSERT_GT(apart, 0.003f);
    }
    const SurfaceHull& hull = simulation_->world().get<SurfaceHull>(character().surfaces[0]);
    const float next = muscle::fading(hull.blend_left / hull.blend_time);
    EXPECT_LT(by, usual + 1.2f * (share - next) * apart + 0.0005f) << i;
    share = next;
    if (i % 3 == 0) expect_sound(" while it fades, step ", i);
  }
  EXPECT_LT(share, 0.1f);
  EXPECT_GT(touching(), 0u);  // a bone that nothing touches would prove little

  // Dynamics go on from there, at rest: they relax, but nothing springs.
  force(SurfaceSolver::kDynamic);
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT(moved(), 4.0f * usual) << i;
    if (i % 3 == 0) expect_sound(" in dynamics, step ", i);
  }
}

}  // namespace
}  // namespace fascicle::game
