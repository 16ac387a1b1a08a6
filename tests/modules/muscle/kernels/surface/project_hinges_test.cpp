// Single hinges with known answers, on every instruction set.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "modules/muscle/asset/surface/pack_hinges.hpp"
#include "tests/modules/muscle/kernels/surface/kernel_levels.hpp"

namespace fascicle::muscle {
namespace {

using test::place;

constexpr float kNever = std::numeric_limits<float>::infinity();  // a compliance that drops the constraint
constexpr std::size_t kLane = 9;                                  // where the hinge is; the others are spare

using Places = std::array<glm::dvec3, 4>;

// Two triangles over an edge of 2 mm along x, folded by `angle`; generic beside that.
Places folded(double angle) {
  return {{{0.0, 0.0, 0.0},
           {2.0e-3, 0.0, 0.0},
           {0.7e-3, 1.5e-3, 0.0},
           {1.1e-3, -1.2e-3 * std::cos(angle), -1.2e-3 * std::sin(angle)}}};
}

struct OneHinge {
  OneHinge(const Places& places, const std::array<float, 4>& masses) {
    for (std::size_t i = 0; i < 4; ++i) {
      const glm::vec3 p(places[i]);
      points.push_back({p.x, p.y, p.z, masses[i]});
    }
    add_padding(points);
    for (std::size_t lane = 0; lane < kHingeLanes; ++lane) {
      for (std::size_t i = 0; i < 4; ++i) {
        pack.vertex[i][lane] = static_cast<std::int32_t>(lane == kLane ? i : 4 + 4 * lane + i);
      }
      pack.length[lane] = 1.0e-3f;
      pack.stretch_compliance[lane] = kNever;
      pack.angle[lane] = 0.0f;
      pack.bend_compliance[lane] = kNever;
    }
  }

  float measured_length(SimdLevel level) const { return measure(level)[0]; }
  float measured_angle(SimdLevel level) const { return measure(level)[1]; }

  std::array<float, 2> measure(SimdLevel level) const {
    std::array<float, kHingeLanes> lengths{}, angles{};
    surface_kernels(level).measure_hinges(std::span(&pack, 1), points, lengths, angles);
    return {lengths[kLane], angles[kLane]};
  }

  // The places after a pass; padding must be as it was.
  AlignedVector<SurfacePoint> project(SimdLevel level, float inverse_h2 = 1.0e5f) const {
    AlignedVector<SurfacePoint> moved = points;
    surface_kernels(level).project_hinges({.packs = std::span(&pack, 1), .points = moved, .inverse_h2 = inverse_h2});
    for (std::size_t i = 4; i < moved.size(); ++i) EXPECT_EQ(place(moved[i]), place(points[i]));
    return moved;
  }

