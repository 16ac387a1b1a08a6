// Whole muscles: all instruction sets give the same bits, the plain code agrees, what is at rest stays at rest, spare
// lanes leave no trace. What single constraints must do is in the other files.
#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "engine/content/vtk_reader.hpp"
#include "modules/muscle/kernels/surface/surface_reference.hpp"
#include "tests/modules/muscle/kernels/surface/kernel_levels.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::muscle {
namespace {

using test::place;
using test::same_bits;

// What a substep works on, away from rest, with some points held.
struct Muscle {
  explicit Muscle(TriangleMesh mesh) {
    SurfaceMuscleDescription description;
    description.name = "muscle";
    description.mesh = std::move(mesh);
    SurfaceAttachment held;
    held.bone = 0;
    for (std::uint32_t v = 0; v < description.mesh.positions.size(); v += 17) held.vertices.push_back(v);
    description.attachments.push_back(held);
    auto built = build_surface_asset(description, 1);
    EXPECT_TRUE(built.ok()) << to_text(built.diagnostics());
    asset = *built;
    points = asset->rest;
    before = points;
    velocity.resize(points.size());
    gradient.resize(asset->vertex_count);
    const float size = 0.05f * asset->mean_edge;
    for (std::uint32_t v = 0; v < asset->vertex_count; ++v) {
      const float a = static_cast<float>(v);
      velocity[v] = {std::sin(a), std::cos(2.0f * a), std::sin(3.0f * a + 1.0f), 0.0f};
      anchors.push_back({points[v].x + size, points[v].y, points[v].z - size, 0.0f});
      const float share = 0.5f + 0.5f * std::sin(0.01f * a);
      const auto one = static_cast<std::uint16_t>(v % 3), other = static_cast<std::uint16_t>((v + 1) % 3);
      carry.push_back({{one, other, 0, 0}, {share, 1.0f - share, 0.0f, 0.0f}});
      if (points[v].inverse_mass == 0.0f) continue;
      points[v].x += size * std::sin(7.0f * a);
      points[v].y += size * std::cos(5.0f * a);
      points[v].z += size * std::sin(3.0f * a);
    }
    for (int i = 0; i < 36; ++i) moved.push_back(0.002f * std::sin(1.0f + static_cast<float>(i)));
  }

  HingeJob hinges() { return {.packs = asset->packs, .points = points, .inverse_h2 = 1.0e5f}; }
  VolumeJob volume() {
    return {.triangles = asset->triangles,
            .vertex_count = asset->vertex_count,
            .points = points,
            .gradient = gradient,
            .rest = asset->kernel_volume,
            .compliance = 0.0f,
            .rings = &asset->rings};
  }
  PredictJob prediction() {
    return {.carry = carry,
            .moved = moved,
            .vertex_count = asset->vertex_count,
            .points = points,
            .before = before,
            .velocity = velocity,
            .h = 0.003f,
            .keep = 0.9f,
            .anchors = anchors,
            .pull = 0.3f};
  }
  CarryJob carriage() {
    return {.carry = carry, .moved = moved, .vertex_count = asset->vertex_count, .rest = asset->rest, .out = before};
  }
  ViscosityJob viscosity() {
    return {.packs = asset->packs, .points = points, .velocity = velocity, .share = 0.6f};
  }

