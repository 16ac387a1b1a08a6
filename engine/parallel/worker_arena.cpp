#include "engine/parallel/worker_arena.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cassert>
#include <optional>

namespace fascicle::parallel {

namespace {

// oneTBB never makes more threads than the smallest limit any living global_control asks for. All arenas that want
// more threads than cores therefore ask for one common, generous limit; threads are made only when an arena needs them.
constexpr int kThreadLimit = 256;

}  // namespace

struct WorkerArena::Threads {
  explicit Threads(int workers) : arena(workers) {
    if (workers > hardware_workers()) {
      limit.emplace(tbb::global_control::max_allowed_parallelism, std::max(kThreadLimit, workers));
    }
    arena.initialize();
  }
  std::optional<tbb::global_control> limit;
  tbb::task_arena arena;
};

WorkerArena::WorkerArena(int workers) : workers_(workers > 0 ? workers : hardware_workers()) {
  assert(workers >= 0);
  threads_ = std::make_unique<Threads>(workers_);
}

WorkerArena::~WorkerArena() = default;

void WorkerArena::execute_erased(void (*function)(void*), void* context) {
  threads_->arena.execute([=] { function(context); });
}

int hardware_workers() { return std::max(1, static_cast<int>(tbb::info::default_concurrency())); }

int current_worker() { return std::max(0, tbb::this_task_arena::current_thread_index()); }

}  // namespace fascicle::parallel
