#include "engine/parallel/for_range.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

namespace fascicle::parallel::detail {

void run_chunks(std::size_t count, std::size_t grain, ChunkFunction function, void* body) {
  const std::size_t chunks = chunk_count(count, grain);
  const auto run = [=](std::size_t first, std::size_t last) {
    for (std::size_t chunk = first; chunk < last; ++chunk) {
      const std::size_t begin = chunk * grain;
      function(body, begin, std::min(begin + grain, count));
    }
  };
  if (tbb::this_task_arena::max_concurrency() == 1) {
    run(0, chunks);
    return;
  }
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunks),
        [&](const tbb::blocked_range<std::size_t>& range) { run(range.begin(), range.end()); },
        tbb::auto_partitioner());
  });
}

}  // namespace fascicle::parallel::detail
