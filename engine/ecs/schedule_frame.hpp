// The inside of a Schedule, shared by the two sources that run it and print it. Not for users.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "engine/ecs/schedule.hpp"

namespace fascicle::ecs {

// One edge of the graph.
struct Dependency {
  std::size_t earlier = 0;
  std::vector<std::string_view> types;  // on which the two conflict
};

struct Schedule::Node {
  std::string name;
  Access access;
  std::unique_ptr<System> system;
  std::unique_ptr<Commands> commands;  // null when the system takes none
  int stage = 0;

  std::vector<Dependency> waits_for;    // transitively reduced, in order of registration
  std::vector<bool> comes_after;        // by system: whether it must end before this one starts
  std::vector<std::size_t> successors;  // the inverse of waits_for

  // State of one run. Written by workers, so on a cache line of its own.
  struct alignas(64) State {
    std::atomic<int> pending = 0;        // systems it still waits for
    std::atomic<bool> left_out = false;  // one of them failed
    std::exception_ptr failure;          // written by the worker that runs it, read after the stage
  };
  State state;
};

struct Stage {
  std::vector<std::size_t> systems;   // in order of registration
  std::vector<std::size_t> roots;     // those that wait for none
  std::vector<std::size_t> commands;  // those with commands
};

struct Schedule::Frame {
  std::vector<std::unique_ptr<Node>> nodes;
  std::vector<Stage> stages;
  std::vector<SystemTiming> timings;
  bool stage_open = false;
};

}  // namespace fascicle::ecs