  std::shared_ptr<const SurfaceAsset> asset;
  AlignedVector<SurfacePoint> points, before, velocity, gradient, anchors;
  std::vector<CarryWeights> carry;
  std::vector<float> moved;
};

// 37 segments: vertices that are no multiple of four.
Muscle sphere() { return Muscle(fascicle::test::make_sphere(0.03f, 20, 37, {0.1f, 0.2f, -0.1f})); }

struct Kernel {
  const char* name;
  std::function<void(const SurfaceKernels&, Muscle&)> run;
};
const Kernel kKernels[] = {
    {"project_hinges", [](const SurfaceKernels& k, Muscle& m) { k.project_hinges(m.hinges()); }},
    {"project_volume", [](const SurfaceKernels& k, Muscle& m) { k.project_volume(m.volume()); }},
    {"carry", [](const SurfaceKernels& k, Muscle& m) { k.carry(m.carriage()); }},
    {"predict", [](const SurfaceKernels& k, Muscle& m) { k.predict(m.prediction()); }},
    {"take_velocities", [](const SurfaceKernels& k, Muscle& m) { k.take_velocities(m.prediction()); }},
    {"fade_differences", [](const SurfaceKernels& k, Muscle& m) { k.fade_differences(m.viscosity()); }},
};

void expect_same_bits(const Muscle& start) {
  for (const Kernel& kernel : kKernels) {
    Muscle first = start;
    kernel.run(surface_kernels(SimdLevel::kPortable), first);
    for (const SimdLevel level : test::levels()) {
      Muscle other = start;
      kernel.run(surface_kernels(level), other);
      EXPECT_TRUE(same_bits(first.points, other.points)) << kernel.name << " " << to_string(level);
      EXPECT_TRUE(same_bits(first.before, other.before)) << kernel.name << " " << to_string(level);
      EXPECT_TRUE(same_bits(first.velocity, other.velocity)) << kernel.name << " " << to_string(level);
      EXPECT_EQ(surface_kernels(level).measure_volume(other.volume()),
                surface_kernels(SimdLevel::kPortable).measure_volume(first.volume()));
    }
  }
}

double furthest(const AlignedVector<SurfacePoint>& a, const AlignedVector<SurfacePoint>& b) {
  double result = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) result = std::max(result, glm::distance(place(a[i]), place(b[i])));
  return result;
}

void expect_agreement(const Muscle& start) {
  for (const Kernel& kernel : kKernels) {
    Muscle wide = start, plain = start;
    kernel.run(surface_kernels(SimdLevel::kPortable), wide);
    kernel.run(surface_reference_kernels(), plain);
    // It does something, but for rounding and angles to 7e-7 the same.
    const double moved = furthest(plain.points, start.points) + furthest(plain.velocity, start.velocity) +
                         furthest(plain.before, start.before);
    EXPECT_GT(moved, 1.0e-7) << kernel.name;
    EXPECT_LT(furthest(wide.points, plain.points), 1.0e-6) << kernel.name;
    EXPECT_LT(furthest(wide.velocity, plain.velocity), 3.0e-4) << kernel.name;
    for (std::uint32_t v = 0; v < start.asset->vertex_count; ++v) {
      if (start.points[v].inverse_mass == 0.0f) continue;  // nobody asks where held points were
      ASSERT_LT(glm::distance(place(wide.before[v]), place(plain.before[v])), 1.0e-6) << kernel.name << " " << v;
    }
  }
}

TEST(SurfaceKernels, GiveTheSameBitsOnAllInstructionSets) { expect_same_bits(sphere()); }
TEST(SurfaceKernels, AgreeWithThePlainCode) { expect_agreement(sphere()); }

// One carrier that moves has a way of its own.
TEST(SurfaceKernels, DoSoWhereOnlyOneCarrierMoves) {
  for (std::size_t mover = 0; mover < 3; ++mover) {
    Muscle muscle = sphere();
    for (std::size_t i = 0; i < muscle.moved.size(); ++i) muscle.moved[i] *= i / 12 == mover ? 1.0f : 0.0f;
    expect_same_bits(muscle);
    expect_agreement(muscle);
  }
}

TEST(SurfaceKernels, OnARealMuscle) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/iliacus.vtk");
  auto mesh = read_vtk(fascicle::test::data_folder() / "pbd/iliacus.vtk");
  ASSERT_TRUE(mesh.ok());
  for (glm::vec3& p : mesh->positions) p *= 1.0e-3f;
  const Muscle iliacus(*mesh);
  expect_same_bits(iliacus);
  expect_agreement(iliacus);
}

TEST(SurfaceKernels, WhatIsAtRestStaysBitForBit) {
  for (const SimdLevel level : test::levels()) {
    const SurfaceKernels& kernels = surface_kernels(level);
    Muscle muscle = sphere();
    muscle.points = muscle.asset->rest;
    std::fill(muscle.velocity.begin(), muscle.velocity.end(), SurfacePoint{});
    std::fill(muscle.moved.begin(), muscle.moved.end(), 0.0f);
    PredictJob prediction = muscle.prediction();
    prediction.pull = 0.0f;
    for (int i = 0; i < 100; ++i) {
      kernels.predict(prediction);
      kernels.project_hinges(muscle.hinges());
      EXPECT_EQ(kernels.project_volume(muscle.volume()), muscle.asset->kernel_volume);
      kernels.take_velocities(prediction);
      kernels.fade_differences(muscle.viscosity());
    }
    EXPECT_TRUE(same_bits(muscle.points, muscle.asset->rest));
    for (const SurfacePoint& v : muscle.velocity) ASSERT_EQ(place(v), glm::dvec3(0.0));
  }
}