  HingePack pack{};
  AlignedVector<SurfacePoint> points;
};

// The header's formula, as it stands there.
double angle_of(const Places& p) {
  const glm::dvec3 e = p[1] - p[0], n1 = glm::cross(e, p[2] - p[0]), n2 = glm::cross(p[3] - p[0], e);
  return std::atan2(glm::dot(glm::cross(n1, n2), e) / glm::length(e), glm::dot(n1, n2));
}

Places gradient_of(const Places& places) {
  constexpr double kStep = 1.0e-9;
  Places gradient;
  for (std::size_t i = 0; i < 4; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      Places up = places, down = places;
      up[i][axis] += kStep;
      down[i][axis] -= kStep;
      gradient[i][axis] = (angle_of(up) - angle_of(down)) / (2.0 * kStep);
    }
  }
  return gradient;
}

TEST(SurfaceHinge, StretchedEdgeComesBackAtOnce) {
  for (const SimdLevel level : test::levels()) {
    OneHinge hinge(folded(0.3), {1.0f, 3.0f, 1.0f, 1.0f});
    hinge.pack.stretch_compliance[kLane] = 0.0f;
    const auto moved = hinge.project(level);
    EXPECT_NEAR(moved[0].x, 0.25e-3, 1.0e-9);  // by their inverse masses
    EXPECT_NEAR(moved[1].x, 1.25e-3, 1.0e-9);
    EXPECT_EQ(place(moved[2]), place(hinge.points[2]));
    EXPECT_EQ(place(moved[3]), place(hinge.points[3]));
  }
}

TEST(SurfaceHinge, EdgeGivesWayByItsCompliance) {
  for (const SimdLevel level : test::levels()) {
    OneHinge hinge(folded(0.3), {2.0f, 2.0f, 1.0f, 1.0f});
    hinge.pack.stretch_compliance[kLane] = 1.2e-4f;
    const auto moved = hinge.project(level, 1.0e5f);
    const double lambda = -1.0e-3 / (2.0 + 2.0 + 12.0);
    EXPECT_NEAR(moved[0].x, -2.0 * lambda, 1.0e-9);
    EXPECT_NEAR(moved[1].x, 2.0e-3 + 2.0 * lambda, 1.0e-9);
  }
}

TEST(SurfaceHinge, HeldPointsStay) {
  for (const SimdLevel level : test::levels()) {
    OneHinge held(folded(0.3), {0.0f, 0.0f, 0.0f, 0.0f});
    held.pack.stretch_compliance[kLane] = held.pack.bend_compliance[kLane] = 0.0f;
    EXPECT_TRUE(test::same_bits(held.project(level), held.points));
    OneHinge half(folded(0.3), {0.0f, 1.0f, 0.0f, 0.0f});
    half.pack.stretch_compliance[kLane] = 0.0f;
    const auto moved = half.project(level);
    EXPECT_EQ(place(moved[0]), place(half.points[0]));
    EXPECT_NEAR(moved[1].x, 1.0e-3, 1.0e-9);
  }
}

TEST(SurfaceHinge, AnglesGoAllTheWayRound) {
  for (const SimdLevel level : test::levels()) {
    for (double angle = -3.14; angle < 3.1415; angle += 0.01) {
      const OneHinge hinge(folded(angle), {1.0f, 1.0f, 1.0f, 1.0f});
      ASSERT_NEAR(hinge.measured_angle(level), angle_of(folded(angle)), 3.0e-6) << angle;
      ASSERT_NEAR(std::abs(hinge.measured_angle(level)), std::abs(angle), 3.0e-6) << angle;
      ASSERT_NEAR(hinge.measured_length(level), 2.0e-3f, 1.0e-9f);
    }
  }
}

// With one point free, the step is -g C / |g|^2.
TEST(SurfaceHinge, StepsGoAlongTheAnglesGradient) {
  for (const SimdLevel level : test::levels()) {
    for (const double angle : {-2.5, -0.8, -0.01, 0.0, 0.02, 1.0, 2.9}) {
      const Places places = folded(angle), gradient = gradient_of(places);
      for (std::size_t i = 0; i < 4; ++i) {
        std::array<float, 4> masses{};
        masses[i] = 1.0e4f;
        OneHinge hinge(places, masses);
        hinge.pack.bend_compliance[kLane] = 0.0f;
        const double c = 0.01;
        hinge.pack.angle[kLane] = static_cast<float>(angle_of(places) - c);
        const glm::dvec3 expected = -gradient[i] * c / glm::dot(gradient[i], gradient[i]);
        const glm::dvec3 step = place(hinge.project(level)[i]) - places[i];
        EXPECT_LT(glm::distance(step, expected), 1.0e-3 * glm::length(expected) + 3.0e-10) << angle << " " << i;
      }
    }
  }
}

TEST(SurfaceHinge, AngleIsMetAndMomentaAreKept) {
  for (const SimdLevel level : test::levels()) {
    for (const double angle : {-1.2, 0.1, 0.9}) {
      const std::array<float, 4> masses{1.0e4f, 2.0e4f, 0.5e4f, 3.0e4f};
      OneHinge hinge(folded(angle), masses);
      const float now = hinge.measured_angle(level);
      hinge.pack.bend_compliance[kLane] = 0.0f;
      hinge.pack.angle[kLane] = now - 0.02f;
      OneHinge after = hinge;
      after.points = hinge.project(level);
      EXPECT_NEAR(after.measured_angle(level), now - 0.02f, 1.0e-3f);
      glm::dvec3 linear(0.0), angular(0.0);
      double size = 0.0;
      for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3 change = (place(after.points[i]) - place(hinge.points[i])) / static_cast<double>(masses[i]);
        linear += change;
        angular += glm::cross(place(hinge.points[i]), change);
        size += glm::length(change);
      }
      EXPECT_LT(glm::length(linear), 1.0e-4 * size);
      EXPECT_LT(glm::length(angular), 1.0e-4 * size * 2.0e-3);
    }
  }
}

