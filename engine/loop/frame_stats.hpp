// Where the time of a frame goes, over a run: a row for the frame itself, one a system, one for anything else measured
// on the CPU, one a GPU timer, and one for the measuring. Every frame after the warm-up counts.
//
//   stats.begin_frame();
//   for each step { schedule.run(world, arena); stats.record(schedule.timings()); }   // steps of a frame add up
//   stats.record_span("draw", ns);  stats.record_gpu("muscles", ns);
//   stats.end_frame();
//
// Memory is bounded: a row keeps its last `window_frames` samples, from which its percentiles and history come; count,
// minimum, mean and maximum are of the whole run. A row takes its memory when it first appears; a frame that brings no
// new row allocates nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/content/result.hpp"
#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "engine/loop/sample_window.hpp"

namespace fascicle {

struct FrameStatsSettings {
  std::size_t warm_up_frames = 10;   // left out of all rows
  std::size_t window_frames = 4096;  // samples a row keeps
};

enum class RowKind { kFrame, kSystem, kSpan, kGpu, kMeasuring };

// Milliseconds a frame, over the frames in which the row appeared.
struct RowSummary {
  std::string name;
  RowKind kind = RowKind::kSystem;
  std::uint64_t frames = 0;
  double min_ms = 0, mean_ms = 0, p50_ms = 0, p95_ms = 0, p99_ms = 0, max_ms = 0;
};

class FrameStats {
 public:
  explicit FrameStats(FrameStatsSettings settings = {});

  void begin_frame();
  // One row a system: the timings of a schedule's last run.
  void record(std::span<const ecs::SystemTiming> timings);
  // Other work on the CPU, in nanoseconds.
  void record_span(std::string_view name, std::int64_t ns);
  // A GPU timer, in nanoseconds; counts to the frame in which its result arrives.
  void record_gpu(std::string_view name, std::int64_t ns);
  void end_frame();

  // Total of FrameLoop::clamped_steps().
  void set_clamped_steps(std::uint64_t total) { clamped_steps_ = total; }
  void set_memory(std::vector<ecs::ComponentMemory> memory) { memory_ = std::move(memory); }
  // Rows per character and per item (CostLedger::statistics), replacing the last ones.
  void add_rows(std::vector<ItemCost> rows) { item_rows_ = std::move(rows); }
  // A line at the head of the output: workers, SIMD level, scene. The same name again replaces the value.
  void set_note(std::string_view name, std::string value);

  // Whether the current frame is left out of the statistics.
  bool warming_up() const { return begun_frames_ <= settings_.warm_up_frames; }
  std::uint64_t frames() const;  // counted, without the warm-up
  std::uint64_t clamped_steps() const { return clamped_steps_; }

  // Rows in order of first appearance; the frame itself is row 0, the measuring row 1.
  std::size_t row_count() const { return rows_.size(); }
  std::string_view row_name(std::size_t row) const { return rows_[row].name; }
  RowKind row_kind(std::size_t row) const { return rows_[row].kind; }
  std::optional<std::size_t> find_row(std::string_view name) const;
  // Sorts the row's samples: not for every row in every frame.
  RowSummary summary(std::size_t row) const;
  // All rows as the outputs list them: the frame, systems, spans, GPU, measuring.
  std::vector<RowSummary> summaries() const;

  // The last samples of a row in ms, oldest first, for a graph; at most window_frames. Empty for an unknown name.
  std::span<const float> history(std::size_t row) const { return rows_[row].window.values(); }
  std::span<const float> history(std::string_view system) const;

  // Time spent on measuring: recording, and the clock readings of the schedule, as a share of the frame in %.
  double measuring_percent() const;

  // A table for people; one table with a header for programs; an object.
  std::string to_table() const;
  std::string to_csv() const;
  std::string to_json() const;
  // By the extension of `path`: .csv, .json, anything else the table. Whole or not at all.
  [[nodiscard]] Diagnostics write(const std::filesystem::path& path) const;

 private:
  struct Row {
    std::string name;
    RowKind kind;
    SampleWindow window;
    std::int64_t frame_ns = 0;  // of the current frame
    bool touched = false;
    std::uint64_t frames = 0;
    double sum_ms = 0;
    float min_ms = 0;
    float max_ms = 0;
  };

  static constexpr std::size_t kFrameRow = 0;
  static constexpr std::size_t kMeasuringRow = 1;

  Row& find_or_add(RowKind kind, std::string_view name);
  void add(RowKind kind, std::string_view name, std::int64_t ns);
  void add_measuring(std::int64_t start_ns, std::size_t clock_readings);

  FrameStatsSettings settings_;
  std::vector<Row> rows_;
  std::size_t next_row_ = 0;  // where find_or_add looks first: rows come in the same order in every frame
  std::uint64_t begun_frames_ = 0;
  std::int64_t frame_start_ns_ = 0;
  std::int64_t carried_measuring_ns_ = 0;  // of the last end_frame, which ended after its own row was closed
  double clock_ns_ = 0;                    // what one reading of the clock takes
  std::uint64_t clamped_steps_ = 0;
  std::vector<ecs::ComponentMemory> memory_;
  std::vector<ItemCost> item_rows_;
  std::vector<std::pair<std::string, std::string>> notes_;
};

std::string_view to_text(RowKind kind);

}  // namespace fascicle
