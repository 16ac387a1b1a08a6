// Time that the graphics card spends in each pass of a frame, by timer queries. Results are read frames later, when
// they are ready, so that measuring never waits for the card.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fascicle {

struct GpuTime {
  std::string name;
  double milliseconds = 0.0;
};

class GpuTimer {
 public:
  GpuTimer() = default;
  ~GpuTimer();
  GpuTimer(const GpuTimer&) = delete;
  GpuTimer& operator=(const GpuTimer&) = delete;

  // Ends the last frame, collects results that are ready and starts a frame. One whose slot is still pending is not
  // measured.
  void begin_frame();
  // Passes follow each other, they don't nest. `name` must be the same object in every frame (a literal).
  void begin_pass(const char* name);
  void end_pass();
  void end_frame();

  // The newest complete frame's passes in order, and its number as counted by begin_frame (0: none yet).
  std::span<const GpuTime> times() const { return times_; }
  std::uint64_t measured_frame() const { return measured_frame_; }
  // Frames that could not be measured because all slots were pending.
  std::uint64_t skipped_frames() const { return skipped_; }

 private:
  static constexpr std::size_t kSlots = 5;
  struct Pass {
    const char* name = nullptr;
    std::uint32_t queries[2] = {0, 0};  // GL timestamp queries: begin, end
  };
  struct Slot {
    std::vector<Pass> passes;
    std::size_t used = 0;
    std::uint64_t frame = 0;
    bool pending = false;
  };
  void collect();

  Slot slots_[kSlots];
  std::size_t current_ = 0;
  bool recording_ = false;
  std::uint64_t frame_ = 0;
  std::uint64_t measured_frame_ = 0;
  std::uint64_t skipped_ = 0;
  std::vector<GpuTime> times_;
};

}  // namespace fascicle
