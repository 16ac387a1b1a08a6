// The order of a frame. Systems are added in the order in which they would run one after another; each waits for those
// added earlier with which it conflicts (see access.hpp), and for nothing else. So any run, on any number of workers,
// gives what the serial order gives, as long as systems touch only what their signatures declare.
//
// Barriers cut the frame into stages. All systems of a stage end before the next stage begins; in between the commands
// of its systems are carried out, in the order of registration. The end of the frame is a barrier.
//
// In a parallel run every system counts the systems it still waits for; the worker that ends the last of them goes on
// with it, and hands the others that became free to oneTBB. With one worker the systems run in order on the calling
// thread. Nothing is allocated in a frame but what commands need.
//
// A system that throws does not hang the frame: systems that wait for it, and later stages, are left out; the others
// of its stage run; the stage's commands are dropped; then run() rethrows, the exception of the first in registration
// order if there are several.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/ecs/access.hpp"
#include "engine/ecs/commands.hpp"
#include "engine/ecs/system.hpp"
#include "engine/ecs/world.hpp"
#include "engine/parallel/worker_arena.hpp"

namespace fascicle::ecs {

struct SystemId {
  std::uint32_t value = 0;  // number of registration, from 0
  friend bool operator==(const SystemId&, const SystemId&) = default;
};

// When one system ran in the last frame; monotonic_ns() values. A system that was left out has start == end.
struct SystemTiming {
  std::string_view name;  // lives as long as the schedule
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  int worker = 0;  // index of the thread in the arena
  int stage = 0;
};

class Schedule {
 public:
  Schedule();
  ~Schedule();
  Schedule(Schedule&&) noexcept;
  Schedule& operator=(Schedule&&) noexcept;

  // `system`: a function, lambda or function object whose parameters are View<...>, Resource<T> or Commands&.
  template <class F>
  SystemId add(std::string name, F system) {
    using Stored = SystemOf<std::decay_t<F>>;
    return add_system(std::move(name), Stored::access(), std::make_unique<Stored>(std::move(system)));
  }

  // Ends the stage. Nothing happens when the stage is empty.
  void add_barrier();

  void run(World& world, parallel::WorkerArena& arena);

  std::size_t size() const;
  std::string_view name(SystemId id) const;
  int stage(SystemId id) const;
  // The systems of the same stage that must end before this one starts, without those implied by others.
  std::vector<SystemId> waits_for(SystemId id) const;

  // One row a system in order of registration, then one a stage that has commands ("apply commands", with the stage's
  // number). Values of the last run; the span holds until a system is added.
  std::span<const SystemTiming> timings() const;

  // A table: order, stage, name, access, waits for which.
  std::string to_text() const;
  // A graph for Graphviz, a cluster a stage, edges labelled with the types in conflict.
  std::string to_dot() const;

 private:
  friend class ScheduleRun;
  struct Node;
  struct Frame;

  SystemId add_system(std::string name, Access access, std::unique_ptr<System> system);

  std::unique_ptr<Frame> frame_;
};

}  // namespace fascicle::ecs
