// The fixed-step loop. Wall time comes in, whole simulation steps come out; what is left over says how far the picture
// lies between the last two steps. When a frame took so long that more than `max_catch_up_steps` are due, the rest is
// dropped and counted: the simulation then runs slower than the clock instead of falling ever further behind.
//
//   const int steps = loop.begin_frame(seconds_since_last_frame);
//   for (int i = 0; i < steps; ++i) { world.resource<FrameTime>() = loop.advance(); schedule.run(world, arena); }
//   world.resource<FrameTime>() = loop.time();   // with this frame's alpha
#pragma once

#include <cstdint>

#include "engine/loop/frame_time.hpp"

namespace fascicle {

class FrameLoop {
 public:
  // `step_seconds` > 0 and finite; `max_catch_up_steps` >= 1 (asserted).
  FrameLoop(float step_seconds, int max_catch_up_steps);

  // `wall_seconds`: time since the last call. Returns the number of steps to run now. A negative, infinite or NaN time
  // counts as none and is counted. While paused only requested single steps come out.
  int begin_frame(double wall_seconds);

  // Begins a step: FrameTime with the step's number and the simulated time at its end.
  const FrameTime& advance();
  // As of the last step, with alpha, time scale and pause of the last begin_frame.
  const FrameTime& time() const { return time_; }

  float alpha() const { return time_.alpha; }
  std::uint64_t clamped_steps() const { return clamped_steps_; }      // steps due but dropped
  std::uint64_t clamped_frames() const { return clamped_frames_; }    // frames in which that happened
  std::uint64_t rejected_times() const { return rejected_times_; }    // frames with a senseless wall time

  void set_paused(bool paused) { time_.paused = paused; }
  bool paused() const { return time_.paused; }
  // One step at the next begin_frame although paused; requests add up.
  void request_single_step() { ++single_steps_; }
  // Another step length from now on, > 0 and finite (asserted); the simulated time so far stays.
  void set_step(float step_seconds);
  // Simulated seconds per wall second, at least 0; anything else is refused and false returned.
  bool set_time_scale(float scale);

 private:
  FrameTime time_;
  double due_ = 0;   // simulated time not yet stepped, s
  double base_ = 0;  // simulated time when the step length was last set, s
  std::uint64_t base_steps_ = 0;  // and the steps until then
  int max_catch_up_steps_;
  int single_steps_ = 0;
  std::uint64_t steps_ = 0;
  std::uint64_t clamped_steps_ = 0;
  std::uint64_t clamped_frames_ = 0;
  std::uint64_t rejected_times_ = 0;
};

}  // namespace fascicle
