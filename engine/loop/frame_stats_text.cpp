// How FrameStats prints itself.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "engine/content/file_text.hpp"
#include "engine/content/quote_json.hpp"
#include "engine/loop/frame_stats.hpp"
#include "engine/loop/quoted_csv.hpp"

namespace fascicle {

std::string_view to_text(RowKind kind) {
  switch (kind) {
    case RowKind::kFrame: return "frame";
    case RowKind::kSystem: return "system";
    case RowKind::kSpan: return "span";
    case RowKind::kGpu: return "gpu";
    case RowKind::kMeasuring: return "measuring";
  }
  return "";
}

std::string FrameStats::to_table() const {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{} frames, {} more left out as warm-up, {} catch-up steps dropped\n", frames(),
                 std::min<std::uint64_t>(begun_frames_, settings_.warm_up_frames), clamped_steps_);
  for (const auto& [name, value] : notes_) fmt::format_to(out, "{}: {}\n", name, value);

  const std::vector<RowSummary> rows = summaries();
  std::size_t width = 9;
  for (const RowSummary& row : rows) width = std::max(width, row.name.size());
  const double frame_ms = summary(kFrameRow).mean_ms;
  fmt::format_to(out, "\n{:<{}}  {:<9}  {:>7}  {:>9}  {:>9}  {:>9}  {:>9}  {:>9}  {:>9}  {:>6}\n", "time, ms", width,
                 "kind", "frames", "min", "mean", "p50", "p95", "p99", "max", "frame%");
  for (const RowSummary& row : rows) {
    fmt::format_to(out, "{:<{}}  {:<9}  {:>7}  {:>9.4f}  {:>9.4f}  {:>9.4f}  {:>9.4f}  {:>9.4f}  {:>9.4f}  {:>6.2f}\n",
                   row.name, width, to_text(row.kind), row.frames, row.min_ms, row.mean_ms, row.p50_ms, row.p95_ms,
                   row.p99_ms, row.max_ms, frame_ms > 0 ? 100 * row.mean_ms / frame_ms : 0.0);
  }
  fmt::format_to(out, "measuring itself takes {:.3f} % of the frame\n", measuring_percent());

  if (!item_rows_.empty()) {
    fmt::format_to(out, "\n{:<28}  {:<16}  {:<32}  {:>7}  {:>9}  {:>9}  {:>9}\n", "system", "owner", "item", "frames",
                   "min", "mean", "max");
    for (const ItemCost& row : item_rows_) {
      fmt::format_to(out, "{:<28}  {:<16}  {:<32}  {:>7}  {:>9.5f}  {:>9.5f}  {:>9.5f}\n", row.system, row.owner,
                     row.item.empty() ? "(all)" : row.item, row.frames, row.min_ms, row.mean_ms, row.max_ms);
    }
  }
  if (!memory_.empty()) {
    std::size_t total = 0;
    fmt::format_to(out, "\n{:<32}  {:>9}  {:>14}\n", "component", "count", "bytes");
    for (const ecs::ComponentMemory& component : memory_) {
      fmt::format_to(out, "{:<32}  {:>9}  {:>14}\n", component.name, component.count, component.bytes);
      total += component.bytes;
    }
    fmt::format_to(out, "{:<32}  {:>9}  {:>14}\n", "all", "", total);
  }
  return text;
}

std::string FrameStats::to_csv() const {
  std::string text = "kind,name,owner,item,frames,min_ms,mean_ms,p50_ms,p95_ms,p99_ms,max_ms,count,bytes,value\n";
  const auto out = std::back_inserter(text);
  for (const auto& [name, value] : notes_) {
    fmt::format_to(out, "note,{},,,,,,,,,,,,{}\n", quoted_csv(name), quoted_csv(value));
  }
  fmt::format_to(out, "counter,clamped_steps,,,,,,,,,,{},,\n", clamped_steps_);
  fmt::format_to(out, "counter,warm_up_frames,,,,,,,,,,{},,\n",
                 std::min<std::uint64_t>(begun_frames_, settings_.warm_up_frames));
  for (const RowSummary& row : summaries()) {
    fmt::format_to(out, "{},{},,,{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},,,\n", to_text(row.kind),
                   quoted_csv(row.name), row.frames, row.min_ms, row.mean_ms, row.p50_ms, row.p95_ms, row.p99_ms,
                   row.max_ms);
  }
  for (const ItemCost& row : item_rows_) {
    fmt::format_to(out, "item,{},{},{},{},{:.6f},{:.6f},,,,{:.6f},,,\n", quoted_csv(row.system), quoted_csv(row.owner),
                   quoted_csv(row.item), row.frames, row.min_ms, row.mean_ms, row.max_ms);
  }
  for (const ecs::ComponentMemory& component : memory_) {
    fmt::format_to(out, "memory,{},,,,,,,,,,{},{},\n", quoted_csv(component.name), component.count, component.bytes);
  }
  return text;
}

std::string FrameStats::to_json() const {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{{\n  \"frames\": {},\n  \"warm_up_frames\": {},\n  \"clamped_steps\": {},\n", frames(),
                 std::min<std::uint64_t>(begun_frames_, settings_.warm_up_frames), clamped_steps_);
  fmt::format_to(out, "  \"measuring_percent\": {:.6f},\n  \"notes\": {{", measuring_percent());
  const char* separator = "";
  for (const auto& [name, value] : notes_) {
    fmt::format_to(out, "{}\n    {}: {}", std::exchange(separator, ","), quote_json(name), quote_json(value));
  }
  text += "\n  },\n  \"rows\": [";
  separator = "";
  for (const RowSummary& row : summaries()) {
    fmt::format_to(out,
                   "{}\n    {{\"kind\": \"{}\", \"name\": {}, \"frames\": {}, \"min_ms\": {:.6f}, \"mean_ms\": {:.6f}, "
                   "\"p50_ms\": {:.6f}, \"p95_ms\": {:.6f}, \"p99_ms\": {:.6f}, \"max_ms\": {:.6f}}}",
                   std::exchange(separator, ","), to_text(row.kind), quote_json(row.name), row.frames, row.min_ms,
                   row.mean_ms, row.p50_ms, row.p95_ms, row.p99_ms, row.max_ms);
  }
  text += "\n  ],\n  \"items\": [";
  separator = "";
  for (const ItemCost& row : item_rows_) {
    fmt::format_to(out,
                   "{}\n    {{\"system\": {}, \"owner\": {}, \"item\": {}, \"frames\": {}, \"min_ms\": {:.6f}, "
                   "\"mean_ms\": {:.6f}, \"max_ms\": {:.6f}}}",
                   std::exchange(separator, ","), quote_json(row.system), quote_json(row.owner),
                   quote_json(row.item), row.frames, row.min_ms, row.mean_ms, row.max_ms);
  }
  text += "\n  ],\n  \"memory\": [";
  separator = "";
  for (const ecs::ComponentMemory& component : memory_) {
    fmt::format_to(out, "{}\n    {{\"component\": {}, \"count\": {}, \"bytes\": {}}}", std::exchange(separator, ","),
                   quote_json(component.name), component.count, component.bytes);
  }
  return text + "\n  ]\n}\n";
}

Diagnostics FrameStats::write(const std::filesystem::path& path) const {
  const std::filesystem::path extension = path.extension();
  if (extension == ".csv") return write_text_atomically(path, to_csv());
  if (extension == ".json") return write_text_atomically(path, to_json());
  return write_text_atomically(path, to_table());
}

}  // namespace fascicle
