#include "engine/loop/frame_stats.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/ecs/monotonic_clock.hpp"

namespace fascicle {

namespace {

// The quickest of several tries: what disturbs a try only makes it longer.
double measure_clock_ns() {
  constexpr int kTries = 8;
  constexpr int kReadings = 64;
  std::int64_t best = std::numeric_limits<std::int64_t>::max();
  for (int i = 0; i < kTries; ++i) {
    const std::int64_t start = monotonic_ns();
    std::int64_t end = start;
    for (int k = 0; k < kReadings; ++k) end = monotonic_ns();
    best = std::min(best, end - start);
  }
  return static_cast<double>(best) / kReadings;
}

}  // namespace

FrameStats::FrameStats(FrameStatsSettings settings) : settings_(settings), clock_ns_(measure_clock_ns()) {
  rows_.reserve(64);
  find_or_add(RowKind::kFrame, "frame");
  find_or_add(RowKind::kMeasuring, "measuring");
}

FrameStats::Row& FrameStats::find_or_add(RowKind kind, std::string_view name) {
  const std::size_t count = rows_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = (next_row_ + i) % count;
    if (rows_[place].kind == kind && rows_[place].name == name) {
      next_row_ = place + 1;
      return rows_[place];
    }
  }
  rows_.push_back({std::string(name), kind, SampleWindow(settings_.window_frames)});
  next_row_ = 0;
  return rows_.back();
}

void FrameStats::add(RowKind kind, std::string_view name, std::int64_t ns) {
  Row& row = find_or_add(kind, name);
  row.frame_ns += std::max<std::int64_t>(ns, 0);
  row.touched = true;
}

void FrameStats::add_measuring(std::int64_t start_ns, std::size_t clock_readings) {
  Row& row = rows_[kMeasuringRow];
  const double readings_ns = clock_ns_ * static_cast<double>(clock_readings);
  row.frame_ns += monotonic_ns() - start_ns + static_cast<std::int64_t>(readings_ns);
  row.touched = true;
}

void FrameStats::begin_frame() {
  ++begun_frames_;
  next_row_ = 0;
  for (Row& row : rows_) {
    row.frame_ns = 0;
    row.touched = false;
  }
  rows_[kMeasuringRow].frame_ns = std::exchange(carried_measuring_ns_, 0);
  frame_start_ns_ = monotonic_ns();
}

void FrameStats::record(std::span<const ecs::SystemTiming> timings) {
  const std::int64_t start = monotonic_ns();
  for (const ecs::SystemTiming& timing : timings) {
    // A system that was left out has no time and did not run.
    if (timing.end_ns > timing.start_ns) add(RowKind::kSystem, timing.name, timing.end_ns - timing.start_ns);
  }
  add_measuring(start, 2 * timings.size());
}

void FrameStats::record_span(std::string_view name, std::int64_t ns) {
  const std::int64_t start = monotonic_ns();
  add(RowKind::kSpan, name, ns);
  add_measuring(start, 2);
}

void FrameStats::record_gpu(std::string_view name, std::int64_t ns) {
  const std::int64_t start = monotonic_ns();
  add(RowKind::kGpu, name, ns);
  add_measuring(start, 2);
}

void FrameStats::end_frame() {
  const std::int64_t start = monotonic_ns();
  rows_[kFrameRow].frame_ns = start - frame_start_ns_;
  rows_[kFrameRow].touched = rows_[kMeasuringRow].touched = true;
  if (!warming_up()) {
    for (Row& row : rows_) {
      if (!row.touched) continue;
      const float ms = static_cast<float>(static_cast<double>(row.frame_ns) * 1e-6);
      row.window.push(ms);
      row.sum_ms += static_cast<double>(ms);
      row.min_ms = row.frames == 0 ? ms : std::min(row.min_ms, ms);
      row.max_ms = row.frames == 0 ? ms : std::max(row.max_ms, ms);
      ++row.frames;
    }
  }
  carried_measuring_ns_ = monotonic_ns() - start;
}

void FrameStats::set_note(std::string_view name, std::string value) {
  const auto found = std::find_if(notes_.begin(), notes_.end(), [&](const auto& note) { return note.first == name; });
  if (found != notes_.end()) {
    found->second = std::move(value);
  } else {
    notes_.emplace_back(std::string(name), std::move(value));
  }
}

std::uint64_t FrameStats::frames() const { return rows_[kFrameRow].frames; }

std::optional<std::size_t> FrameStats::find_row(std::string_view name) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].name == name) return i;
  }
  return std::nullopt;
}

RowSummary FrameStats::summary(std::size_t index) const {
  const Row& row = rows_[index];
  RowSummary result{row.name, row.kind, row.frames};
  if (row.frames == 0) return result;
  const std::span<const float> values = row.window.values();
  std::vector<float> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  result.min_ms = static_cast<double>(row.min_ms);
  result.mean_ms = row.sum_ms / static_cast<double>(row.frames);
  result.p50_ms = static_cast<double>(percentile(sorted, 50));
  result.p95_ms = static_cast<double>(percentile(sorted, 95));
  result.p99_ms = static_cast<double>(percentile(sorted, 99));
  result.max_ms = static_cast<double>(row.max_ms);
  return result;
}

std::vector<RowSummary> FrameStats::summaries() const {
  std::vector<RowSummary> result;
  for (std::size_t i = 0; i < rows_.size(); ++i) result.push_back(summary(i));
  std::stable_sort(result.begin(), result.end(),
                   [](const RowSummary& a, const RowSummary& b) { return a.kind < b.kind; });
  return result;
}

std::span<const float> FrameStats::history(std::string_view system) const {
  const std::optional<std::size_t> row = find_row(system);
  return row ? history(*row) : std::span<const float>();
}

double FrameStats::measuring_percent() const {
  const double frame = rows_[kFrameRow].sum_ms;
  return frame > 0 ? 100.0 * rows_[kMeasuringRow].sum_ms / frame : 0.0;
}

}  // namespace fascicle
