// Hulls of anatomical muscles.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "engine/content/mesh_reader.hpp"
#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/self_intersections.hpp"
#include "modules/muscle/asset/hull/progressive_hull.hpp"
#include "tests/modules/muscle/asset/hull/hull_checks.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::muscle {
namespace {

constexpr double kEnclosed = 1.0e-6;

// Millimetres to metres.
TriangleMesh read(const std::string& name) {
  auto mesh = read_mesh((test::data_folder() / "pbd" / name).string());
  EXPECT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  if (!mesh) return {};
  for (glm::vec3& position : mesh->positions) position *= 0.001f;
  return *mesh;
}

struct Known {
  std::uint32_t vertices;
  double overhead;  // at most
};

void expect_hulls(const std::string& name, std::initializer_list<Known> all) {
  const TriangleMesh fine = read(name);
  for (const Known& known : all) {
    const auto hull = build_progressive_hull(fine, {.vertices = known.vertices});
    ASSERT_TRUE(hull.ok()) << to_text(hull.diagnostics());
    EXPECT_TRUE(hull.diagnostics().warnings.empty());
    EXPECT_EQ(hull->mesh.positions.size(), known.vertices);
    EXPECT_EQ(test::manifold_fault(hull->mesh), "");
    EXPECT_LE(test::outside(fine, hull->mesh), kEnclosed) << known.vertices;
    EXPECT_GT(hull->overhead(), -kEnclosed);
    EXPECT_LT(hull->overhead(), known.overhead) << known.vertices;
    EXPECT_GT(test::least_shape(hull->mesh), 0.049) << known.vertices;
    EXPECT_EQ(find_self_intersections(hull->mesh.positions, hull->mesh.indices).pairs, 0u) << known.vertices;
  }
}

TEST(MuscleHulls, GluteusMaximus) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
  expect_hulls("gluteus_maximus.vtk", {{500, 0.04}, {200, 0.10}, {100, 0.19}});
}

TEST(MuscleHulls, Iliacus) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/iliacus.vtk");
  expect_hulls("iliacus.vtk", {{500, 0.07}, {200, 0.16}, {100, 0.32}});
}

TEST(MuscleHulls, Box) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/box.vtk");
  expect_hulls("box.vtk", {{500, 1e-6}, {100, 1e-6}, {8, 1e-6}});
}

TEST(MuscleHulls, WalkersMuscles) {
  const std::filesystem::path file =
      std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "characters" / "walker" / "muscles.glb";
  std::size_t hulls = 0;
  for (const char* name : {"gluteus_medius_1_r", "sartorius_r", "rectus_femoris_r", "gracilis_r"}) {
    auto mesh = read_mesh(file.string() + "#" + name);
    ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
    const TriangleMesh fine = clean_mesh(*mesh).mesh;
    const auto hull = build_progressive_hull(fine, {.vertices = 60});
    ASSERT_TRUE(hull.ok()) << name << ": " << to_text(hull.diagnostics());
    EXPECT_EQ(hull->mesh.positions.size(), 60u) << name;
    EXPECT_EQ(test::manifold_fault(hull->mesh), "") << name;
    EXPECT_LE(test::outside(fine, hull->mesh), kEnclosed) << name;
    EXPECT_LT(hull->overhead(), 0.5) << name << ": a strap's hull is thin, too";
    ++hulls;
  }
  EXPECT_EQ(hulls, 4u);
}

}  // namespace
}  // namespace fascicle::muscle
