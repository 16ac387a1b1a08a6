// Depths in outlines whose nearest points are known, and in any outline against a search over all its points.
#include "modules/muscle/kernels/collision/section_outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <gtest/gtest.h>

#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kAnywhere = 10.0f;  // m
const glm::vec3 kNoSide(0.0f, 0.0f, 1.0f);  // along the line: no edge looks the same way, all are asked

// Two sections whose outlines are radii over the angle, square to z unless turned.
struct Section {
  std::vector<float> x[2], y[2], z[2];
  OutlineSegment segment;

  using Radius = std::function<float(float)>;
  Section(std::uint32_t count, const Radius& first, const Radius& second, const glm::mat4& to_second) {
    segment.count = count;
    for (int k = 0; k < 2; ++k) {
      const glm::mat4 place = k == 0 ? glm::mat4(1.0f) : to_second;
      segment.a[k] = glm::vec3(place[3]);
      segment.u[k] = glm::vec3(place[0]);
      segment.v[k] = glm::vec3(place[1]);
      for (std::uint32_t i = 0; i < count; ++i) {
        const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(count);
        const glm::vec3 vertex = segment.a[k] + (k == 0 ? first : second)(angle) *
                                                    (std::cos(angle) * segment.u[k] + std::sin(angle) * segment.v[k]);
        x[k].push_back(vertex.x);
        y[k].push_back(vertex.y);
        z[k].push_back(vertex.z);
      }
      segment.x[k] = x[k].data();
      segment.y[k] = y[k].data();
      segment.z[k] = z[k].data();
    }
  }
  glm::vec3 vertex(std::uint32_t i, float along) const {
    i %= segment.count;
    return glm::mix(glm::vec3(x[0][i], y[0][i], z[0][i]), glm::vec3(x[1][i], y[1][i], z[1][i]), along);
  }
};

const glm::mat4 kAhead = glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, 0.05f));

Section straight(std::uint32_t count, const Section::Radius& radius) { return Section(count, radius, radius, kAhead); }

float ellipse(float angle, float a, float b) {
  const float c = std::cos(angle) / a, s = std::sin(angle) / b;
  return 1.0f / std::sqrt(c * c + s * s);
}

// Walks along all edges in small steps, and counts crossings of a ray.
struct Oracle {
  float distance = std::numeric_limits<float>::max();  // unsigned
  bool inside = false;
};
Oracle search(const Section& section, float along, const glm::vec3& point) {
  Oracle oracle;
  const std::uint32_t count = section.segment.count;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 from = section.vertex(i, along), to = section.vertex(i + 1, along), p = point;
    for (int k = 0; k <= 400; ++k) {
      const glm::dvec3 q = glm::mix(from, to, k / 400.0);
      oracle.distance = std::min(oracle.distance, static_cast<float>(std::hypot(q.x - p.x, q.y - p.y)));
    }
    if ((from.y > p.y) != (to.y > p.y)) {
      const double crossing = from.x + (p.y - from.y) / (to.y - from.y) * (to.x - from.x);
      if (crossing > p.x) oracle.inside = !oracle.inside;
    }
  }
  return oracle;
}

TEST(SectionOutline, NothingIsInsideCollapsedOutlinesAndNothingFoundWithoutNumbers) {
  OutlinePoint found;
  const Section point = straight(8, [](float) { return 0.0f; });
  if (find_outline_point(point.segment, 0.5f, {0.001f, 0, 0.025f}, kNoSide, kAnywhere, found)) {
    EXPECT_NEAR(found.distance, 0.001f, 1.0e-6f);
    EXPECT_NEAR(found.normal.x, 1.0f, 1.0e-5f);
  }
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Section broken = straight(8, [&](float) { return nan; });
  EXPECT_FALSE(find_outline_point(broken.segment, 0.5f, {0.001f, 0, 0.025f}, kNoSide, kAnywhere, found));
  const Section circle = straight(8, [](float) { return 0.02f; });
  EXPECT_FALSE(find_outline_point(circle.segment, 0.5f, {nan, 0, 0.025f}, kNoSide, kAnywhere, found));
}

TEST(SectionOutline, CircleIsDeepestInItsMiddle) {
  constexpr float kRadius = 0.02f;
  const Section circle = straight(64, [](float) { return kRadius; });
  for (const float r : {0.0f, 0.004f, 0.012f, 0.0195f, 0.0204f, 0.03f}) {
    for (float angle = 0.1f; angle < 6.2f; angle += 0.7f) {
      const glm::vec3 direction(std::cos(angle), std::sin(angle), 0.0f);
      OutlinePoint found;
      ASSERT_TRUE(find_outline_point(circle.segment, 0.3f, r * direction + glm::vec3(0, 0, 0.015f), kNoSide, kAnywhere,
                                     found));
      EXPECT_NEAR(found.distance, r - kRadius, 3.0e-5f) << r;  // the polygon's sagitta
      EXPECT_NEAR(glm::length(found.normal), 1.0f, 1.0e-5f);
      EXPECT_LE(found.edge, 63u);
      EXPECT_GE(found.fraction, 0.0f);
      EXPECT_LE(found.fraction, 1.0f);
      if (r > 0.0f) {
        EXPECT_GT(glm::dot(found.normal, direction), 0.99f) << r;
      }
    }
  }
}

