#include "game/report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "engine/content/quote_json.hpp"

namespace fascicle::game {
void Report::begin_frame() {
  ++frames_;
  for (Metric& metric : metrics_) metric.values.resize(frames_, std::numeric_limits<double>::quiet_NaN());
}

void Report::record(std::string_view name, double value) {
  auto metric = std::find_if(metrics_.begin(), metrics_.end(), [&](const Metric& m) { return m.name == name; });
  if (metric == metrics_.end()) {
    metrics_.push_back({std::string(name), std::vector<double>(frames_, std::numeric_limits<double>::quiet_NaN())});
    metric = std::prev(metrics_.end());
  }
  if (frames_ > 0) metric->values[frames_ - 1] = value;
}

std::string Report::to_json(std::string_view scene, std::uint64_t hash) const {
  std::string out = fmt::format("{{\n  \"scene\": {},\n  \"frames\": {},\n  \"hash\": \"{:016x}\",\n  \"metrics\": {{",
                                quote_json(scene), frames_, hash);
  for (std::size_t i = 0; i < metrics_.size(); ++i) {
    out += fmt::format("{}\n    {}: [", i ? "," : "", quote_json(metrics_[i].name));
    for (std::size_t f = 0; f < metrics_[i].values.size(); ++f) {
      if (f) out += ", ";
      const double value = metrics_[i].values[f];
      out += std::isfinite(value) ? fmt::format("{}", value) : "null";
    }
    out += ']';
  }
  return out + "\n  }\n}\n";
}

}  // namespace fascicle::game
