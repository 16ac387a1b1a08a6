// Tasks that start tasks: what a graph of systems runs on. A thin cover over tbb::task_group, so that no header and no
// other source needs oneTBB.
#pragma once

#include <cstddef>

namespace fascicle::parallel {

class TaskSet {
 public:
  using Function = void (*)(void* context, std::size_t index);

  TaskSet();
  // All tasks must have been waited for.
  ~TaskSet();
  TaskSet(const TaskSet&) = delete;
  TaskSet& operator=(const TaskSet&) = delete;

  // Calls function(context, index) some time on some worker of the caller's arena. From any thread, tasks of the set
  // among them. The function must not throw, and must begin by receiving what the starter sent (see handoff.hpp) if
  // the thread sanitizer is to see the order.
  void start(Function function, void* context, std::size_t index);
  // Runs tasks until none of the set is left.
  void wait();

 private:
  // Room for a tbb::task_group, so that making a set allocates nothing.
  static constexpr std::size_t kBytes = 256;
  alignas(128) std::byte storage_[kBytes];
};

}  // namespace fascicle::parallel
