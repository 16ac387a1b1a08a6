// The simulation's clock as systems see it: a resource that the frame loop writes before each step.
#pragma once

#include <cstdint>

namespace fascicle {

struct FrameTime {
  double time = 0;            // simulated time at the end of this step, s
  float step = 1.0F / 60.0F;  // length of a step, s; constant over a run, whatever the time scale
  std::uint64_t frame = 0;    // number of this step, counted from 0
  float alpha = 0;            // how far the picture lies between the last two steps, 0 .. 1; for presentation only
  float time_scale = 1;       // simulated seconds per wall second
  bool paused = false;
};

}  // namespace fascicle
