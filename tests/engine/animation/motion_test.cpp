#include "engine/animation/motion.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/animation/joint_model_reader.hpp"
#include "engine/animation/joint_systems.hpp"
#include "engine/animation/motion_reader.hpp"
#include "engine/ecs/world.hpp"

namespace fascicle {
namespace {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

const JointModel& leg() {
  static const JointModel model = [] {
    const auto document = parse_json(R"({ "bodies": [ { "name": "leg" } ],
      "coordinates": [ { "name": "tx", "kind": "translation", "range": [-9, 9] }, { "name": "ty", "kind": "translation", "default": 0.9, "range": [-9, 9] },
                       { "name": "hip", "range": [-2, 2] } ],
      "joints": [ { "name": "j", "parent": "ground", "child": "leg", "rotations": [ { "axis": [0, 0, 1], "coordinate": "hip" } ],
        "translations": [ { "axis": [1, 0, 0], "coordinate": "tx" }, { "axis": [0, 1, 0], "coordinate": "ty" } ] } ] })",
                                     "leg.json");
    return *read_joint_model(document->root());
  }();
  return model;
}

struct Broken {
  const char* name;
  const char* text;
  const char* expected;
};

const Broken kBroken[] = {
    {"Empty", "", "this is not an OpenSim motion"},
    {"NoEndOfHeader", "Coordinates\ninDegrees=yes\ntime\thip\n0\t1\n", "no line `endheader`"},
    {"NoColumns", "m\ninDegrees=no\nendheader\n", "no line of column names"},
    {"NoTime", "m\ninDegrees=no\nendheader\nhip\ttime\n0\t1\n",
     "m.mot:4:1: the first column is 'hip'; let the first column be time"},
    {"NothingKnown", "m\ninDegrees=no\nendheader\ntime\tknee\n0\t1\n",
     "no column is a coordinate of the model; the model's coordinates are: tx, ty, hip"},
    {"ColumnTwice", "m\ninDegrees=no\nendheader\ntime\thip\thip\n0\t1\t1\n",
     "m.mot:4:10: the column 'hip' occurs twice"},
    {"CoordinateTwice", "m\ninDegrees=no\nendheader\ntime\thip\t/jointset/j/hip/value\n0\t1\t1\n",
     "two columns give the coordinate 'hip'"},
    {"NoRows", "m\ninDegrees=no\nendheader\ntime\thip\n", "the motion has no rows"},
    {"Nan", "m\ninDegrees=no\nendheader\ntime\thip\n0\t0\n1\tnan\n",
     "m.mot:6:3: row 2, column hip: 'nan' is not a finite number"},
    {"Infinite", "m\ninDegrees=no\nendheader\ntime\thip\n0\tinf\n", "'inf' is not a finite number"},
    {"Word", "m\ninDegrees=no\nendheader\ntime\thip\n0\t1.5deg\n", "'1.5deg' is not a finite number"},
    {"RowTooShort", "m\ninDegrees=no\nendheader\ntime\thip\ttx\n0\t0\t0\n1\t0\n",
     "m.mot:6:1: row 2: 2 values, but line 4 names 3 columns"},
    {"RowTooLong", "m\ninDegrees=no\nendheader\ntime\thip\n0\t0\t0\n", "3 values, but line 4 names 2 columns"},
    {"TimeFalls", "m\ninDegrees=no\nendheader\ntime\thip\n0\t0\n1\t0\n0.5\t0\n",
     "m.mot:7:1: row 3: the time 0.5 does not rise above the one before, 1"},
    {"TimeStands", "m\ninDegrees=no\nendheader\ntime\thip\n1\t0\n1\t0\n", "does not rise"},
    {"OddDegrees", "m\ninDegrees=maybe\nendheader\ntime\thip\n0\t0\n", "inDegrees is 'maybe'"},
    {"Vectors", "m\nDataType=Vec3\ninDegrees=no\nendheader\ntime\thip\n0\t0,0,0\n", "DataType is Vec3"},
};

class BrokenMotion : public testing::TestWithParam<Broken> {};