TEST(SectionOutline, FlatStripIsMeasuredToItsNearSide) {
  // 60 mm wide, 6 mm thick: along the radius the way out of this point would be much longer.
  const Section strip = straight(96, [](float angle) { return ellipse(angle, 0.03f, 0.003f); });
  OutlinePoint found;
  ASSERT_TRUE(find_outline_point(strip.segment, 0.5f, {0.010f, 0.001f, 0.025f}, kNoSide, kAnywhere, found));
  EXPECT_NEAR(found.distance, -(0.003f * std::sqrt(1.0f - 1.0f / 9.0f) - 0.001f), 6.0e-5f);
  EXPECT_GT(found.normal.y, 0.99f);
}

TEST(SectionOutline, PointOnTheOutlineHasItsEdgesNormal) {
  const Section square = straight(4, [](float) { return 0.02f; });
  for (const float off : {0.0f, 1.0e-7f, -1.0e-7f}) {
    OutlinePoint found;
    const glm::vec3 normal = glm::normalize(glm::vec3(1, 1, 0));
    ASSERT_TRUE(find_outline_point(square.segment, 0.5f, glm::vec3(0.01f, 0.01f, 0.025f) + off * normal, kNoSide,
                                   kAnywhere, found));
    EXPECT_NEAR(found.distance, 0.0f, 1.0e-6f);
    EXPECT_GT(glm::dot(found.normal, normal), 0.999f);
    EXPECT_EQ(found.edge, 0u);
    EXPECT_NEAR(found.fraction, 0.5f, 1.0e-4f);
  }
  // On a corner: one of the two edges' normals.
  OutlinePoint corner;
  ASSERT_TRUE(find_outline_point(square.segment, 0.5f, {0.02f, 0.0f, 0.025f}, kNoSide, kAnywhere, corner));
  EXPECT_NEAR(corner.distance, 0.0f, 1.0e-6f);
  EXPECT_NEAR(corner.normal.x, std::sqrt(0.5f), 1.0e-3f);
}

TEST(SectionOutline, ReachEndsTheSearchOutsideAndNotInside) {
  const Section circle = straight(32, [](float) { return 0.02f; });
  OutlinePoint found;
  EXPECT_TRUE(find_outline_point(circle.segment, 0.5f, {0.0209f, 0, 0.025f}, kNoSide, 0.001f, found));
  EXPECT_FALSE(find_outline_point(circle.segment, 0.5f, {0.0211f, 0, 0.025f}, kNoSide, 0.001f, found));
  EXPECT_TRUE(find_outline_point(circle.segment, 0.5f, {0.001f, 0, 0.025f}, kNoSide, 0.001f, found));
  EXPECT_LT(found.distance, -0.018f);
}

TEST(SectionOutline, OnlySidesThatFaceTheSurfaceAreAsked) {
  // 6 mm thick. A surface that looks up and has come through from below to 1 mm under the top goes back down, for the
  // top looks its own way.
  const Section strip = straight(96, [](float angle) { return ellipse(angle, 0.03f, 0.003f); });
  OutlinePoint found;
  const glm::vec3 point(0.0f, 0.002f, 0.025f);
  ASSERT_TRUE(find_outline_point(strip.segment, 0.5f, point, {0, 1, 0}, kAnywhere, found));
  EXPECT_NEAR(found.distance, -0.005f, 5.0e-5f);
  EXPECT_LT(found.normal.y, -0.99f);
  ASSERT_TRUE(find_outline_point(strip.segment, 0.5f, point, {0, -1, 0}, kAnywhere, found));
  EXPECT_NEAR(found.distance, -0.001f, 5.0e-5f);
  EXPECT_GT(found.normal.y, 0.99f);
}

