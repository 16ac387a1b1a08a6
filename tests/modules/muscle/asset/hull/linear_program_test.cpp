#include "modules/muscle/asset/hull/linear_program.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

using glm::dvec3;

constexpr double kSlack = 1.0e-12;

double worst_lack(const std::vector<HalfSpace>& half_spaces, const dvec3& point) {
  double worst = 0.0;
  for (const HalfSpace& one : half_spaces) worst = std::max(worst, one.offset - glm::dot(one.normal, point));
  return worst;
}

// The places where up to three of the planes are nearest to `target`: one of them is the answer.
std::vector<dvec3> places(const std::vector<HalfSpace>& planes, const dvec3& target) {
  std::vector<dvec3> all{target};
  const auto add = [&](std::vector<HalfSpace> some) {
    // By elimination with normals made orthogonal: each step moves within the planes before.
    dvec3 place = target;
    std::vector<dvec3> fixed;
    for (const HalfSpace& one : some) {
      dvec3 along = one.normal;
      for (const dvec3& other : fixed) along -= other * glm::dot(along, other);
      const double length = glm::length(along);
      if (length < 1e-6) return;
      along /= length;
      place += along * ((one.offset - glm::dot(one.normal, place)) / glm::dot(along, one.normal));
      fixed.push_back(along);
    }
    all.push_back(place);
  };
  for (std::size_t i = 0; i < planes.size(); ++i) {
    add({planes[i]});
    for (std::size_t j = 0; j < i; ++j) {
      add({planes[i], planes[j]});
      for (std::size_t k = 0; k < j; ++k) add({planes[i], planes[j], planes[k]});
    }
  }
  return all;
}

dvec3 direction(test::Numbers& numbers) {
  for (;;) {
    const dvec3 point(numbers.point(-1.0f, 1.0f));
    if (glm::length(point) > 0.1 && glm::length(point) < 1.0) return glm::normalize(point);
  }
}

TEST(LinearProgram, HasNoSolutionWhereHalfSpacesContradict) {
  const std::vector<HalfSpace> opposed{{{1, 0, 0}, 1.0}, {{-1, 0, 0}, 0.0}};
  EXPECT_FALSE(nearest_point(opposed, dvec3(0.0), kSlack));
  EXPECT_FALSE(nearest_point(opposed, dvec3(5.0), kSlack));
  // Three walls round a shaft that is inside out, and nothing of it parallel.
  std::vector<HalfSpace> shaft;
  for (int i = 0; i < 3; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / 3.0;
    shaft.push_back({{std::cos(turn), std::sin(turn), 0.0}, 0.1});
  }
  EXPECT_FALSE(nearest_point(shaft, dvec3(0.0), kSlack));
  EXPECT_FALSE(solve_linear_program({0, 0, 1}, shaft, 10.0, kSlack));
  // A pyramid inside out, with no three planes alike.
  shaft.clear();
  for (const dvec3& normal : {dvec3(1, 1, 1), dvec3(1, -1, -1), dvec3(-1, 1, -1), dvec3(-1, -1, 1)}) {
    shaft.push_back({glm::normalize(normal), 0.01});
  }
  EXPECT_FALSE(nearest_point(shaft, dvec3(0.3, 0.2, 0.1), kSlack));
}

TEST(LinearProgram, NothingInTheWayLeavesTheTarget) {
  EXPECT_EQ(nearest_point({}, dvec3(1, 2, 3), kSlack), dvec3(1, 2, 3));
  EXPECT_EQ(solve_linear_program({0, 0, 1}, {}, 10.0, kSlack), dvec3(0, 0, -10));
}

TEST(LinearProgram, CornerIsFound) {
  std::vector<HalfSpace> corner{{{1, 0, 0}, 1.0}, {{0, 1, 0}, 2.0}, {{0, 0, 1}, 3.0}};
  const dvec3 cost = glm::normalize(dvec3(1, 2, 1));
  do {
    const auto found = solve_linear_program(cost, corner, 50.0, kSlack);
    ASSERT_TRUE(found);
    EXPECT_LT(glm::distance(*found, dvec3(1, 2, 3)), 1e-12);
  } while (std::ranges::next_permutation(corner, {}, [](const HalfSpace& one) { return one.offset; }).found);
}