// 0.1 rad beyond the half turn is reached by going on, not by going back all the way.
TEST(SurfaceHinge, GoesTheShortWayRound) {
  for (const SimdLevel level : test::levels()) {
    const double angle = std::copysign(std::numbers::pi - 0.05, angle_of(folded(1.0)));
    const Places places = folded(std::numbers::pi - 0.05);
    OneHinge hinge(places, {0.0f, 0.0f, 0.0f, 1.0e4f});
    hinge.pack.bend_compliance[kLane] = 0.0f;
    hinge.pack.angle[kLane] = static_cast<float>(-angle);
    const double step = glm::distance(place(hinge.project(level)[3]), places[3]);
    EXPECT_NEAR(step, 0.1 * 1.2e-3, 1.0e-7);
  }
}

// As the header says: the edge, then the angle of where that leaves the points.
TEST(SurfaceHinge, EdgeComesBeforeAngle) {
  for (const SimdLevel level : test::levels()) {
    OneHinge both(folded(0.4), {1.0e4f, 2.0e4f, 1.5e4f, 1.0e4f}), edge = both, angle = both;
    both.pack.angle[kLane] = angle.pack.angle[kLane] = 0.1f;
    both.pack.length[kLane] = edge.pack.length[kLane] = 2.6e-3f;
    both.pack.stretch_compliance[kLane] = edge.pack.stretch_compliance[kLane] = 0.05f;
    both.pack.bend_compliance[kLane] = angle.pack.bend_compliance[kLane] = 1.0f;
    angle.points = edge.project(level);
    const auto expected = angle.project(level), moved = both.project(level);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(glm::distance(place(moved[i]), place(expected[i])), 1.0e-9) << i;
  }
}

TEST(SurfaceHinge, LeavesHingesWithoutShapeAlone) {
  const glm::dvec3 o(0.0), x(1.0e-3, 0.0, 0.0), y(0.0, 1.0e-3, 0.0), z(0.0, 0.0, 1.0e-3);
  for (const SimdLevel level : test::levels()) {
    for (const Places& places : {Places{o, o, x, y}, Places{o, x, 2.0 * x, y}, Places{o, x, y, x}, Places{o, x, y, o},
                                 Places{x, x, x, x}, Places{o, 1.0e-20 * x, y, z}}) {
      OneHinge hinge(places, {1.0e4f, 1.0e4f, 1.0e4f, 1.0e4f});
      hinge.pack.bend_compliance[kLane] = 0.0f;
      hinge.pack.angle[kLane] = 1.0f;
      EXPECT_TRUE(test::same_bits(hinge.project(level), hinge.points));
      EXPECT_EQ(hinge.measured_angle(level), 0.0f);
      // With stiffness along the edge, too, all stays finite.
      hinge.pack.stretch_compliance[kLane] = 0.0f;
      for (const SurfacePoint& p : hinge.project(level)) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
    }
  }
}

// From a tenth of the finest mesh to a house.
TEST(SurfaceHinge, WorksAtAnySize) {
  for (const SimdLevel level : test::levels()) {
    for (const double scale : {0.01, 0.1, 1.0, 100.0, 5000.0}) {
      Places places = folded(0.5);
      for (glm::dvec3& p : places) p *= scale;
      OneHinge hinge(places, {1.0e4f, 1.0e4f, 1.0e4f, 1.0e4f});
      hinge.pack.bend_compliance[kLane] = 0.0f;
      hinge.pack.angle[kLane] = hinge.measured_angle(level) + 0.01f;
      OneHinge after = hinge;
      after.points = hinge.project(level);
      EXPECT_NEAR(after.measured_angle(level), hinge.pack.angle[kLane], 2.0e-4f) << scale;
    }
  }
}

}  // namespace
}  // namespace fascicle::muscle
