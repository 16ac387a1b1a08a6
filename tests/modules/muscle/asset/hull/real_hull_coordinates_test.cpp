// Coordinates of real muscles in their progressive hulls.
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "engine/content/mesh_reader.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "modules/muscle/asset/hull/progressive_hull.hpp"
#include "tests/modules/muscle/asset/hull/coordinate_rows.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::test {
namespace {

class RealHullCoordinates : public testing::TestWithParam<std::tuple<std::string, std::uint32_t>> {};

TEST_P(RealHullCoordinates, ReproduceTheMeshAndAffineMotions) {
  const auto& [name, count] = GetParam();
  FASCICLE_SKIP_WITHOUT_DATA("pbd/" + name + ".vtk");
  Result<TriangleMesh> mesh = read_mesh((data_folder() / ("pbd/" + name + ".vtk")).string());
  ASSERT_TRUE(mesh) << to_text(mesh.diagnostics());
  for (glm::vec3& p : mesh->positions) p *= 1.0e-3f;
  const Result<muscle::ProgressiveHull> hull = muscle::build_progressive_hull(*mesh, {.vertices = count});
  ASSERT_TRUE(hull) << to_text(hull.diagnostics());
  const double size = static_cast<double>(mesh_bounds(*mesh).diagonal());

  std::vector<glm::vec3> points;  // some lie on the hull, to rounding
  for (std::size_t v = 0; v < mesh->positions.size(); v += 10) points.push_back(mesh->positions[v]);
  const std::vector<float> rows = coordinates(hull->mesh, points);
  EXPECT_LT(missed(rows, hull->mesh, points), 3.0e-7 * size);  // 1e-5 is asked for

  Numbers numbers(1);
  for (int k = 0; k < 5; ++k) {
    glm::dmat4 motion(1.0);
    for (int c = 0; c < 4; ++c) motion[c] += glm::dvec4(glm::dvec3(numbers.point(-1.0f, 1.0f)), 0.0);
    EXPECT_LT(missed(rows, hull->mesh, points, motion), 3.0e-6 * size);  // 1e-4 is asked for
  }
  // What a moved vertex does stays near it: no weight is wild.
  for (const float weight : rows) {
    ASSERT_GT(weight, -0.1f);
    ASSERT_LT(weight, 1.1f);
  }
}

INSTANTIATE_TEST_SUITE_P(Muscles, RealHullCoordinates,
                         testing::Combine(testing::Values("gluteus_maximus", "iliacus"),
                                          testing::Values(100u, 200u, 300u, 500u)),
                         [](const auto& test) {
                           return std::get<0>(test.param) + "_" + std::to_string(std::get<1>(test.param));
                         });

}  // namespace
}  // namespace fascicle::test
