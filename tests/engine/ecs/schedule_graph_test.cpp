#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "engine/ecs/schedule.hpp"

namespace fascicle::ecs {
namespace {

struct A {};
struct B {};
struct C {};
struct Clock {};

void read_a(View<const A>) {}
void write_a(View<A>) {}
void read_b(View<const B>) {}
void write_b(View<B>) {}
void read_a_write_b(View<const A, B>) {}
void read_b_write_c(View<const B, C>) {}
void read_ac(View<const A, const C>) {}
void read_clock(Resource<const Clock>) {}
void write_clock(Resource<Clock>) {}
void command(Commands&) {}
void none() {}

using Adder = void (*)(Schedule&);

template <auto F>
void add(Schedule& schedule) {
  schedule.add("s" + std::to_string(schedule.size()), F);
}
void barrier(Schedule& schedule) { schedule.add_barrier(); }

using Edges = std::vector<std::pair<unsigned, unsigned>>;

Edges edges(const Schedule& schedule) {
  Edges result;
  for (std::uint32_t id = 0; id < schedule.size(); ++id) {
    for (const SystemId earlier : schedule.waits_for({id})) result.emplace_back(earlier.value, id);
  }
  return result;
}

TEST(ScheduleGraph, EdgesTable) {
  struct Row {
    const char* what;
    std::vector<Adder> systems;
    Edges edges;
  };
  const Row rows[] = {
      {"empty", {}, {}},
      {"one", {add<write_a>}, {}},
      {"readers side by side", {add<read_a>, add<read_a>, add<read_a>}, {}},
      {"reader waits for writer", {add<write_a>, add<read_a>}, {{0, 1}}},
      {"writer waits for reader", {add<read_a>, add<write_a>}, {{0, 1}}},
      {"implied edges are left out", {add<write_a>, add<write_a>, add<write_a>}, {{0, 1}, {1, 2}}},
      {"different components", {add<write_a>, add<write_b>, add<read_a>, add<read_b>}, {{0, 2}, {1, 3}}},
      {"chain over components", {add<write_a>, add<read_a_write_b>, add<read_b_write_c>}, {{0, 1}, {1, 2}}},
      {"implied through another component", {add<write_a>, add<read_a_write_b>, add<read_b_write_c>, add<read_ac>},
       {{0, 1}, {1, 2}, {2, 3}}},
      {"writer waits for all readers", {add<read_a>, add<read_a>, add<write_a>}, {{0, 2}, {1, 2}}},
      {"diamond", {add<write_a>, add<read_a>, add<read_a>, add<write_a>}, {{0, 1}, {0, 2}, {1, 3}, {2, 3}}},
      {"resource readers side by side", {add<read_clock>, add<read_clock>}, {}},
      {"resource written", {add<read_clock>, add<write_clock>, add<read_clock>}, {{0, 1}, {1, 2}}},
      {"commands are the system's own", {add<command>, add<command>, add<none>}, {}},
      {"a barrier replaces edges", {add<write_a>, barrier, add<write_a>}, {}},
      {"edges within later stages", {add<write_a>, barrier, add<write_b>, add<read_b>}, {{1, 2}}},
  };
  for (const Row& row : rows) {
    Schedule schedule;
    for (const Adder system : row.systems) system(schedule);
    EXPECT_EQ(edges(schedule), row.edges) << row.what;
  }
}

TEST(ScheduleGraph, EmptyStagesAreNotMade) {
  Schedule schedule;
  schedule.add_barrier();
  const SystemId first = schedule.add("first", write_a);
  schedule.add_barrier();
  schedule.add_barrier();
  const SystemId second = schedule.add("second", write_a);
  EXPECT_EQ(schedule.stage(first), 0);
  EXPECT_EQ(schedule.stage(second), 1);
  EXPECT_EQ(schedule.name(second), "second");
}

TEST(ScheduleGraph, TimingRowsAreSystemsThenStagesWithCommands) {
  Schedule schedule;
  schedule.add("plain", write_a);
  schedule.add_barrier();
  schedule.add("spawn", command);
  ASSERT_EQ(schedule.timings().size(), 3u);
  EXPECT_EQ(schedule.timings()[0].name, "plain");
  EXPECT_EQ(schedule.timings()[1].name, "spawn");
  EXPECT_EQ(schedule.timings()[2].name, "apply commands");
  EXPECT_EQ(schedule.timings()[2].stage, 1);
}

Schedule printed() {
  Schedule schedule;
  schedule.add("write_a", write_a);
  schedule.add("read_a_write_b", read_a_write_b);
  schedule.add("say \"hi\"", read_clock);
  schedule.add_barrier();
  schedule.add("command", command);
  return schedule;
}

TEST(ScheduleGraph, Text) {
  EXPECT_EQ(printed().to_text(),
            "order  stage  system          access             waits for\n"
            "    0      0  write_a         writes A           -\n"
            "    1      0  read_a_write_b  reads A; writes B  write_a (A)\n"
            "    2      0  say \"hi\"        reads Clock        -\n"
            "       ----- barrier: commands are carried out\n"
            "    3      1  command         commands           -\n");
}

TEST(ScheduleGraph, Dot) {
  EXPECT_EQ(printed().to_dot(),
            "digraph schedule {\n"
            "  rankdir=LR;\n"
            "  node [shape=box];\n"
            "  subgraph cluster_0 {\n"
            "    label=\"stage 0\";\n"
            "    s0 [label=\"write_a\", tooltip=\"writes A\"];\n"
            "    s1 [label=\"read_a_write_b\", tooltip=\"reads A; writes B\"];\n"
            "    s2 [label=\"say \\\"hi\\\"\", tooltip=\"reads Clock\"];\n"
            "  }\n"
            "  subgraph cluster_1 {\n"
            "    label=\"stage 1\";\n"
            "    s3 [label=\"command\", tooltip=\"commands\"];\n"
            "  }\n"
            "  s0 -> s1 [label=\"A\"];\n"
            "}\n");
}

}  // namespace
}  // namespace fascicle::ecs
