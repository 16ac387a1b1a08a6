// The only parallel loop of the project. [0, count) is cut into fixed chunks of `grain` elements, whatever the number
// of workers, so that a body may keep per-chunk results and still give the same bits on any machine. The loop runs
// inside tbb::this_task_arena::isolate: while this thread waits for the last chunk it takes no foreign task, which
// would otherwise run another system inside the caller's and be counted as the caller's time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <type_traits>

#include "engine/parallel/handoff.hpp"

namespace fascicle::parallel {

namespace detail {
using ChunkFunction = void (*)(void* body, std::size_t begin, std::size_t end);
// Calls `function(body, begin, end)` once a chunk, in parallel. Kept out of line so that no header needs oneTBB.
// `function` must not throw.
void run_chunks(std::size_t count, std::size_t grain, ChunkFunction function, void* body);

// The exception of the chunk that begins lowest.
class FirstFailure {
 public:
  // In a catch block.
  void note(std::size_t begin);
  void rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
  }

 private:
  std::mutex mutex_;
  std::size_t begin_ = 0;
  std::exception_ptr exception_;
};
}  // namespace detail

// Calls f(begin, end) once for each chunk [k grain, min((k + 1) grain, count)), on the workers of the arena the caller
// runs in. Chunks may run at the same time and in any order: f writes only elements of its own chunk. With count <=
// grain the one chunk runs inline. A grain of 0 counts as 1. Exceptions of f do not stop the other chunks; that of the
// first chunk, if several throw, is rethrown at the end: which one does not depend on the workers. Costs about 1
// microsecond to start, so choose a grain worth several microseconds.
template <class F>
void for_range(std::size_t count, std::size_t grain, F&& f) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  if (count <= grain) {
    f(std::size_t{0}, count);
    return;
  }
  // Workers reach everything through `body`, and its handoffs before anything else in it.
  struct Body {
    std::remove_reference_t<F>* function;
    detail::FirstFailure failure;
    Handoff start, finish;
  };
  Body body{std::addressof(f), {}, {}, {}};
  body.start.send();
  const auto run = [](void* context, std::size_t begin, std::size_t end) {
    Body& shared = *static_cast<Body*>(context);
    shared.start.receive();
    try {
      (*shared.function)(begin, end);
    } catch (...) {
      shared.failure.note(begin);
    }
    shared.finish.send();
  };
  detail::run_chunks(count, grain, run, &body);
  body.finish.receive();
  body.failure.rethrow();
}

// Number of chunks for_range makes of `count` elements.
inline std::size_t chunk_count(std::size_t count, std::size_t grain) {
  grain = std::max<std::size_t>(grain, 1);
  return count / grain + (count % grain != 0 ? 1 : 0);
}

}  // namespace fascicle::parallel
