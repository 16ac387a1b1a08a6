#include "engine/geometry/winding_number.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/parallel/for_range.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kFieldError = 5e-3;  // what the header promises

// The greatest difference between the field and the exact sum at points in a cube.
double worst_error(const TriangleMesh& mesh, float half_side, std::uint32_t seed) {
  const WindingField field(mesh);
  test::Numbers numbers(seed);
  double worst = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 p = numbers.point(-half_side, half_side);
    worst = std::max(worst, std::abs(field.at(p) - winding_number(mesh, p)));
  }
  return worst;
}

TEST(WindingNumber, OfNothingIsZero) {
  EXPECT_EQ(winding_number({}, glm::dvec3(0.0)), 0.0);
  EXPECT_EQ(WindingField({}).at(glm::dvec3(0.0)), 0.0);
}

TEST(WindingNumber, WhatIsNotFiniteDoesNotCount) {
  TriangleMesh mesh = test::make_box({-1, -1, -1}, {1, 1, 1});
  const WindingField box(mesh);
  EXPECT_EQ(winding_number(mesh, glm::dvec3(kNan, 0, 0)), 0.0);
  EXPECT_EQ(box.at(glm::dvec3(0, kNan, 0)), 0.0);
  EXPECT_EQ(box.at(glm::dvec3(0, 0, std::numeric_limits<double>::infinity())), 0.0);
  // The two triangles of +x that hang on corner 7 go, and one of +y, and one of +z.
  mesh.positions[7] = {1, kNan, 1};
  const double exact = winding_number(mesh, glm::dvec3(0.0));
  EXPECT_GT(exact, 0.4);
  EXPECT_LT(exact, 0.9);
  EXPECT_NEAR(WindingField(mesh).at(glm::dvec3(0.0)), exact, 1e-12);
}

TEST(WindingNumber, DegenerateTrianglesDoNotCount) {
  TriangleMesh mesh = test::make_box({-1, -1, -1}, {1, 1, 1});
  for (std::uint32_t i = 0; i < 8; ++i) mesh.indices.insert(mesh.indices.end(), {i, i, (i + 1) % 8, i, i, i});
  test::Numbers numbers(3);
  const WindingField field(mesh);
  for (int i = 0; i < 200; ++i) {
    const glm::vec3 p = numbers.point(-0.99f, 0.99f);
    EXPECT_NEAR(winding_number(mesh, p), 1.0, 1e-12);
    EXPECT_NEAR(field.at(p), 1.0, kFieldError);
  }
  const WindingField points(TriangleMesh{"", {{1, 1, 1}}, {}, {0, 0, 0}});
  EXPECT_EQ(points.at(glm::dvec3(1, 1, 1)), 0.0);
  EXPECT_EQ(points.at(glm::dvec3(0, 0, 0)), 0.0);
  const WindingField origin(TriangleMesh{"", {{0, 0, 0}}, {}, {0, 0, 0}});
  for (const double x : {1e-300, 1e-150, 1e-110, 1e-20}) EXPECT_EQ(origin.at(glm::dvec3(x, 0, 0)), 0.0);
}

TEST(WindingNumber, OneInsideNoneOutside) {
  const TriangleMesh box = test::make_box({-1, -1, -1}, {1, 1, 1});
  EXPECT_NEAR(winding_number(box, {0.3, -0.2, 0.9}), 1.0, 1e-12);
  EXPECT_NEAR(winding_number(box, {1.001, 0, 0}), 0.0, 1e-12);
  EXPECT_NEAR(winding_number(box, {0.25, 0.5, 1.0}), 0.5, 1e-12);  // in a face
  EXPECT_NEAR(winding_number(test::inside_out(box), {0, 0, 0}), -1.0, 1e-12);
  EXPECT_FALSE(WindingField(test::inside_out(box)).inside({0, 0, 0}));
}

TEST(WindingNumber, ShellsThatOverlapAdd) {
  const TriangleMesh two = test::join(test::make_box({-1, -1, -1}, {1, 1, 1}), test::make_box({0, 0, 0}, {2, 2, 2}));
  EXPECT_NEAR(winding_number(two, {0.5, 0.5, 0.5}), 2.0, 1e-12);
  EXPECT_NEAR(winding_number(two, {-0.5, 0.5, 0.5}), 1.0, 1e-12);
}

