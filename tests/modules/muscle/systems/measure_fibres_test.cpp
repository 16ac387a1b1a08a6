// Fibres' places and lengths while the surface that they are bound to moves.
#include "modules/muscle/systems/5_present/measure_fibres.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/ecs/world.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "modules/muscle/add_fibres.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "tests/modules/muscle/asset/fibres/tube_muscle.hpp"
#include "tests/support/allocation_counter.hpp"

namespace fascicle::muscle {
namespace {

// The equation of place_fibres.hpp, word for word.
glm::dvec3 place(const FibreBinding& binding, std::span<const SurfacePoint> surface) {
  std::array<glm::dvec3, 4> p;
  for (std::size_t k = 0; k < 4; ++k) {
    const SurfacePoint& vertex = surface[binding.vertex[k]];
    p[k] = {vertex.x, vertex.y, vertex.z};
  }
  glm::dvec3 sum(0.0);
  for (std::size_t k = 0; k < 4; ++k) sum += static_cast<double>(binding.weight[k]) * p[k];
  const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
  const double length = glm::length(normal);
  return length > 0.0 ? sum + static_cast<double>(binding.rise) / length * normal : sum;
}

TEST(PlaceFibres, FollowsItsEquationForAnyNumberOfPoints) {
  std::mt19937 random(3);
  const auto number = [&] { return static_cast<float>(random() % 2000) / 1000.0f - 1.0f; };
  std::vector<SurfacePoint> surface(20);
  for (SurfacePoint& p : surface) p = {number(), number(), number(), 5.0f};
  surface[7] = surface[8];  // so that some triangles have no area
  for (const std::uint32_t points_per_fibre : {2u, 3u, 5u, 6u, 10u}) {
    for (const std::size_t fibres : {0u, 1u, 2u, 3u, 7u}) {
      AlignedVector<FibreBinding> bindings(fibres * points_per_fibre);
      for (FibreBinding& b : bindings) {
        for (std::size_t k = 0; k < 4; ++k) b.vertex[k] = random() % 20, b.weight[k] = number();
        b.rise = number();
      }
      if (fibres > 0) bindings[0].vertex = {7, 8, 3, 4};
      std::vector<SurfacePoint> points(bindings.size(), {NAN, NAN, NAN, NAN});
      std::vector<float> lengths(fibres, NAN);
      place_fibres({bindings, points_per_fibre, surface, points, lengths});
      for (std::size_t f = 0; f < fibres; ++f) {
        double length = 0.0;
        glm::dvec3 before(0.0);
        for (std::size_t k = 0; k < points_per_fibre; ++k) {
          const std::size_t i = f * points_per_fibre + k;
          const glm::dvec3 there = place(bindings[i], surface);
          EXPECT_LT(glm::distance(there, glm::dvec3(points[i].x, points[i].y, points[i].z)), 1e-5);
          EXPECT_EQ(points[i].inverse_mass, 0.0f);
          if (k > 0) length += glm::distance(before, there);
          before = there;
        }
        EXPECT_NEAR(lengths[f], length, 1e-4);
      }
    }
  }
}

class MeasureFibres : public testing::Test {
 protected:
  void SetUp() override {
    const auto surface = build_surface_asset(test::describe_tube(0.02f, 0.2f), 2);
    ASSERT_TRUE(surface.ok()) << to_text(surface.diagnostics());
    surface_ = *surface;
    const auto bundle = build_fibre_bundle(*surface_, {.count = 37, .points = 5});
    ASSERT_TRUE(bundle.ok()) << to_text(bundle.diagnostics());
    bundle_ = *bundle;
    muscle_ = world_.create();
    world_.add<SurfaceMuscle>(muscle_).asset = surface_;
    world_.add<SurfaceState>(muscle_).points = surface_->rest;
  }
  void run() {
    workers_.execute([this] { measure_fibres(world_.view<const SurfaceState, FibreBundle>()); });
  }
  FibreBundle& fibres() { return world_.get<FibreBundle>(muscle_); }

  parallel::WorkerArena workers_{1};
  ecs::World world_;
  ecs::Entity muscle_;
  std::shared_ptr<const SurfaceAsset> surface_;
  std::shared_ptr<const FibreBundleAsset> bundle_;
};

TEST_F(MeasureFibres, OnlyTheMuscleThatABundleWasBuiltForTakesIt) {
  add_fibres(world_, ecs::kNoEntity, bundle_);
  add_fibres(world_, world_.create(), bundle_);
  add_fibres(world_, muscle_, nullptr);
  EXPECT_FALSE(world_.has<FibreBundle>(muscle_));
  auto other = std::make_shared<FibreBundleAsset>(*bundle_);
  other->surface_vertices += 1;
  add_fibres(world_, muscle_, other);
  EXPECT_FALSE(world_.has<FibreBundle>(muscle_));
  add_fibres(world_, muscle_, bundle_);
  EXPECT_TRUE(world_.has<FibreBundle>(muscle_));
}

TEST_F(MeasureFibres, AtRestNothingChangesAndASurfaceThatIsNotThereIsLeftAlone) {
  add_fibres(world_, muscle_, bundle_);
  EXPECT_EQ(fibres().length, bundle_->rest_length) << "before the first step";
  run();
  EXPECT_EQ(fibres().length, bundle_->rest_length);
  EXPECT_EQ(fibres().length_ratio_mean, 1.0f);
  world_.get<SurfaceState>(muscle_).points.clear();
  run();
  EXPECT_EQ(fibres().length, bundle_->rest_length);
}

TEST_F(MeasureFibres, LengthsFollowTheSurfaceWithoutAllocating) {
  add_fibres(world_, muscle_, bundle_);
  for (SurfacePoint& p : world_.get<SurfaceState>(muscle_).points) p.z *= 1.25f;
  const test::AllocationScope scope;
  run();
  EXPECT_EQ(scope.allocations(), 0u);
  EXPECT_NEAR(fibres().length_ratio_mean, 1.25f, 0.005f);
  for (std::size_t f = 0; f < bundle_->count; ++f)
    EXPECT_NEAR(fibres().length[f], 1.25f * bundle_->rest_length[f], 0.002f);
}

}  // namespace
}  // namespace fascicle::muscle
