// What a run leaves behind: statistics, trace, report, hash and the screenshot, each where it was asked for. The same
// for a window and for a headless run.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/loop/frame_stats.hpp"
#include "engine/loop/trace.hpp"
#include "engine/render/renderer.hpp"
#include "game/collision_stats.hpp"
#include "game/game_options.hpp"
#include "game/penetration_report.hpp"
#include "game/report.hpp"
#include "game/simulation.hpp"
#include "game/surface_figures.hpp"
#include "game/surface_stats.hpp"

namespace fascicle::game {

class RunRecorder {
 public:
  // `total_frames`: how long the run will be; 0 where nobody knows.
  RunRecorder(const GameOptions& options, Simulation& simulation, std::uint64_t total_frames);

  // Rows per character and muscle, where they were asked for: again after the characters were spawned anew.
  void announce_items(Simulation& simulation);

  // In this order: begin_frame, record_step after each step, record_draw after drawing (if any), end_frame.
  void begin_frame();
  void record_step(Simulation& simulation);
  void record_draw(std::int64_t start_ns, std::int64_t end_ns, Renderer& renderer);
  void end_frame(const Simulation& simulation);

  // Whether this step's picture was asked for, and writing it.
  bool wants_picture(const Simulation& simulation, bool is_last) const;
  void write_picture(const Image& image);

  // Writes the files and prints what goes to the terminal. Returns the program's exit status.
  int finish(Simulation& simulation);

  const FrameStats& stats() const { return stats_; }
  const CollisionStats& collision() const { return collision_; }

 private:
  const GameOptions& options_;
  FrameStats stats_;
  CollisionStats collision_;
  SurfaceStats surface_stats_;
  std::optional<Trace> trace_;
  Report report_;
  PenetrationReport penetration_;
  SurfaceMeters surfaces_;
  std::int64_t frame_start_ns_ = 0;
  std::uint64_t frames_ = 0;
  std::uint64_t gpu_frame_ = 0;  // newest GPU measurement taken into the statistics
  bool picture_written_ = false;
  bool picture_failed_ = false;
};

}  // namespace fascicle::game
