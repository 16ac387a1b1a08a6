// The workers of a program, in a number that is said and not guessed: a oneTBB arena of exactly that many threads, the
// calling one among them, even where the machine has fewer cores. Everything parallel runs inside execute().
#pragma once

#include <memory>
#include <type_traits>

namespace fascicle::parallel {

class WorkerArena {
 public:
  // `workers` at least 1; 0 asks for one per core. More than the cores is allowed (tests of determinism do it). Starts
  // the threads and waits until they are there, so that no frame has to.
  explicit WorkerArena(int workers);
  ~WorkerArena();
  WorkerArena(const WorkerArena&) = delete;
  WorkerArena& operator=(const WorkerArena&) = delete;

  int workers() const { return workers_; }

  // Runs f() in the arena on the calling thread and returns when it has. Loops inside use at most workers() threads.
  // Exceptions of f come out. Nested calls are cheap.
  template <class F>
  void execute(F&& f) {
    using Function = std::remove_reference_t<F>;
    execute_erased([](void* context) { (*static_cast<Function*>(context))(); },
                   const_cast<void*>(static_cast<const void*>(std::addressof(f))));
  }

 private:
  struct Threads;

  void start_threads();
  void execute_erased(void (*function)(void*), void* context);

  int workers_;
  std::unique_ptr<Threads> threads_;
};

// Number of cores the process may use.
int hardware_workers();

// Index of the calling thread in its arena: 0 .. workers() - 1; 0 outside any.
int current_worker();

}  // namespace fascicle::parallel
