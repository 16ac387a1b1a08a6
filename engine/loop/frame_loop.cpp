#include "engine/loop/frame_loop.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace fascicle {

namespace {
constexpr double kMostSteps = 1e9;
}  // namespace

FrameLoop::FrameLoop(float step_seconds, int max_catch_up_steps) : max_catch_up_steps_(max_catch_up_steps) {
  assert(step_seconds > 0 && std::isfinite(step_seconds));
  assert(max_catch_up_steps >= 1);
  time_.step = step_seconds;
}

int FrameLoop::begin_frame(double wall_seconds) {
  if (!(wall_seconds >= 0) || !std::isfinite(wall_seconds)) {
    ++rejected_times_;
    wall_seconds = 0;
  }
  const int requested = std::exchange(single_steps_, 0);
  if (time_.paused) return std::min(requested, max_catch_up_steps_);

  const double step = time_.step;
  // Beyond kMostSteps a wall time means "for ever", and the arithmetic would no longer be exact.
  due_ = std::min(due_ + wall_seconds * static_cast<double>(time_.time_scale), kMostSteps * step);
  const double whole = std::floor(due_ / step);
  due_ = std::max(0.0, due_ - whole * step);
  const double steps = std::min(whole, static_cast<double>(max_catch_up_steps_));
  if (whole > steps) {
    ++clamped_frames_;
    clamped_steps_ += static_cast<std::uint64_t>(whole - steps);
  }
  time_.alpha = std::clamp(static_cast<float>(due_ / step), 0.0F, 1.0F);
  return static_cast<int>(steps);
}

const FrameTime& FrameLoop::advance() {
  time_.frame = steps_++;
  // A product, not a sum: no rounding builds up over the hours.
  time_.time = base_ + static_cast<double>(steps_ - base_steps_) * static_cast<double>(time_.step);
  return time_;
}

void FrameLoop::set_step(float step_seconds) {
  assert(step_seconds > 0 && std::isfinite(step_seconds));
  if (step_seconds == time_.step) return;
  base_ = time_.time;
  base_steps_ = steps_;
  time_.step = step_seconds;
}

bool FrameLoop::set_time_scale(float scale) {
  if (!(scale >= 0) || !std::isfinite(scale)) return false;
  time_.time_scale = scale;
  return true;
}

}  // namespace fascicle
