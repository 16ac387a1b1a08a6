#include "engine/loop/frame_stats.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/allocation_counter.hpp"

namespace fascicle {
namespace {

constexpr std::int64_t kMs = 1'000'000;

std::vector<ecs::SystemTiming> timing(std::string_view name, std::int64_t ns) {
  return {{name, 1000, 1000 + ns, 0, 0}};
}

void add_frame(FrameStats& stats, std::string_view name, std::int64_t ns) {
  stats.begin_frame();
  stats.record(timing(name, ns));
  stats.end_frame();
}

TEST(FrameStats, EmptyHasNoFramesAndPrintsAllTheSame) {
  const FrameStats stats;
  EXPECT_EQ(stats.frames(), 0u);
  EXPECT_EQ(stats.summary(0).max_ms, 0);
  EXPECT_TRUE(stats.history("frame").empty());
  EXPECT_TRUE(stats.history("unknown").empty());
  EXPECT_FALSE(stats.find_row("unknown"));
  EXPECT_EQ(stats.measuring_percent(), 0);
  EXPECT_NE(stats.to_table().find("0 frames"), std::string::npos);
}

TEST(FrameStats, NegativeTimesCountAsZeroAndLeftOutSystemsNotAtAll) {
  FrameStats stats({0, 16});
  stats.begin_frame();
  stats.record_span("draw", -5);
  stats.record(timing("left out", 0));
  stats.end_frame();
  EXPECT_EQ(stats.summary(*stats.find_row("draw")).max_ms, 0);
  EXPECT_FALSE(stats.find_row("left out"));
}

TEST(FrameStats, SummaryOfKnownTimes) {
  FrameStats stats({0, 1000});
  // 1 .. 100 ms in an order that is not sorted.
  for (int i = 0; i < 100; ++i) add_frame(stats, "solve", (1 + i * 37 % 100) * kMs);
  const RowSummary row = stats.summary(*stats.find_row("solve"));
  EXPECT_EQ(row.name, "solve");
  EXPECT_EQ(row.kind, RowKind::kSystem);
  EXPECT_EQ(row.frames, 100u);
  EXPECT_NEAR(row.min_ms, 1, 1e-5);
  EXPECT_NEAR(row.mean_ms, 50.5, 1e-5);
  EXPECT_NEAR(row.p50_ms, 50, 1e-5);
  EXPECT_NEAR(row.p95_ms, 95, 1e-5);
  EXPECT_NEAR(row.p99_ms, 99, 1e-5);
  EXPECT_NEAR(row.max_ms, 100, 1e-5);
}

TEST(FrameStats, WarmUpFramesAreLeftOut) {
  FrameStats stats({3, 100});
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(stats.frames(), i < 3 ? 0u : static_cast<std::uint64_t>(i - 3));
    add_frame(stats, "solve", i < 3 ? 500 * kMs : kMs);
    EXPECT_EQ(stats.warming_up(), i < 3);
  }
  EXPECT_EQ(stats.frames(), 2u);
  EXPECT_NEAR(stats.summary(*stats.find_row("solve")).max_ms, 1, 1e-6);
  EXPECT_EQ(stats.history("solve").size(), 2u);
}

TEST(FrameStats, StepsOfOneFrameAddUp) {
  FrameStats stats({0, 100});
  stats.begin_frame();
  for (int step = 0; step < 3; ++step) stats.record(timing("solve", 2 * kMs));
  stats.end_frame();
  EXPECT_NEAR(stats.summary(*stats.find_row("solve")).mean_ms, 6, 1e-6);
  EXPECT_EQ(stats.summary(*stats.find_row("solve")).frames, 1u);
}

TEST(FrameStats, RowsCountTheFramesTheyAppearIn) {
  FrameStats stats({0, 100});
  add_frame(stats, "solve", kMs);
  stats.begin_frame();  // a frame without a step
  stats.end_frame();
  add_frame(stats, "solve", 3 * kMs);
  EXPECT_EQ(stats.frames(), 3u);
  EXPECT_EQ(stats.summary(*stats.find_row("solve")).frames, 2u);
  EXPECT_NEAR(stats.summary(*stats.find_row("solve")).mean_ms, 2, 1e-6);
}

TEST(FrameStats, HistoryHoldsTheLastFramesAndTheRestIsOfTheWholeRun) {
  FrameStats stats({0, 4});
  for (int i = 1; i <= 10; ++i) add_frame(stats, "solve", i * kMs);
  const std::span<const float> history = stats.history("solve");
  ASSERT_EQ(history.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(history[i], 7.0 + static_cast<double>(i), 1e-5);
  const RowSummary row = stats.summary(*stats.find_row("solve"));
  EXPECT_EQ(row.frames, 10u);
  EXPECT_NEAR(row.min_ms, 1, 1e-5);
  EXPECT_NEAR(row.mean_ms, 5.5, 1e-5);
  EXPECT_NEAR(row.p50_ms, 8, 1e-5);
}

TEST(FrameStats, KindsAreListedInOrder) {
  FrameStats stats({0, 4});
  stats.begin_frame();
  stats.record_gpu("muscles", 4 * kMs);
  stats.record_span("draw", 3 * kMs);
  stats.record(timing("draw", kMs));  // a system of the same name is another row
  stats.end_frame();
  const std::vector<RowSummary> rows = stats.summaries();
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0].kind, RowKind::kFrame);
  EXPECT_EQ(rows[1].kind, RowKind::kSystem);
  EXPECT_NEAR(rows[1].mean_ms, 1, 1e-6);
  EXPECT_EQ(rows[2].kind, RowKind::kSpan);
  EXPECT_NEAR(rows[2].mean_ms, 3, 1e-6);
  EXPECT_EQ(rows[3].kind, RowKind::kGpu);
  EXPECT_NEAR(rows[3].mean_ms, 4, 1e-6);
  EXPECT_EQ(rows[4].kind, RowKind::kMeasuring);
}

TEST(FrameStats, MeasuringIsMeasured) {
  FrameStats stats({0, 100});
  std::vector<ecs::SystemTiming> many;
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) many.push_back(timing(name, kMs)[0]);
  for (int i = 0; i < 50; ++i) {
    stats.begin_frame();
    stats.record(many);
    const std::int64_t start = monotonic_ns();
    while (monotonic_ns() < start + 200'000) {
    }
    stats.end_frame();
  }
  EXPECT_GT(stats.summary(1).mean_ms, 0);
  EXPECT_GT(stats.measuring_percent(), 0);
  EXPECT_NEAR(stats.measuring_percent(), 100 * stats.summary(1).mean_ms / stats.summary(0).mean_ms, 1e-9);
  EXPECT_GE(stats.summary(0).min_ms, 0.2);
}

TEST(FrameStats, SteadyFramesAllocateNothing) {
  FrameStats stats({5, 100});
  const std::vector<ecs::SystemTiming> solve = timing("solve", kMs);
  const auto frame = [&] {
    stats.begin_frame();
    stats.record(solve);
    stats.record_span("draw", kMs);
    stats.record_gpu("muscles", kMs);
    stats.end_frame();
  };
  for (int i = 0; i < 10; ++i) frame();
  const test::AllocationScope scope;
  for (int i = 0; i < 300; ++i) frame();
  EXPECT_EQ(scope.allocations(), 0u);
}

}  // namespace
}  // namespace fascicle
