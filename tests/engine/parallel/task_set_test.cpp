#include "engine/parallel/task_set.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>

#include "engine/parallel/handoff.hpp"
#include "engine/parallel/worker_arena.hpp"

namespace fascicle::parallel {
namespace {

// A binary tree of tasks: each starts its two children.
struct Tree {
  static constexpr std::size_t kNodes = 255;
  Handoff made;  // the tree is complete
  TaskSet tasks;
  std::array<std::atomic<int>, kNodes> visits{};

  static void visit(void* context, std::size_t index) {
    Tree& tree = *static_cast<Tree*>(context);
    tree.made.receive();
    ++tree.visits[index];
    for (const std::size_t child : {2 * index + 1, 2 * index + 2}) {
      if (child < kNodes) tree.tasks.start(visit, &tree, child);
    }
  }
};

TEST(TaskSet, WaitsForNothing) {
  TaskSet tasks;
  tasks.wait();
}

TEST(TaskSet, TasksStartTasksAndAllAreWaitedFor) {
  for (const int workers : {1, 2, 3, 8}) {
    WorkerArena arena(workers);
    Tree tree;
    tree.made.send();
    for (int round = 1; round <= 5; ++round) {
      arena.execute([&] {
        tree.tasks.start(Tree::visit, &tree, 0);
        tree.tasks.wait();
      });
      for (const std::atomic<int>& visits : tree.visits) ASSERT_EQ(visits.load(), round);
    }
  }
}

}  // namespace
}  // namespace fascicle::parallel
