// Joints and path points of three OpenSim models against tables computed with OpenSim itself: 64 random poses each.
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <gtest/gtest.h>

#include "modules/muscle/import/osim_reader.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::muscle {
namespace {

std::vector<std::vector<std::string>> read_csv(const std::filesystem::path& file) {
  std::vector<std::vector<std::string>> rows;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::vector<std::string> row;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    rows.push_back(row);
  }
  return rows;
}

// Of the model's ground (OpenSim's axes) from the character's space.
glm::dvec3 to_opensim(const glm::dvec3& p) { return {p.z, p.y, -p.x}; }

struct Agreement {
  std::size_t fixed = 0;
  std::size_t conditional = 0;
  std::size_t moving = 0;
  double worst = 0.0;         // m, double precision
  double worst_float = 0.0;   // m, through LocalPose in single precision
  std::size_t wrong_activity = 0;
};

std::vector<glm::mat4> compose(const Skeleton& skeleton, const std::vector<Trs>& local) {
  std::vector<glm::mat4> world(local.size());
  for (std::size_t b = 0; b < local.size(); ++b) {
    const glm::mat4 own = to_matrix(local[b]);
    world[b] = skeleton.parents[b] < 0 ? own : world[static_cast<std::size_t>(skeleton.parents[b])] * own;
  }
  return world;
}

Agreement compare(const OsimModel& model, const std::filesystem::path& reference) {
  const auto poses = read_csv(reference / "poses.csv");
  std::vector<std::vector<double>> values(poses.size() - 1);
  std::vector<std::vector<RigidTransform>> bones;
  std::vector<std::vector<glm::mat4>> bones_float;
  for (std::size_t p = 0; p + 1 < poses.size(); ++p) {
    values[p] = default_coordinates(model.joints);
    for (std::size_t c = 1; c < poses[0].size(); ++c) {
      const std::int32_t coordinate = model.joints.find_coordinate(poses[0][c]);
      EXPECT_GE(coordinate, 0) << poses[0][c];
      if (coordinate >= 0) values[p][static_cast<std::size_t>(coordinate)] = std::stod(poses[p + 1][c]);
    }
    bones.push_back(evaluate_bones(model.joints, values[p]));
    std::vector<Trs> local(model.joints.skeleton->size());
    pose_joints(model.joints, values[p], local);
    bones_float.push_back(compose(*model.joints.skeleton, local));
  }

  std::map<std::string, const OsimPathPoint*> points;
  for (const OsimMuscle& muscle : model.muscles) {
    for (const OsimPathPoint& point : muscle.points) points[muscle.name + "/" + point.name] = &point;
  }
  Agreement result;
  std::vector<std::map<std::string, bool>> listed(values.size());
  for (const auto& row : read_csv(reference / "path_points.csv")) {
    if (row[0] == "pose" || row[6] != "0") continue;
    const auto pose = static_cast<std::size_t>(std::stoul(row[0]));
    const auto found = points.find(row[1] + "/" + row[8]);
    if (found == points.end()) {
      ADD_FAILURE() << "no point " << row[8] << " of " << row[1];
      continue;
    }
    const OsimPathPoint& point = *found->second;
    listed[pose][found->first] = true;
    switch (point.kind) {
      case OsimPathPoint::Kind::kFixed: ++result.fixed; break;
      case OsimPathPoint::Kind::kConditional: ++result.conditional; break;
      case OsimPathPoint::Kind::kMoving: ++result.moving; break;
    }
    const glm::dvec3 expected(std::stod(row[3]), std::stod(row[4]), std::stod(row[5]));
    const glm::dvec3 local = location_at(model, point, values[pose]);
    const auto body = static_cast<std::size_t>(point.body);
    EXPECT_EQ(model.joints.skeleton->names[body], row[9]);
    result.worst = std::max(result.worst, glm::distance(expected, to_opensim(bones[pose][body] * local)));
    const glm::vec3 single(bones_float[pose][body] * glm::vec4(glm::vec3(local), 1.0f));
    result.worst_float = std::max(result.worst_float, glm::distance(expected, to_opensim(glm::dvec3(single))));
  }
  for (std::size_t p = 0; p < values.size(); ++p) {
    for (const auto& [name, point] : points) {
      if (is_active(model, *point, values[p]) != (listed[p].count(name) != 0)) ++result.wrong_activity;
    }
  }
  return result;
}

struct Model {
  const char* name;
  std::size_t muscles, bodies, coordinates;
  bool wraps;
};

class OsimReference : public testing::TestWithParam<Model> {};

TEST_P(OsimReference, PathPointsAgreeWithOpenSim) {
  const std::string name = GetParam().name;
  FASCICLE_SKIP_WITHOUT_DATA("opensim/reference/" + name);
  const auto folder = test::data_folder() / "opensim";
  const Result<OsimModel> model = read_osim(folder / (name + ".osim"));
  ASSERT_TRUE(model.ok()) << to_text(model.diagnostics());
  EXPECT_EQ(model->muscles.size(), GetParam().muscles);
  EXPECT_EQ(model->joints.skeleton->size(), GetParam().bodies + 1);
  EXPECT_EQ(model->joints.coordinates.size(), GetParam().coordinates);

  const Agreement agreement = compare(*model, folder / "reference" / name);
  RecordProperty("worst_nm", std::to_string(agreement.worst * 1e9));
  std::printf("%s: %zu fixed, %zu conditional, %zu moving points; worst %.2e m in double, %.2e m in single precision\n",
              name.c_str(), agreement.fixed, agreement.conditional, agreement.moving, agreement.worst,
              agreement.worst_float);
  EXPECT_GT(agreement.fixed, 64u * 2 * GetParam().muscles - 1);
  EXPECT_LT(agreement.worst, 1e-9);
  EXPECT_LT(agreement.worst_float, 1e-6);
  EXPECT_EQ(agreement.wrong_activity, 0u);
}

INSTANTIATE_TEST_SUITE_P(Models, OsimReference,
                         testing::Values(Model{"gait2392", 92, 12, 23, false},
                                         Model{"gait10dof18musc", 18, 12, 10, false}, Model{"arm26", 6, 3, 2, true}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace fascicle::muscle