TEST(LinearProgram, TiesGoToTheOrigin) {
  // A level floor, twice the same, and a lower one.
  const std::vector<HalfSpace> floor{{{0, 0, 1}, 1.0}, {{0, 0, 1}, 2.0}, {{0, 0, 1}, 2.0}};
  EXPECT_EQ(solve_linear_program({0, 0, 1}, floor, 50.0, kSlack), dvec3(0, 0, 2));
  // A roof: its ridge is level, and the origin stands under its middle.
  const double half = std::sqrt(0.5);
  const std::vector<HalfSpace> roof{{{half, 0, half}, half}, {{-half, 0, half}, half}};
  const auto found = solve_linear_program({0, 0, 1}, roof, 50.0, kSlack);
  ASSERT_TRUE(found);
  EXPECT_LT(glm::distance(*found, dvec3(0, 0, 1)), 1e-12);
}

TEST(LinearProgram, NearlyEqualPlanesAreNoTrouble) {
  test::Numbers numbers(3);
  for (int round = 0; round < 200; ++round) {
    // As of a flat star in single precision: all through the origin's surroundings, normals apart by 1e-8 or so.
    const dvec3 up = direction(numbers);
    const double apart = std::pow(10.0, -4.0 - 9.0 * static_cast<double>(numbers.next()));
    std::vector<HalfSpace> planes;
    for (int i = 0; i < 12; ++i) {
      planes.push_back({glm::normalize(up + apart * direction(numbers)), apart * static_cast<double>(numbers.next())});
    }
    const auto found = solve_linear_program(up, planes, 50.0, 1e-9);
    ASSERT_TRUE(found) << apart;
    EXPECT_LE(worst_lack(planes, *found), 1e-9 + 1e-12) << apart;
    EXPECT_LT(std::abs(glm::dot(up, *found)), 60.0 * apart + 1e-9) << apart;
  }
}

TEST(LinearProgram, AgreesWithAllTriplesOfPlanes) {
  test::Numbers numbers(1);
  int infeasible = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<HalfSpace> planes;
    const int count = 1 + round % 14;
    for (int i = 0; i < count; ++i) planes.push_back({direction(numbers), static_cast<double>(numbers.next()) - 0.7});
    const dvec3 target = 3.0 * direction(numbers);
    double nearest = std::numeric_limits<double>::infinity();
    for (const dvec3& place : places(planes, target)) {
      if (worst_lack(planes, place) < 1e-9) nearest = std::min(nearest, glm::distance(place, target));
    }
    const auto found = nearest_point(planes, target, kSlack);
    ASSERT_EQ(found.has_value(), std::isfinite(nearest)) << round;
    if (!found) {
      ++infeasible;
      continue;
    }
    EXPECT_LE(worst_lack(planes, *found), 1e-10) << round;
    EXPECT_NEAR(glm::distance(*found, target), nearest, 1e-8) << round;
  }
  EXPECT_GT(infeasible, 5);
  EXPECT_LT(infeasible, 200);
}

TEST(LinearProgram, LeastCostIsThatOfTheBestCorner) {
  test::Numbers numbers(2);
  for (int round = 0; round < 200; ++round) {
    // Planes that touch a unit sphere from above, seen from where they look like the star of an edge.
    std::vector<HalfSpace> planes;
    dvec3 cost(0.0);
    for (int i = 0; i < 10; ++i) {
      dvec3 normal = direction(numbers);
      normal.z = std::abs(normal.z) + 0.2;
      normal = glm::normalize(normal);
      planes.push_back({normal, 1.0});
      cost += normal * (0.1 + static_cast<double>(numbers.next()));
    }
    cost = glm::normalize(cost);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < planes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        for (std::size_t k = 0; k < j; ++k) {
          const dvec3 &a = planes[i].normal, &b = planes[j].normal, &c = planes[k].normal;
          const double volume = glm::dot(a, glm::cross(b, c));
          if (std::abs(volume) < 1e-9) continue;
          const dvec3 place = (glm::cross(b, c) + glm::cross(c, a) + glm::cross(a, b)) / volume;
          if (worst_lack(planes, place) < 1e-9) least = std::min(least, glm::dot(cost, place));
        }
      }
    }
    ASSERT_TRUE(std::isfinite(least));
    const auto found = solve_linear_program(cost, planes, 1e5, 1e-10);
    ASSERT_TRUE(found);
    EXPECT_NEAR(glm::dot(cost, *found), least, 1e-6) << round;
  }
}

}  // namespace
}  // namespace fascicle::muscle