TEST(SectionOutline, AnyShapeAgreesWithASearchOverAllItsPoints) {
  test::Numbers numbers(11);
  for (int shape = 0; shape < 24; ++shape) {
    const float lobes = 0.4f * numbers.next(), turn = 6.0f * numbers.next(), flat = 0.4f * numbers.next();
    // Lobed shapes are not convex; every second one's sections differ.
    const auto first = [&](float a) {
      return 0.02f * (1.0f + lobes * std::cos(3.0f * a + turn) + flat * std::cos(2.0f * a));
    };
    const bool same = shape % 2 == 0;
    const auto second = [&](float a) { return same ? first(a) : 0.6f * first(a + 0.3f); };
    const Section section(24, first, second, kAhead);
    for (int i = 0; i < 40; ++i) {
      const float along = numbers.next();
      glm::vec3 point = numbers.point(-0.035f, 0.035f);
      point.z = 0.05f * along;
      const Oracle oracle = search(section, along, point);
      OutlinePoint found;
      ASSERT_TRUE(find_outline_point(section.segment, along, point, kNoSide, kAnywhere, found));
      EXPECT_NEAR(std::abs(found.distance), oracle.distance, 2.0e-6f);
      EXPECT_EQ(found.distance < 0.0f, oracle.inside) << found.distance;
      // The distance along the normal leads to the named point of the outline.
      const glm::vec3 named = glm::mix(section.vertex(found.edge, along), section.vertex(found.edge + 1, along),
                                       found.fraction);
      EXPECT_LT(glm::distance(point - found.distance * found.normal, named), 2.0e-6f);
    }
  }
}

TEST(SectionOutline, SomeNegativeRadiiStillMakeAnOutline) {
  // A centre outside of its own section: radii on its far side are negative.
  const auto shifted = [](float a) {  // a circle of 20 mm about (0.03, 0)
    return 0.03f * std::cos(a) + (std::cos(a) > 0 ? 1.0f : -1.0f) *
                                     std::sqrt(std::max(0.0f, 0.0004f - 0.0009f * std::sin(a) * std::sin(a)));
  };
  const Section section = straight(64, shifted);
  for (const float depth : {0.004f, 0.01f}) {
    const glm::vec3 point(0.05f - depth, 0.0f, 0.025f);
    OutlinePoint found;
    ASSERT_TRUE(find_outline_point(section.segment, 0.5f, point, kNoSide, kAnywhere, found));
    EXPECT_TRUE(std::isfinite(found.distance));
    EXPECT_NEAR(std::abs(found.distance), search(section, 0.5f, point).distance, 2.0e-6f);
  }
}

TEST(SectionOutline, TurnedAndTwistedSectionsAgreeWithTheirOwnPlane) {
  // A rigid motion of everything changes nothing but the normal, which it turns.
  const auto shape = [](float a) { return ellipse(a, 0.03f, 0.012f); };
  const Section plain(32, shape, shape, kAhead);
  const glm::mat4 motion = glm::rotate(glm::translate(glm::mat4(1.0f), {1, -2, 3}), 1.1f,
                                       glm::normalize(glm::vec3(1, 2, -1)));
  Section moved = plain;
  for (int k = 0; k < 2; ++k) {
    for (std::uint32_t i = 0; i < 32; ++i) {
      const glm::vec3 p = motion * glm::vec4(plain.x[k][i], plain.y[k][i], plain.z[k][i], 1.0f);
      moved.x[k][i] = p.x;
      moved.y[k][i] = p.y;
      moved.z[k][i] = p.z;
    }
    moved.segment.a[k] = glm::vec3(motion * glm::vec4(plain.segment.a[k], 1.0f));
    moved.segment.u[k] = glm::mat3(motion) * plain.segment.u[k];
    moved.segment.v[k] = glm::mat3(motion) * plain.segment.v[k];
    moved.segment.x[k] = moved.x[k].data();
    moved.segment.y[k] = moved.y[k].data();
    moved.segment.z[k] = moved.z[k].data();
  }
  test::Numbers numbers(5);
  for (int i = 0; i < 50; ++i) {
    const float along = numbers.next();
    glm::vec3 point = numbers.point(-0.035f, 0.035f);
    point.z = 0.05f * along;
    const glm::vec3 outward = glm::normalize(numbers.point(-1.0f, 1.0f));
    OutlinePoint here, there;
    const bool found = find_outline_point(plain.segment, along, point, outward, kAnywhere, here);
    ASSERT_EQ(find_outline_point(moved.segment, along, glm::vec3(motion * glm::vec4(point, 1.0f)),
                                 glm::mat3(motion) * outward, kAnywhere, there), found);
    if (!found || std::abs(here.distance) < 1.0e-4f) continue;
    EXPECT_NEAR(here.distance, there.distance, 2.0e-6f);
  }
  // Twisted by a quarter turn and half as large: in the middle the outline is the mean of the two.
  const glm::mat4 twisted = glm::rotate(kAhead, 0.5f * std::numbers::pi_v<float>, glm::vec3(0, 0, 1));
  const Section twist(64, [](float) { return 0.02f; }, [](float) { return 0.01f; }, twisted);
  OutlinePoint found;
  ASSERT_TRUE(find_outline_point(twist.segment, 0.5f, {0.0f, 0.0f, 0.025f}, kNoSide, kAnywhere, found));
  // |mean of 20 mm at phi and 10 mm at phi + 90 degrees|
  EXPECT_NEAR(found.distance, -0.5f * std::hypot(0.02f, 0.01f), 3.0e-5f);
}

}  // namespace
}  // namespace fascicle::muscle
