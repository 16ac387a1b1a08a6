// Bones as their authors left them: fields against winding numbers and nearest points.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/content/mesh_reader.hpp"
#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/asset/bone_fields/bone_grid.hpp"
#include "tests/modules/muscle/asset/bone_fields/field_points.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::muscle {
namespace {

struct Agreement {
  int inside = 0, wrong = 0;
  double near_error = 0.0;  // m, of points nearer than two voxels
  double over = 0.0;        // m, by which any answer outside is more than the distance
};

// Where the mesh is open its own winding number says where the surface would be; points as near to a hole as it is wide
// are left out (`hole`, m).
Agreement compare(const TriangleMesh& mesh, const BoneField& field, double hole) {
  const CleanMesh clean = clean_mesh(mesh);
  const WindingField winding(clean.mesh);
  const ClosestPoints nearest(clean.mesh);
  Agreement agreement;
  const glm::vec3 margin(0.02f);
  for (const glm::vec3& point : test::points_in_box(field.lower() - margin, field.upper() + margin, 20'000)) {
    const double about = winding.at(glm::dvec3(point));
    if (hole > 0.0 && about > 0.2 && about < 0.8) continue;
    const bool inside = about > 0.5;
    const double distance = nearest.at(point).distance, wanted = inside ? -distance : distance;
    const double found = field.distance(point);
    agreement.inside += inside ? 1 : 0;
    if (distance > field.voxel() && (found < 0.0) != inside) ++agreement.wrong;
    if (distance < 2.0 * field.voxel() && hole == 0.0) {
      agreement.near_error = std::max(agreement.near_error, std::abs(found - wanted));
    }
    if (!inside && hole == 0.0 && distance > field.band()) agreement.over = std::max(agreement.over, found - distance);
  }
  return agreement;
}

void check_file(const char* file, float unit, double hole) {
  FASCICLE_SKIP_WITHOUT_DATA(file);
  auto mesh = read_mesh((test::data_folder() / file).string());
  ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  for (glm::vec3& position : mesh->positions) position *= unit;
  const auto field = build_bone_field({&*mesh, 1}, file, {.voxel = 0.002f});
  ASSERT_TRUE(field.ok()) << to_text(field.diagnostics());
  const Agreement agreement = compare(*mesh, **field, hole);
  EXPECT_GT(agreement.inside, 100);
  EXPECT_EQ(agreement.wrong, 0);
  EXPECT_LT(agreement.near_error, 0.5f * (*field)->voxel());
  EXPECT_LE(agreement.over, 1e-6);
}

TEST(RealBones, AFemurWithTurnedFaces) { check_file("pbd/femur.vtk", 0.001f, 0.0); }
TEST(RealBones, PlatesHalfTurned) {
  check_file("pbd/plate_top.vtk", 0.001f, 0.0);
  check_file("pbd/plate_bottom.vtk", 0.001f, 0.0);
}
TEST(RealBones, APelvisWithHoles) { check_file("opensim/Geometry/pelvis.vtp", 1.0f, 0.01); }
TEST(RealBones, ATibia) { check_file("opensim/Geometry/tibia_r.vtp", 1.0f, 0.0); }
TEST(RealBones, AFootWithAHoleAndCrossings) { check_file("opensim/Geometry/foot.vtp", 1.0f, 0.01); }

}  // namespace
}  // namespace fascicle::muscle
