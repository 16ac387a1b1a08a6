#include "engine/parallel/worker_arena.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <optional>
#include <thread>

namespace fascicle::parallel {

namespace {

// oneTBB never makes more threads than the smallest limit any living global_control asks for. All arenas that want
// more threads than cores therefore ask for one common, generous limit; threads are made only when an arena needs them.
constexpr int kThreadLimit = 256;

// How long a new arena waits for its threads. They come in well under a millisecond each; should some not come, because
// the system has no more to give, the arena works with fewer.
constexpr std::chrono::milliseconds kStartPatience{1000};

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
  if (workers_ > 1) start_threads();
}

void WorkerArena::start_threads() {
  std::atomic<int> here = 0;
  const auto patience = std::chrono::steady_clock::now() + kStartPatience;
  const auto meet = [&] {
    here.fetch_add(1);
    while (here.load() < workers_ && std::chrono::steady_clock::now() < patience) std::this_thread::yield();
  };
  threads_->arena.execute([&] {
    tbb::task_group group;
    for (int i = 1; i < workers_; ++i) group.run(meet);
    meet();
    group.wait();
  });
}

WorkerArena::~WorkerArena() = default;

void WorkerArena::execute_erased(void (*function)(void*), void* context) {
  threads_->arena.execute([=] { function(context); });
}

int hardware_workers() { return std::max(1, static_cast<int>(tbb::info::default_concurrency())); }

int current_worker() { return std::max(0, tbb::this_task_arena::current_thread_index()); }

}  // namespace fascicle::parallel
