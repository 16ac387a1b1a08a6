// What a run's surface muscles came to: vertices, contacts with bones, volume and fallbacks of each, and how many steps
// its coarse hull posed it. For the statistics' text.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/ecs/entity.hpp"
#include "game/simulation.hpp"

namespace fascicle::game {

class SurfaceStats {
 public:
  // After a step.
  void record(const Simulation& simulation);

  bool any() const { return !rows_.empty(); }
  std::string to_table() const;  // a row a muscle; empty where there is none

 private:
  struct Row {
    ecs::Entity entity;                         // of the last spawn
    std::string owner, muscle;
    std::uint32_t vertices = 0;
    std::uint64_t steps = 0, fallbacks = 0;
    double held = 0.0;                          // vertices held at bones, sum over the steps
    float depth = 0.0f;                         // m: the furthest that one was pushed
    double least_volume = 1.0, most_volume = 1.0;  // to rest
    std::uint64_t posed = 0, iterations = 0;    // steps that its hull posed it, and Gauss-Newton's iterations in these
  };

  std::vector<Row> rows_;  // in the order of their spawning; begun anew by a reload
};

}  // namespace fascicle::game
