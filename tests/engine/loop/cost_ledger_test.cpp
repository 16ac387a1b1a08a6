#include "engine/loop/cost_ledger.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/parallel/for_range.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "tests/support/allocation_counter.hpp"

namespace fascicle {
namespace {

const std::vector<std::string> kMuscles{"soleus", "gracilis"};
constexpr ecs::Entity kWalker{4, 0};
constexpr ecs::Entity kRunner{2, 7};

CostLedger make_ledger() {
  CostLedger ledger;
  ledger.add_system("solve");
  ledger.add_system("skin");
  ledger.add_owner(kWalker, "walker", kMuscles);
  ledger.add_owner(kRunner, "runner", {});
  ledger.set_enabled(true);
  return ledger;
}

TEST(CostLedger, OffItKeepsNothing) {
  CostLedger ledger = make_ledger();
  ledger.set_enabled(false);
  EXPECT_FALSE(ledger.enabled());
  EXPECT_FALSE(ledger.system("solve"));
  const CostRow row = ledger.system("solve").row(kWalker);
  EXPECT_FALSE(row);
  row.add(0, 100);
  row.add_whole(100);
  { const ScopedCost timer(row, 0); }
  ledger.end_frame();
  EXPECT_TRUE(ledger.statistics().empty());
}

TEST(CostLedger, UnknownSystemsOwnersAndItemsKeepNothing) {
  CostLedger ledger = make_ledger();
  EXPECT_FALSE(ledger.system("unknown"));
  EXPECT_FALSE(ledger.system("solve").row({9, 0}));
  EXPECT_FALSE(ledger.system("solve").row({kWalker.index, 1}));
  EXPECT_FALSE(ledger.system("solve").row(ecs::kNoEntity));
  ledger.add_owner(ecs::kNoEntity, "nobody", kMuscles);
  ledger.system("solve").row(kWalker).add(2, 100);  // one beyond the last
  ledger.system("solve").row(kWalker).add(0xffffffff, 100);
  ledger.system("solve").row(kRunner).add(0, 100);  // has no items
  ledger.end_frame();
  EXPECT_TRUE(ledger.statistics().empty());
}

TEST(CostLedger, Statistics) {
  CostLedger ledger = make_ledger();
  for (int frame = 0; frame < 4; ++frame) {
    const CostRow walker = ledger.system("solve").row(kWalker);
    walker.add(0, 1'000'000 * (frame + 1));
    walker.add(1, 500'000);
    walker.add(1, 500'000);  // adds up
    if (frame == 2) walker.add_whole(6'000'000);
    ledger.system("skin").row(kRunner).add_whole(2'000'000);
    ledger.end_frame();
  }
  const std::vector<ItemCost> rows = ledger.statistics();
  ASSERT_EQ(rows.size(), 4u);
  const auto expect = [&](std::size_t i, const std::string& name, double min, double mean, double max) {
    EXPECT_EQ(rows[i].system + "/" + rows[i].owner + "/" + rows[i].item, name);
    EXPECT_EQ(rows[i].frames, 4u);
    EXPECT_NEAR(rows[i].min_ms, min, 1e-9);
    EXPECT_NEAR(rows[i].mean_ms, mean, 1e-9);
    EXPECT_NEAR(rows[i].max_ms, max, 1e-9);
  };
  expect(0, "solve/walker/", 2, 5, 10);  // sums 2, 3, 4 + 6, 5
  expect(1, "solve/walker/soleus", 1, 2.5, 4);
  expect(2, "solve/walker/gracilis", 1, 1, 1);
  expect(3, "skin/runner/", 2, 2, 2);
}

TEST(CostLedger, WarmUpFramesAreLeftOut) {
  CostLedger ledger = make_ledger();
  ledger.system("solve").row(kWalker).add(0, 50'000'000);
  ledger.end_frame(true);
  ledger.system("solve").row(kWalker).add(0, 1'000'000);
  ledger.end_frame();
  const std::vector<ItemCost> rows = ledger.statistics();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].frames, 1u);
  EXPECT_NEAR(rows[1].max_ms, 1, 1e-9);
}

TEST(CostLedger, OwnersComeAndGo) {
  CostLedger ledger = make_ledger();
  ledger.remove_owner({9, 9});
  ledger.remove_owner(kWalker);
  EXPECT_FALSE(ledger.system("solve").row(kWalker));
  EXPECT_TRUE(ledger.system("solve").row(kRunner));
  const ecs::Entity again{kRunner.index, 8};  // the index reused, its old owner never taken out
  ledger.add_owner(again, "again", kMuscles);
  EXPECT_FALSE(ledger.system("solve").row(kRunner));
  ledger.system("solve").row(again).add(1, 1'000'000);
  ledger.end_frame();
  ASSERT_EQ(ledger.statistics().size(), 2u);
  EXPECT_EQ(ledger.statistics()[1].item, "gracilis");
}

TEST(CostLedger, ScopedCostMeasures) {
  CostLedger ledger = make_ledger();
  const CostRow row = ledger.system("solve").row(kWalker);
  {
    const ScopedCost timer(row, 1);
    const std::int64_t start = monotonic_ns();
    while (monotonic_ns() < start + 100'000) {
    }
  }
  { const ScopedCost timer(row, ScopedCost::kWhole); }
  ledger.end_frame();
  const std::vector<ItemCost> rows = ledger.statistics();
  ASSERT_GE(rows.size(), 2u);
  EXPECT_EQ(rows.back().item, "gracilis");
  EXPECT_GE(rows.back().mean_ms, 0.1);
}

// Cells side by side have different writers.
TEST(CostLedger, ManyThreadsWriteWithoutAllocating) {
  CostLedger ledger;
  const std::vector<std::string> items(64, "item");
  ledger.add_system("solve");
  ledger.add_owner(kWalker, "walker", items);
  ledger.set_enabled(true);
  const CostLedger& shared = ledger;
  parallel::WorkerArena arena(4);
  const auto frame = [&] {
    arena.execute([&] {
      const CostRow row = shared.system("solve").row(kWalker);
      parallel::for_range(items.size(), 1, [&](std::size_t begin, std::size_t) {
        row.add(static_cast<std::uint32_t>(begin), static_cast<std::int64_t>(begin));
      });
    });
    ledger.end_frame();
  };
  for (int i = 0; i < 10; ++i) frame();
  const test::AllocationScope scope;
  for (int i = 0; i < 10; ++i) frame();
  EXPECT_EQ(scope.allocations(), 0u);
  EXPECT_NEAR(ledger.statistics()[0].mean_ms, 63 * 64 / 2 * 1e-6, 1e-12);
}

}  // namespace
}  // namespace fascicle
