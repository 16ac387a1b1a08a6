// A real walking trial on a real model: it must read without complaint, loop over whole strides and walk.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/animation/motion_reader.hpp"
#include "modules/muscle/import/osim_reader.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::muscle {
namespace {

class Walk : public testing::Test {
 protected:
  void SetUp() override {
    FASCICLE_SKIP_WITHOUT_DATA("opensim/walk.mot");
    Result<OsimModel> model = read_osim(test::data_folder() / "opensim" / "gait2392.osim");
    ASSERT_TRUE(model.ok()) << to_text(model.diagnostics());
    model_ = std::move(*model);
    Result<Motion> motion = read_motion(test::data_folder() / "opensim" / "walk.mot", model_.joints);
    ASSERT_TRUE(motion.ok()) << to_text(motion.diagnostics());
    EXPECT_TRUE(motion.diagnostics().warnings.empty()) << to_text(motion.diagnostics());
    motion_ = std::move(*motion);
  }

  std::size_t coordinate(const char* name) const {
    const std::int32_t index = model_.joints.find_coordinate(name);
    EXPECT_GE(index, 0) << name;
    return static_cast<std::size_t>(index);
  }

  OsimModel model_;
  Motion motion_;
};

TEST_F(Walk, LoopsOverWholeStrides) {
  EXPECT_EQ(motion_.times.size(), 211u);
  EXPECT_EQ(motion_.name, "Coordinates");
  // Strides take 1 to 1.3 s at this speed; the ends of the loop lie within 4 degrees of each other.
  const double length = motion_.cycle.length();
  const double strides = std::round(length / 1.15);
  EXPECT_GE(strides, 1.0);
  EXPECT_GT(length / strides, 1.0);
  EXPECT_LT(length / strides, 1.3);
  double worst = 0.0;
  for (std::size_t c = 0; c < motion_.coordinates; ++c) {
    if (model_.joints.coordinates[c].kind == JointCoordinate::Kind::kRotation) {
      worst = std::max(worst, std::abs(motion_.cycle_change[c]));
    }
  }
  std::printf("cycle %.4f to %.4f s, ends differ by %.2f degrees at most\n", motion_.cycle.start, motion_.cycle.end,
              worst * 57.29578);
  EXPECT_LT(worst * 57.29578, 4.0);
}

TEST_F(Walk, LegsTakeTurnsAndEverythingStaysTogether) {
  const std::size_t right = coordinate("hip_flexion_r");
  const std::size_t left = coordinate("hip_flexion_l");
  const std::size_t knee = coordinate("knee_angle_r");
  const std::int32_t heel = model_.joints.skeleton->find("calcn_r");
  const std::int32_t toes = model_.joints.skeleton->find("toes_r");
  const std::int32_t thigh = model_.joints.skeleton->find("femur_r");
  std::vector<double> values(motion_.coordinates);
  double together = 0.0, deepest_knee = 0.0, lowest = 1e9, highest = -1e9, longest_step = 0.0;
  std::vector<RigidTransform> before;
  for (double t = 0.0; t < 3.0 * motion_.cycle.length(); t += 1.0 / 60.0) {
    sample_cycle(motion_, t, true, values);
    together += (values[right] - motion_.cycle_mean[right]) * (values[left] - motion_.cycle_mean[left]);
    deepest_knee = std::min(deepest_knee, values[knee]);
    const auto bones = evaluate_bones(model_.joints, values);
    for (std::size_t b = 0; b < bones.size(); ++b) {
      ASSERT_TRUE(std::isfinite(glm::length(bones[b].translation)));
      if (!before.empty())
        longest_step = std::max(longest_step, glm::distance(bones[b].translation, before[b].translation));
    }
    before = bones;
    const auto h = static_cast<std::size_t>(heel);
    lowest = std::min({lowest, bones[h].translation.y, bones[static_cast<std::size_t>(toes)].translation.y});
    highest = std::max(highest, bones[h].translation.y);
    EXPECT_GT(bones[static_cast<std::size_t>(thigh)].translation.x, -0.3);
    EXPECT_LT(bones[static_cast<std::size_t>(thigh)].translation.x, 0.0);  // the right side is at -x
  }
  std::printf("lowest foot origin %.4f m, highest heel %.4f m, longest step of a bone in a frame %.4f m\n", lowest,
              highest, longest_step);
  EXPECT_LT(together, 0.0);
  EXPECT_LT(deepest_knee, -0.9);      // swing bends the knee by more than 50 degrees
  EXPECT_GT(highest - lowest, 0.1);   // feet leave the ground
  EXPECT_LT(longest_step, 0.15);      // nothing faster than 9 m/s, at the loop's seam as well
}

TEST_F(Walk, MusclesKeepSensibleLengths) {
  const std::vector<double> defaults = default_coordinates(model_.joints);
  std::vector<double> values(motion_.coordinates);
  const auto length = [&](const OsimMuscle& muscle, std::span<const double> at) {
    const auto bones = evaluate_bones(model_.joints, at);
    double sum = 0.0;
    glm::dvec3 last(0.0);
    bool first = true;
    for (const OsimPathPoint& point : muscle.points) {
      if (!is_active(model_, point, at)) continue;
      const glm::dvec3 place = bones[static_cast<std::size_t>(point.body)] * location_at(model_, point, at);
      if (!first) sum += glm::distance(last, place);
      last = place;
      first = false;
    }
    return sum;
  };
  for (const OsimMuscle& muscle : model_.muscles) {
    const double rest = length(muscle, defaults);
    ASSERT_GT(rest, 0.02) << muscle.name;
    for (int i = 0; i < 20; ++i) {
      sample_cycle(motion_, motion_.cycle.length() * i / 20.0, true, values);
      const double now = length(muscle, values);
      EXPECT_GT(now, 0.6 * rest) << muscle.name;
      EXPECT_LT(now, 1.6 * rest) << muscle.name;
    }
  }
}

}  // namespace
}  // namespace fascicle::muscle