TEST(WindingNumber, AHoleTakesItsSolidAngle) {
  TriangleMesh open = test::make_box({-1, -1, -1}, {1, 1, 1});
  open.indices.resize(30);  // without +x
  EXPECT_NEAR(winding_number(open, {0, 0, 0}), 5.0 / 6.0, 1e-12);
  EXPECT_NEAR(winding_number(open, {1.0, 0, 0}), 0.5, 1e-12);  // in the hole's mouth
  EXPECT_TRUE(WindingField(open).inside({0.9, 0, 0}));
  EXPECT_FALSE(WindingField(open).inside({1.1, 0, 0}));
}

TEST(WindingField, AgreesWithTheSum) {
  EXPECT_LT(worst_error(test::make_sphere(1.0f, 40, 60), 1.2f, 1), kFieldError);
  EXPECT_LT(worst_error(test::make_torus(1.0f, 0.3f, 90, 40), 1.5f, 2), kFieldError);
  EXPECT_LT(worst_error(test::make_box({-1, -1, -1}, {1, 1, 1}), 1.2f, 3), kFieldError);
  TriangleMesh cup = test::make_sphere(1.0f, 40, 60);
  cup.indices.resize(cup.indices.size() / 2);
  EXPECT_LT(worst_error(cup, 1.5f, 4), kFieldError);
  EXPECT_LT(worst_error(test::inside_out(test::make_torus(1.0f, 0.3f, 90, 40)), 1.5f, 5), kFieldError);
}

TEST(WindingField, DecidesAHolesMouthAsTheSumDoes) {
  TriangleMesh cup = test::make_sphere(1.0f, 60, 80);
  cup.indices.resize(cup.indices.size() / 2);
  const WindingField field(cup);
  test::Numbers numbers(6);
  int close = 0;
  for (int i = 0; i < 3000; ++i) {
    glm::dvec3 p = numbers.point(-0.5f, 0.5f);
    p.y *= 0.02;
    const double exact = winding_number(cup, p);
    close += std::abs(exact - 0.5) < kFieldError ? 1 : 0;
    EXPECT_EQ(field.inside(p), exact > 0.5);
  }
  EXPECT_GT(close, 100);
}

TEST(WindingField, DecidesCloseToTheSurface) {
  const TriangleMesh mesh = test::make_torus(1.0f, 0.3f, 90, 40);
  const WindingField field(mesh);
  int asked = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                     c = mesh.positions[mesh.indices[i + 2]];
    const glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a)), middle = (a + b + c) / 3.0;
    EXPECT_TRUE(field.inside(middle - 1e-5 * n));
    EXPECT_FALSE(field.inside(middle + 1e-5 * n));
    ++asked;
  }
  EXPECT_EQ(asked, 7200);
}

TEST(WindingField, OfAnySoupIsFinite) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    TriangleMesh mesh = test::make_soup(50, seed);
    const float huge = seed % 2 == 0 ? 1e30f : 1e-30f;
    if (seed >= 10) {
      for (glm::vec3& p : mesh.positions) p *= huge;
    }
    const WindingField field(mesh);
    test::Numbers numbers(seed);
    for (int i = 0; i < 50; ++i) {
      EXPECT_TRUE(std::isfinite(field.at(numbers.point(-2, 2))));
      EXPECT_TRUE(std::isfinite(field.at(mesh.positions[static_cast<std::size_t>(i) % mesh.positions.size()])));
    }
  }
}

TEST(WindingField, AnswersManyThreads) {
  const WindingField field(test::make_torus(1.0f, 0.3f, 60, 30));
  std::vector<glm::vec3> points(4000);
  test::Numbers numbers(9);
  for (glm::vec3& p : points) p = numbers.point(-1.5f, 1.5f);
  std::vector<double> together(points.size());
  parallel::for_range(points.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) together[i] = field.at(points[i]);
  });
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(together[i], field.at(points[i]));
}

}  // namespace
}  // namespace fascicle
