#include "modules/muscle/asset/surface/harmonic_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "engine/content/vtk_reader.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::muscle {
namespace {

std::vector<glm::vec2> make_circle(float radius, std::uint32_t count) {
  std::vector<glm::vec2> points;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

// Fixes the vertices of a wall's first and last ring.
std::vector<std::uint8_t> fix_ends(const TriangleMesh& wall, std::size_t ring) {
  std::vector<std::uint8_t> fixed(wall.positions.size(), 0);
  std::fill_n(fixed.begin(), ring, std::uint8_t{1});
  std::fill_n(fixed.rbegin(), ring, std::uint8_t{1});
  return fixed;
}

TEST(HarmonicField, SaysWhatItCannotSolve) {
  const TriangleMesh box = test::make_box({0, 0, 0}, {1, 1, 1});
  std::vector<std::uint8_t> fixed(8, 0);
  std::vector<float> values(8, 0.0f);
  const auto cause = [&](const TriangleMesh& mesh) {
    const Result<std::vector<float>> field = solve_harmonic(mesh.positions, mesh.indices, fixed, values);
    return field.ok() ? std::string("solved") : field.diagnostics().errors.front().cause;
  };
  EXPECT_EQ(cause(box), "the field is given at no vertex");
  EXPECT_EQ(cause(TriangleMesh{}), "0 vertices, 8 marks and 8 values");
  fixed[0] = 1;
  EXPECT_EQ(cause(box), "solved");
  values.push_back(0.0f);
  EXPECT_EQ(cause(box), "8 vertices, 8 marks and 9 values");
  values.pop_back();
  values[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(cause(box), "the value given at vertex 0 is not finite");
  std::swap(values[0], values[1]);
  EXPECT_EQ(cause(box), "solved") << "a free vertex's value is not read";
  TriangleMesh bad = box;
  bad.positions[3].y = std::numeric_limits<float>::infinity();
  EXPECT_EQ(cause(bad), "vertex 3 is at no finite place");
  bad = box;
  bad.indices[4] = 8;
  EXPECT_EQ(cause(bad), "a triangle has a corner that is none of the 8 vertices");
  bad = test::join(box, test::make_box({2, 0, 0}, {3, 1, 1}));
  fixed.resize(16, 0);
  values.resize(16, 0.0f);
  EXPECT_EQ(cause(bad), "no path of edges joins vertex 8 to one where the field is given");
  fixed[9] = 1;
  EXPECT_EQ(cause(bad), "solved");
}

TEST(HarmonicField, IsLinearAlongATubeWhoseTrianglesHaveNoObtuseAngle) {
  const TriangleMesh tube = test::make_wall(make_circle(1.0f, 24), 0.0f, 3.0f, 12);
  std::vector<float> values(2 * tube.positions.size(), 0.5f);
  std::fill_n(values.begin(), 24, 0.0f);
  std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(tube.positions.size()) - 24, 24, 1.0f);
  for (std::size_t v = 0; v < tube.positions.size(); ++v)
    values[tube.positions.size() + v] = 7.0f - tube.positions[v].z;
  const Result<std::vector<float>> field =
      solve_harmonic(tube.positions, tube.indices, fix_ends(tube, 24), values);
  ASSERT_TRUE(field.ok()) << to_text(field.diagnostics());
  ASSERT_EQ(field->size(), values.size());
  for (std::size_t v = 0; v < tube.positions.size(); ++v) {
    EXPECT_NEAR((*field)[v], tube.positions[v].z / 3.0f, 1e-6f);
    EXPECT_NEAR((*field)[tube.positions.size() + v], 7.0f - tube.positions[v].z, 5e-6f);
  }
}

TEST(HarmonicField, HasNoExtremaOnBadTriangles) {
  // A wall shaken until many of its angles are obtuse and some triangles are needles or have no area.
  TriangleMesh tube = test::make_wall(make_circle(1.0f, 12), 0.0f, 1.0f, 12);
  std::mt19937 random(7);
  for (glm::vec3& p : tube.positions)
    p += 0.2f * glm::vec3(random() % 1000, random() % 1000, random() % 1000) / 1000.0f;
  tube.positions[30] = tube.positions[31];
  tube.positions[60] = 0.5f * (tube.positions[59] + tube.positions[61]);
  std::vector<std::uint8_t> fixed = fix_ends(tube, 12);
  std::vector<float> values(tube.positions.size(), 0.0f);
  for (std::size_t v = 0; v < tube.positions.size(); ++v) values[v] = v < 80 ? -2.0f : 5.0f;
  const Result<std::vector<float>> field = solve_harmonic(tube.positions, tube.indices, fixed, values);
  ASSERT_TRUE(field.ok()) << to_text(field.diagnostics());
  std::vector<float> least(field->size(), 1e9f), most(field->size(), -1e9f);
  for (std::size_t i = 0; i < tube.indices.size(); ++i) {
    for (std::size_t k = i - i % 3; k < i - i % 3 + 3; ++k) {
      if (k == i) continue;
      least[tube.indices[i]] = std::min(least[tube.indices[i]], (*field)[tube.indices[k]]);
      most[tube.indices[i]] = std::max(most[tube.indices[i]], (*field)[tube.indices[k]]);
    }
  }
  for (std::size_t v = 0; v < field->size(); ++v) {
    if (fixed[v]) continue;
    EXPECT_GE((*field)[v], least[v] - 1e-5f) << v;
    EXPECT_LE((*field)[v], most[v] + 1e-5f) << v;
  }
}

TEST(HarmonicField, CrossesARealMuscle) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
  const Result<TriangleMesh> mesh = read_vtk(test::data_folder() / "pbd/gluteus_maximus.vtk");
  ASSERT_TRUE(mesh.ok());
  float bottom = 1e9f, top = -1e9f;
  for (const glm::vec3& p : mesh->positions) {
    bottom = std::min(bottom, p.z);
    top = std::max(top, p.z);
  }
  std::vector<std::uint8_t> fixed(mesh->positions.size(), 0);
  std::vector<float> values(mesh->positions.size(), 0.0f);
  for (std::size_t v = 0; v < fixed.size(); ++v) {
    const float height = (mesh->positions[v].z - bottom) / (top - bottom);
    fixed[v] = height < 0.1f || height > 0.9f;
    values[v] = height > 0.9f ? 1.0f : 0.0f;
  }
  const Result<std::vector<float>> field = solve_harmonic(mesh->positions, mesh->indices, fixed, values);
  ASSERT_TRUE(field.ok()) << to_text(field.diagnostics());
  std::size_t between = 0;
  for (std::size_t v = 0; v < fixed.size(); ++v) {
    ASSERT_GE((*field)[v], 0.0f);
    ASSERT_LE((*field)[v], 1.0f);
    if (!fixed[v]) between += (*field)[v] > 0.0f && (*field)[v] < 1.0f;
  }
  EXPECT_EQ(between, static_cast<std::size_t>(std::ranges::count(fixed, 0)));
}

}  // namespace
}  // namespace fascicle::muscle
