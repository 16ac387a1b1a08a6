#include "engine/loop/frame_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fascicle {
namespace {

constexpr float kStep = 0.125F;  // exact in binary, so that counts below are, too
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(FrameLoop, SenselessWallTimesCountAsNone) {
  FrameLoop loop(kStep, 4);
  loop.begin_frame(0.0625);
  const float alpha = loop.alpha();
  for (const double wall : {-1.0, -1e-9, kNan, kInfinity, -kInfinity}) {
    EXPECT_EQ(loop.begin_frame(wall), 0) << wall;
    EXPECT_EQ(loop.alpha(), alpha) << wall;
  }
  EXPECT_EQ(loop.rejected_times(), 5u);
  EXPECT_EQ(loop.clamped_steps(), 0u);
  EXPECT_EQ(loop.begin_frame(0.0625), 1);
}

TEST(FrameLoop, SenselessTimeScaleIsRefused) {
  FrameLoop loop(kStep, 4);
  for (const float scale : {-1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    EXPECT_FALSE(loop.set_time_scale(scale));
    EXPECT_EQ(loop.time().time_scale, 1.0F);
  }
}

TEST(FrameLoop, StepsAndAlpha) {
  FrameLoop loop(kStep, 10);
  struct Row {
    double wall;
    int steps;
    float alpha;
  };
  const Row rows[] = {{0.0, 0, 0.0F},      {0.125, 1, 0.0F},  {0.0625, 0, 0.5F}, {0.03125, 0, 0.75F},
                      {0.03125, 1, 0.0F},  {0.375, 3, 0.0F},  {0.40625, 3, 0.25F}, {0.0, 0, 0.25F},
                      {0.09375, 1, 0.0F}};
  for (const Row& row : rows) {
    EXPECT_EQ(loop.begin_frame(row.wall), row.steps) << row.wall;
    EXPECT_EQ(loop.alpha(), row.alpha) << row.wall;
  }
  EXPECT_EQ(loop.clamped_steps(), 0u);
}

TEST(FrameLoop, TooManyStepsAreDroppedAndCounted) {
  FrameLoop loop(kStep, 3);
  EXPECT_EQ(loop.begin_frame(5 * 0.125 + 0.0625), 3);
  EXPECT_EQ(loop.clamped_steps(), 2u);
  EXPECT_EQ(loop.clamped_frames(), 1u);
  EXPECT_EQ(loop.alpha(), 0.5F);
  EXPECT_EQ(loop.begin_frame(0.0625), 1);  // the dropped steps do not come back
  EXPECT_EQ(loop.begin_frame(3 * 0.125), 3);
  EXPECT_EQ(loop.clamped_frames(), 1u);
  EXPECT_EQ(loop.begin_frame(1e300), 3);  // a clock gone mad: no overflow
  EXPECT_GE(loop.clamped_steps(), 1000000u);
  EXPECT_GE(loop.alpha(), 0.0F);
  EXPECT_LE(loop.alpha(), 1.0F);
  EXPECT_EQ(loop.begin_frame(0.125), 1);
}

TEST(FrameLoop, PauseStopsAndSingleStepsGoOn) {
  FrameLoop loop(kStep, 3);
  loop.begin_frame(0.0625);
  loop.set_paused(true);
  EXPECT_EQ(loop.begin_frame(10), 0);
  EXPECT_EQ(loop.alpha(), 0.5F);
  EXPECT_TRUE(loop.time().paused);
  loop.request_single_step();
  EXPECT_EQ(loop.begin_frame(10), 1);
  EXPECT_EQ(loop.begin_frame(10), 0);
  for (int i = 0; i < 5; ++i) loop.request_single_step();
  EXPECT_EQ(loop.begin_frame(0), 3);
  loop.set_paused(false);
  EXPECT_EQ(loop.begin_frame(0.0625), 1);  // the pause itself is not caught up
  EXPECT_EQ(loop.clamped_steps(), 0u);
}

TEST(FrameLoop, SingleStepWhileRunningIsForgotten) {
  FrameLoop loop(kStep, 3);
  loop.request_single_step();
  EXPECT_EQ(loop.begin_frame(0.125), 1);
  loop.set_paused(true);
  EXPECT_EQ(loop.begin_frame(0), 0);
}

TEST(FrameLoop, TimeScaleChangesTheNumberOfStepsNotTheirLength) {
  FrameLoop loop(kStep, 100);
  EXPECT_TRUE(loop.set_time_scale(2));
  EXPECT_EQ(loop.begin_frame(1), 16);
  EXPECT_TRUE(loop.set_time_scale(0.5F));
  EXPECT_EQ(loop.begin_frame(1), 4);
  EXPECT_TRUE(loop.set_time_scale(0));
  EXPECT_EQ(loop.begin_frame(1), 0);
  EXPECT_EQ(loop.time().step, kStep);
  EXPECT_EQ(loop.time().time_scale, 0.0F);
}

TEST(FrameLoop, AdvanceCountsStepsAndTime) {
  FrameLoop loop(kStep, 3);
  EXPECT_EQ(loop.time().time, 0.0);
  EXPECT_EQ(loop.advance().frame, 0u);
  EXPECT_EQ(loop.time().time, 0.125);
  EXPECT_EQ(loop.advance().frame, 1u);
  EXPECT_EQ(loop.time().time, 0.25);
}

TEST(FrameLoop, TimeDoesNotDrift) {
  const float step = 1.0F / 60.0F;
  FrameLoop loop(step, 3);
  for (int i = 0; i < 1000000; ++i) loop.advance();
  EXPECT_EQ(loop.time().time, 1000000.0 * static_cast<double>(step));
}

// Wall time in, the same simulated time out, but for the step under way.
TEST(FrameLoop, KeepsUpWithAnUnevenClock) {
  FrameLoop loop(1.0F / 60.0F, 100);
  double wall = 0;
  int steps = 0;
  for (int i = 0; i < 10000; ++i) {
    const double frame = 0.001 + 0.03 * std::fabs(std::sin(0.37 * i));
    wall += frame;
    steps += loop.begin_frame(frame);
    EXPECT_NEAR((steps + static_cast<double>(loop.alpha())) * static_cast<double>(loop.time().step), wall, 1e-6);
  }
}

TEST(FrameLoop, AnotherStepLengthGoesOnFromTheSameMoment) {
  FrameLoop loop(0.5f, 4);
  loop.advance();
  loop.advance();
  EXPECT_DOUBLE_EQ(loop.time().time, 1.0);
  loop.set_step(0.25f);
  EXPECT_EQ(loop.begin_frame(0.5), 2);
  EXPECT_DOUBLE_EQ(loop.advance().time, 1.25);
  EXPECT_EQ(loop.time().frame, 2u);
  EXPECT_DOUBLE_EQ(loop.advance().time, 1.5);
}

}  // namespace
}  // namespace fascicle
