#include "engine/loop/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/content/file_text.hpp"
#include "engine/content/quote_json.hpp"
#include "engine/ecs/monotonic_clock.hpp"

namespace fascicle {

namespace {

constexpr int kProcess = 1;

// The format's unit is the microsecond.
double to_us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

}  // namespace

Trace::Trace(std::size_t max_events) : origin_ns_(monotonic_ns()), max_events_(max_events) {
  events_.reserve(max_events);
}

std::uint32_t Trace::intern(std::string_view text) {
  const auto known = number_of_.find(text);
  if (known != number_of_.end()) return known->second;
  const auto added = number_of_.emplace(std::string(text), static_cast<std::uint32_t>(texts_.size())).first;
  texts_.push_back(&added->first);
  return added->second;
}

Trace::Event* Trace::append() {
  if (events_.size() >= max_events_) {
    ++dropped_;
    return nullptr;
  }
  return &events_.emplace_back();
}

void Trace::set_thread_name(int thread, std::string_view name) { thread_names_[thread] = std::string(name); }

void Trace::ensure_thread_name(int thread) {
  if (thread_names_.find(thread) != thread_names_.end()) return;
  thread_names_[thread] = thread == kFrameThread ? "frames"
                          : thread == kGpuThread ? "GPU"
                                                 : fmt::format("worker {}", thread);
}

void Trace::add_complete(std::string_view name, std::string_view category, std::int64_t start_ns, std::int64_t end_ns,
                         int thread) {
  ensure_thread_name(thread);
  Event* event = append();
  if (event == nullptr) return;
  event->kind = Kind::kComplete;
  event->name = intern(name);
  event->category = intern(category);
  event->start_ns = start_ns;
  event->duration_ns = std::max<std::int64_t>(end_ns - start_ns, 0);
  event->thread = thread;
}

void Trace::add_counter(std::string_view name, std::int64_t time_ns, double value) {
  Event* event = append();
  if (event == nullptr) return;
  event->kind = Kind::kCounter;
  event->name = intern(name);
  event->start_ns = time_ns;
  event->value = std::isfinite(value) ? value : 0.0;  // JSON knows no other numbers
  event->thread = 0;
}

void Trace::add_frame(std::uint64_t frame, std::int64_t start_ns, std::int64_t end_ns) {
  add_complete("frame", "frame", start_ns, end_ns, kFrameThread);
  Event* event = append();
  if (event == nullptr) return;
  event->kind = Kind::kMark;
  event->name = intern("frame");
  event->start_ns = start_ns;
  event->frame = frame;
  event->thread = kFrameThread;
}

void Trace::record(std::span<const ecs::SystemTiming> timings) {
  for (const ecs::SystemTiming& timing : timings) {
    if (timing.end_ns > timing.start_ns) {
      add_complete(timing.name, "system", timing.start_ns, timing.end_ns, timing.worker);
    }
  }
}

std::string Trace::to_json() const {
  std::vector<std::string> quoted;
  for (const std::string* text : texts_) quoted.push_back(quote_json(*text));

  std::string text = fmt::format(
      "{{\"displayTimeUnit\":\"ms\",\"otherData\":{{\"dropped_events\":\"{}\"}},\"traceEvents\":[\n"
      "{{\"ph\":\"M\",\"name\":\"process_name\",\"pid\":{},\"tid\":0,\"args\":{{\"name\":\"fascicle\"}}}}",
      dropped_, kProcess);
  text.reserve(text.size() + events_.size() * 112);
  const auto out = std::back_inserter(text);
  for (const auto& [thread, name] : thread_names_) {
    fmt::format_to(out,
                   ",\n{{\"ph\":\"M\",\"name\":\"thread_name\",\"pid\":{0},\"tid\":{1},"
                   "\"args\":{{\"name\":{2}}}}}",
                   kProcess, thread, quote_json(name));
    fmt::format_to(out,
                   ",\n{{\"ph\":\"M\",\"name\":\"thread_sort_index\",\"pid\":{0},\"tid\":{1},"
                   "\"args\":{{\"sort_index\":{1}}}}}",
                   kProcess, thread);
  }
  for (const Event& event : events_) {
    const double start = to_us(event.start_ns - origin_ns_);
    switch (event.kind) {
      case Kind::kComplete:
        fmt::format_to(out,
                       ",\n{{\"ph\":\"X\",\"name\":{},\"cat\":{},\"pid\":{},\"tid\":{},\"ts\":{:.3f},\"dur\":{:.3f}}}",
                       quoted[event.name], quoted[event.category], kProcess, event.thread, start,
                       to_us(event.duration_ns));
        break;
      case Kind::kCounter:
        fmt::format_to(out,
                       ",\n{{\"ph\":\"C\",\"name\":{},\"pid\":{},\"tid\":0,\"ts\":{:.3f},"
                       "\"args\":{{\"value\":{}}}}}",
                       quoted[event.name], kProcess, start, event.value);
        break;
      case Kind::kMark:
        fmt::format_to(out,
                       ",\n{{\"ph\":\"i\",\"name\":\"frame {0}\",\"cat\":\"frame\",\"s\":\"g\",\"pid\":{1},"
                       "\"tid\":{2},\"ts\":{3:.3f},\"args\":{{\"frame\":{0}}}}}",
                       event.frame, kProcess, event.thread, start);
        break;
    }
  }
  return text + "\n]}\n";
}

Diagnostics Trace::write(const std::filesystem::path& path) const { return write_text_atomically(path, to_json()); }

}  // namespace fascicle