TEST_P(BrokenMotion, IsRefusedWithItsLine) {
  const auto motion = parse_motion(GetParam().text, "m.mot", leg());
  ASSERT_FALSE(motion.ok());
  EXPECT_THAT(to_text(motion.diagnostics()), HasSubstr(GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(MotionReader, BrokenMotion, testing::ValuesIn(kBroken),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(MotionReader, ReportsAllBadRowsAndStopsAtFifty) {
  std::string text = "m\ninDegrees=no\nendheader\ntime\thip\n";
  for (int i = 0; i < 80; ++i) text += fmt::format("{}\tx\n", i);
  const auto motion = parse_motion(text, "m.mot", leg());
  ASSERT_FALSE(motion.ok());
  EXPECT_EQ(motion.diagnostics().errors.size(), 51u);
  EXPECT_THAT(motion.diagnostics().errors.back().cause, HasSubstr("too many errors"));
}

TEST(MotionReader, ConvertsDegreesOfRotationsOnlyAndWarnsOfTheRest) {
  const auto motion = parse_motion(
      "Trial\r\nnRows=3\r\ninDegrees=yes\r\nendheader\r\n time  hip  tx  grf  \r\n0 90 90 1\r\n0.5 +45 1 1\r\n",
      "m.mot", leg());
  ASSERT_TRUE(motion.ok()) << to_text(motion.diagnostics());
  EXPECT_EQ(motion->name, "Trial");
  std::vector<double> values(3);
  sample_motion(*motion, 0.0, values);
  EXPECT_EQ(values[0], 90.0);
  EXPECT_EQ(values[1], 0.9);  // its default
  EXPECT_DOUBLE_EQ(values[2], kPi / 2);
  const std::string text = to_text(motion.diagnostics());
  EXPECT_THAT(text, HasSubstr("m.mot:5:1: columns that the model does not know are left out: grf"));
  EXPECT_THAT(text, HasSubstr("coordinates without a column keep their defaults: ty"));
  EXPECT_THAT(text, HasSubstr("the header says nRows=3, but there are 2 rows"));
}

TEST(MotionReader, ReadsStatesByPath) {
  const auto motion = parse_motion(
      "s\ninDegrees=no\nendheader\ntime\t/jointset/j/hip/value\t/jointset/j/hip/speed\n0\t0.5\t7\n", "s.sto", leg());
  ASSERT_TRUE(motion.ok()) << to_text(motion.diagnostics());
  EXPECT_EQ(motion->values[2], 0.5);
  EXPECT_EQ(motion->cycle.length(), 0.0);  // a single pose
  std::vector<double> values(3);
  sample_cycle(*motion, 17.0, true, values);
  EXPECT_EQ(values[2], 0.5);
}

// A parabola is reproduced between samples, at uneven times as well.
TEST(Motion, InterpolatesParabolasExactly) {
  std::string text = "m\ninDegrees=no\nendheader\ntime\thip\n";
  for (const double t : {0.0, 0.3, 0.5, 1.1, 1.2, 2.0}) text += fmt::format("{}\t{}\n", t, 1.0 + t - 0.4 * t * t);
  const auto motion = parse_motion(text, "m.mot", leg());
  ASSERT_TRUE(motion.ok());
  std::vector<double> values(3);
  for (double t = 0.0; t <= 2.0; t += 0.01) {
    sample_motion(*motion, t, values);
    EXPECT_NEAR(values[2], 1.0 + t - 0.4 * t * t, 1e-14);
  }
  sample_motion(*motion, 9.0, values);
  EXPECT_NEAR(values[2], 1.0 + 2.0 - 0.4 * 4.0, 1e-15);  // held
  sample_motion(*motion, -9.0, values);
  EXPECT_EQ(values[2], 1.0);
}

// A walk of period 1.1 s over 3 s at 1.3 m/s, with a drift in the hip that no cycle closes by itself.
Motion walk() {
  std::string text = "m\ninDegrees=no\nendheader\ntime\thip\ttx\tty\n";
  for (int i = 0; i <= 180; ++i) {
    const double t = i / 60.0;
    text += fmt::format("{}\t{}\t{}\t{}\n", t, 0.4 * std::sin(2 * kPi * t / 1.1) + 0.01 * t, 5.0 + 1.3 * t,
                        0.9 + 0.02 * std::sin(4 * kPi * t / 1.1) + 0.001 * t);
  }
  return *parse_motion(text, "walk.mot", leg());
}

TEST(Motion, ChoosesAWholeCycle) {
  const Motion motion = walk();
  const double cycles = motion.cycle.length() / 1.1;
  EXPECT_NEAR(cycles, std::round(cycles), 0.01);
  EXPECT_GE(std::round(cycles), 1.0);
}

TEST(Motion, LoopsWithoutAJump) {
  const Motion motion = walk();
  const double length = motion.cycle.length();
  std::vector<double> before(3), after(3);
  for (const bool in_place : {false, true}) {
    for (int cycle = -2; cycle <= 3; ++cycle) {
      sample_cycle(motion, cycle * length - 1e-9, in_place, before);
      sample_cycle(motion, cycle * length + 1e-9, in_place, after);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(before[c], after[c], 1e-7) << "coordinate " << c << ", cycle " << cycle;
    }
  }
  // Travel goes on; height does not drift.
  sample_cycle(motion, 0.2, false, before);
  sample_cycle(motion, 0.2 + 10 * length, false, after);
  EXPECT_NEAR(after[0] - before[0], 13.0 * length, 1e-9);
  EXPECT_NEAR(after[1], before[1], 1e-12);
  EXPECT_NEAR(after[2], before[2], 1e-12);
  // In place it stays about the origin.
  for (double t = 0.0; t < 20.0; t += 0.05) {
    sample_cycle(motion, t, true, after);
    EXPECT_LT(std::abs(after[0]), 0.05);
  }
}

// A motion whose rest at the end would make the best cycle, and whose ends differ.
TEST(Motion, LoopsItsWholeRecordAsRecordedWhereAsked) {
  std::string text = "m\ninDegrees=no\nendheader\ntime\thip\n";
  for (int i = 0; i <= 20; ++i) text += fmt::format("{}\t{}\n", 3.0 + 0.1 * i, i < 10 ? -0.1 * i : -0.5);
  auto motion = parse_motion(text, "m.mot", leg());
  ASSERT_TRUE(motion.ok()) << to_text(motion.diagnostics());
  EXPECT_LT(motion->cycle.length(), 1.5);
  loop_whole_record(*motion);
  EXPECT_EQ(motion->cycle.start, 3.0);
  EXPECT_EQ(motion->cycle.end, 5.0);
  std::vector<double> values(3);
  for (int i = 0; i < 20; ++i) {
    for (const bool in_place : {false, true}) {
      sample_cycle(*motion, 0.1 * i, in_place, values);
      EXPECT_NEAR(values[2], i < 10 ? -0.1 * i : -0.5, 1e-12) << i;
      sample_cycle(*motion, 0.1 * i + 2.0, in_place, values);
      EXPECT_NEAR(values[2], i < 10 ? -0.1 * i : -0.5, 1e-9) << i;
    }
  }
}

TEST(JointSystems, PlayAMotionOntoTheSkeleton) {
  auto model = std::make_shared<const JointModel>(leg());
  auto motion = std::make_shared<const Motion>(walk());
  ecs::World world;
  FrameTime time;
  time.step = 0.1f;
  world.set_resource(time);
  std::vector<ecs::Entity> entities;
  for (int i = 0; i < 20; ++i) {  // more than a chunk
    const ecs::Entity entity = world.create();
    world.add(entity, make_coordinate_pose(model));
    world.add(entity, LocalPose{model->skeleton, model->skeleton->rest_local});
    MotionPlayer player;
    player.motion = motion;
    player.time = 0.01 * i;
    player.loop = i % 2 == 0;
    world.add(entity, player);
    entities.push_back(entity);
  }
  advance_motions(world.view<MotionPlayer>(), ecs::Resource<const FrameTime>(world.resource<FrameTime>()));
  sample_motions(world.view<const MotionPlayer, CoordinatePose>());
  pose_joint_models(world.view<const CoordinatePose, LocalPose>());
  for (int i = 0; i < 20; ++i) {
    const double played = 0.01 * i + static_cast<double>(0.1f);
    EXPECT_DOUBLE_EQ(world.get<MotionPlayer>(entities[i]).time, played);
    std::vector<double> expected(3);
    if (i % 2 == 0) {
      sample_cycle(*motion, played, false, expected);
    } else {
      sample_motion(*motion, motion->times.front() + played, expected);
    }
    EXPECT_EQ(world.get<CoordinatePose>(entities[i]).values, expected);
    const glm::vec3 at = world.get<LocalPose>(entities[i]).bones[1].translation;
    EXPECT_FLOAT_EQ(at.x, static_cast<float>(expected[0]));
    EXPECT_FLOAT_EQ(at.y, static_cast<float>(expected[1]));
  }
}

}  // namespace
}  // namespace fascicle
