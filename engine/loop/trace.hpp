// A recording of what ran when, in the Trace Event format that Perfetto and chrome://tracing open: complete events,
// counters, thread names and frame marks. Memory is bounded: when `max_events` are recorded, later ones are dropped and
// counted in the file. Recording an event whose name is known allocates nothing. For one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/content/result.hpp"
#include "engine/ecs/schedule.hpp"

namespace fascicle {

class Trace {
 public:
  // Threads of the trace that are no workers.
  static constexpr int kFrameThread = 1000;  // frames as events
  static constexpr int kGpuThread = 1001;

  explicit Trace(std::size_t max_events = std::size_t{1} << 20);

  // Times are monotonic_ns() values; the file counts from the trace's construction.
  void add_complete(std::string_view name, std::string_view category, std::int64_t start_ns, std::int64_t end_ns,
                    int thread);
  void add_counter(std::string_view name, std::int64_t time_ns, double value);
  // An instant mark over all threads, and the frame as an event on a thread of its own.
  void add_frame(std::uint64_t frame, std::int64_t start_ns, std::int64_t end_ns);
  void set_thread_name(int thread, std::string_view name);

  // The last run of a schedule: one complete event a system, on the worker that ran it.
  void record(std::span<const ecs::SystemTiming> timings);

  std::size_t size() const { return events_.size(); }
  std::uint64_t dropped() const { return dropped_; }

  std::string to_json() const;
  // Whole or not at all.
  [[nodiscard]] Diagnostics write(const std::filesystem::path& path) const;

 private:
  enum class Kind : std::uint8_t { kComplete, kCounter, kMark };
  struct Event {
    std::int64_t start_ns;
    union {
      std::int64_t duration_ns;  // complete
      double value;              // counter
      std::uint64_t frame;       // mark
    };
    std::uint32_t name;
    std::uint32_t category;
    int thread;
    Kind kind;
  };

  std::uint32_t intern(std::string_view text);
  Event* append();
  void ensure_thread_name(int thread);

  std::int64_t origin_ns_;
  std::size_t max_events_;
  std::uint64_t dropped_ = 0;
  std::vector<Event> events_;
  std::map<std::string, std::uint32_t, std::less<>> number_of_;
  std::vector<const std::string*> texts_;  // keys of number_of_, which stay where they are
  std::map<int, std::string> thread_names_;
};

}  // namespace fascicle
