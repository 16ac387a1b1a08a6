#include "engine/loop/trace.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "engine/ecs/monotonic_clock.hpp"
#include "tests/engine/loop/parse_json.hpp"
#include "tests/support/allocation_counter.hpp"

namespace fascicle {
namespace {

std::vector<Json::Value> events_of(const Trace& trace, const std::string& phase) {
  std::vector<Json::Value> result;
  const Json::Value json = test::parse_json(trace.to_json());
  for (const Json::Value& event : json["traceEvents"]) {
    if (event["ph"].asString() == phase) result.push_back(event);
  }
  return result;
}

TEST(Trace, EmptyIsValid) {
  const Json::Value json = test::parse_json(Trace(0).to_json());
  EXPECT_EQ(json["traceEvents"].size(), 1u);  // the process's name
}

TEST(Trace, NumbersThatJsonLacksBecomeZeroAndBackwardTimesEmpty) {
  Trace trace(10);
  trace.add_counter("bad", 0, std::numeric_limits<double>::quiet_NaN());
  trace.add_counter("bad", 0, std::numeric_limits<double>::infinity());
  trace.add_complete("backward", "test", 100, 50, 0);
  for (const Json::Value& event : events_of(trace, "C")) EXPECT_EQ(event["args"]["value"].asDouble(), 0);
  EXPECT_EQ(events_of(trace, "X").at(0)["dur"].asDouble(), 0);
}

TEST(Trace, EventsBeyondTheLimitAreDroppedAndCounted) {
  Trace trace(3);
  for (int i = 0; i < 10; ++i) trace.add_complete("e", "test", i, i + 1, 0);
  trace.add_counter("c", 0, 1);
  trace.add_frame(0, 0, 1);
  EXPECT_EQ(trace.size(), 3u);
  EXPECT_EQ(trace.dropped(), 10u);
  EXPECT_EQ(test::parse_json(trace.to_json())["otherData"]["dropped_events"].asString(), "10");
}

TEST(Trace, CompleteEvents) {
  const std::int64_t start = monotonic_ns();
  Trace trace(10);
  trace.add_complete("say \"hi\"\n\xff", "cat\\egory", start + 5'000'000, start + 5'001'500, 3);
  const std::vector<Json::Value> events = events_of(trace, "X");
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0]["name"].asString(), "say \"hi\"\n\xef\xbf\xbd");
  EXPECT_EQ(events[0]["cat"].asString(), "cat\\egory");
  EXPECT_EQ(events[0]["tid"].asInt(), 3);
  EXPECT_NEAR(events[0]["dur"].asDouble(), 1.5, 1e-9);
  EXPECT_LE(events[0]["ts"].asDouble(), 5000);
  EXPECT_TRUE(events[0].isMember("pid"));
}

TEST(Trace, ThreadsHaveNames) {
  Trace trace(10);
  trace.set_thread_name(0, "main");
  trace.add_complete("a", "test", 0, 1, 0);
  trace.add_complete("a", "test", 0, 1, 2);
  trace.add_complete("a", "test", 0, 1, Trace::kGpuThread);
  trace.add_frame(0, 0, 1);
  std::map<int, std::string> names;
  for (const Json::Value& event : events_of(trace, "M")) {
    if (event["name"].asString() == "thread_name") names[event["tid"].asInt()] = event["args"]["name"].asString();
  }
  EXPECT_EQ(names, (std::map<int, std::string>{
                       {0, "main"}, {2, "worker 2"}, {Trace::kFrameThread, "frames"}, {Trace::kGpuThread, "GPU"}}));
}

TEST(Trace, CountersAndFrameMarks) {
  Trace trace(10);
  trace.add_counter("contacts", 0, 12.5);
  trace.add_frame(42, 0, 16'000'000);
  const std::vector<Json::Value> counters = events_of(trace, "C");
  ASSERT_EQ(counters.size(), 1u);
  EXPECT_EQ(counters[0]["name"].asString(), "contacts");
  EXPECT_EQ(counters[0]["args"]["value"].asDouble(), 12.5);
  const std::vector<Json::Value> marks = events_of(trace, "i");
  ASSERT_EQ(marks.size(), 1u);
  EXPECT_EQ(marks[0]["name"].asString(), "frame 42");
  EXPECT_EQ(marks[0]["s"].asString(), "g");
  EXPECT_NEAR(events_of(trace, "X").at(0)["dur"].asDouble(), 16000, 1e-6);
}

struct A {};
struct B {};

TEST(Trace, RecordsASchedule) {
  ecs::World world;
  ecs::Schedule schedule;
  schedule.add("first", [](ecs::View<A>) {});
  schedule.add("second", [](ecs::View<A>) {});
  schedule.add("beside", [](ecs::View<B>) {});
  parallel::WorkerArena arena(2);
  Trace trace(1000);
  constexpr std::size_t kFrames = 5;
  for (std::size_t i = 0; i < kFrames; ++i) {
    schedule.run(world, arena);
    trace.record(schedule.timings());
  }
  std::map<std::string, std::size_t> count;
  for (const Json::Value& event : events_of(trace, "X")) {
    ++count[event["name"].asString()];
    EXPECT_GE(event["ts"].asDouble(), 0);
    EXPECT_LT(event["tid"].asInt(), 2);
  }
  EXPECT_EQ(count, (std::map<std::string, std::size_t>{{"first", kFrames}, {"second", kFrames}, {"beside", kFrames}}));
}

TEST(Trace, RecordingKnownNamesAllocatesNothing) {
  Trace trace(1000);
  const std::vector<ecs::SystemTiming> timings{{"a system with a long name", 0, 10, 0, 0}, {"b", 0, 10, 1, 0}};
  const auto frame = [&](std::uint64_t i) {
    trace.record(timings);
    trace.add_counter("a counter with a long name", 0, 1);
    trace.add_frame(i, 0, 1);
  };
  frame(0);
  const test::AllocationScope scope;
  for (std::uint64_t i = 1; i < 100; ++i) frame(i);
  EXPECT_EQ(scope.allocations(), 0u);
}

TEST(Trace, WritesAFile) {
  Trace trace(10);
  trace.add_frame(1, 0, 1);
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "fascicle_trace.json";
  EXPECT_TRUE(trace.write(path).ok());
  std::ifstream file(path, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), trace.to_json());
  EXPECT_FALSE(trace.write(path / "below" / "trace.json").ok());
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace fascicle
