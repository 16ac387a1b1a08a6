#include "modules/muscle/asset/fit/unfold_sections.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "modules/muscle/asset/fit/section_rays.hpp"

namespace fascicle::muscle {
namespace {

// Sections round a bend of radius 1 m, about the z axis; u points away from it.
std::vector<SectionFrame> bend(std::size_t count, double step) {
  std::vector<SectionFrame> frames;
  for (std::size_t k = 0; k < count; ++k) {
    const double a = step * static_cast<double>(k);
    const glm::dvec3 u(std::cos(a), std::sin(a), 0.0), t(-std::sin(a), std::cos(a), 0.0);
    frames.push_back({.centre = u, .tangent = t, .u = u, .v = glm::cross(t, u)});
  }
  return frames;
}

TEST(UnfoldSections, AStraightLineStays) {
  std::vector<SectionFrame> frames(3);
  for (std::size_t k = 0; k < 3; ++k) frames[k] = {{0, 0, double(k)}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  std::vector<double> radii(3 * 6, 100.0);
  unfold_sections(frames, ray_directions(6), radii);
  EXPECT_EQ(radii, std::vector<double>(3 * 6, 100.0));
}

TEST(UnfoldSections, InsideABendRadiiEndAtItsMiddle) {
  std::vector<double> radii(5 * 4, 3.0);
  unfold_sections(bend(5, 0.2), ray_directions(4), radii);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(radii[4 * k], 3.0) << k;           // outward
    EXPECT_EQ(radii[4 * k + 1], 3.0) << k;       // along the bend's axis
    EXPECT_NEAR(radii[4 * k + 2], 1.0, 1e-12) << k;  // all planes meet in the axis
    EXPECT_EQ(radii[4 * k + 3], 3.0) << k;
  }
}

TEST(UnfoldSections, WhatDoesNotReachTheNextPlaneStays) {
  std::vector<double> radii(5 * 4, 0.9);
  const std::vector<double> before = radii;
  unfold_sections(bend(5, 0.2), ray_directions(4), radii);
  EXPECT_EQ(radii, before);
}

TEST(UnfoldSections, NegativeRadiiStay) {
  std::vector<double> radii(5 * 4, -3.0);
  unfold_sections(bend(5, 0.2), ray_directions(4), radii);
  EXPECT_EQ(radii, std::vector<double>(5 * 4, -3.0));
}

}  // namespace
}  // namespace fascicle::muscle