TEST(SurfaceKernels, SpareLanesAndMassesStayAsTheyAre) {
  for (const SimdLevel level : test::levels()) {
    for (const Kernel& kernel : kKernels) {
      const Muscle start = sphere();
      Muscle muscle = start;
      kernel.run(surface_kernels(level), muscle);
      for (std::size_t i = 0; i < start.points.size(); ++i) {
        ASSERT_EQ(muscle.points[i].inverse_mass, start.points[i].inverse_mass) << kernel.name;
        if (start.points[i].inverse_mass > 0.0f) continue;
        ASSERT_EQ(place(muscle.points[i]), place(start.points[i])) << kernel.name << " " << i;
      }
    }
  }
}

TEST(SurfaceKernels, VelocitiesAreWhatMovedPointsBesideTheirCarriers) {
  for (const SimdLevel level : test::levels()) {
    Muscle muscle = sphere();
    const AlignedVector<SurfacePoint> velocity = muscle.velocity;
    PredictJob prediction = muscle.prediction();
    prediction.pull = 0.0f;
    surface_kernels(level).predict(prediction);
    surface_kernels(level).take_velocities(prediction);
    for (std::uint32_t v = 0; v < muscle.asset->vertex_count; ++v) {
      const bool held = muscle.points[v].inverse_mass == 0.0f;
      const glm::dvec3 expected = held ? glm::dvec3(0.0) : 0.9 * place(velocity[v]);
      ASSERT_LT(glm::distance(place(muscle.velocity[v]), expected), 3.0e-5) << v;
      ASSERT_EQ(muscle.velocity[v].inverse_mass, 0.0f);
    }
  }
}

// A carrier that only shifts takes every vertex by its weight.
TEST(SurfaceKernels, CarriersTakePointsByWeight) {
  for (const SimdLevel level : test::levels()) {
    Muscle muscle = sphere();
    std::fill(muscle.moved.begin(), muscle.moved.end(), 0.0f);
    muscle.moved[12 + 3] = 0.01f;  // the second one, along x
    surface_kernels(level).carry(muscle.carriage());
    for (std::uint32_t v = 0; v < muscle.asset->vertex_count; ++v) {
      const CarryWeights& carry = muscle.carry[v];
      const float weight = carry.carrier[0] == 1 ? carry.weight[0] : carry.carrier[1] == 1 ? carry.weight[1] : 0.0f;
      const glm::dvec3 shift(0.01 * static_cast<double>(weight), 0.0, 0.0);
      ASSERT_LT(glm::distance(place(muscle.before[v]), place(muscle.asset->rest[v]) + shift), 3.0e-8) << v;
    }
  }
}

TEST(SurfaceKernels, ViscosityKeepsMomentumAndCalms) {
  for (const SimdLevel level : test::levels()) {
    Muscle muscle = sphere();
    for (std::uint32_t v = 0; v < muscle.asset->vertex_count; ++v) {
      muscle.points[v].inverse_mass = 1.0f + static_cast<float>(v % 5);
    }
    const auto sums = [&] {
      glm::dvec3 momentum(0.0);
      double energy = 0.0;
      for (std::uint32_t v = 0; v < muscle.asset->vertex_count; ++v) {
        const double mass = 1.0 / static_cast<double>(muscle.points[v].inverse_mass);
        momentum += mass * place(muscle.velocity[v]);
        energy += mass * glm::dot(place(muscle.velocity[v]), place(muscle.velocity[v]));
      }
      return std::pair(momentum, energy);
    };
    const auto [momentum, energy] = sums();
    surface_kernels(level).fade_differences(muscle.viscosity());
    const auto [momentum_after, energy_after] = sums();
    EXPECT_LT(glm::distance(momentum, momentum_after), 1.0e-3);
    EXPECT_LT(energy_after, 0.5 * energy);
  }
}

}  // namespace
}  // namespace fascicle::muscle
