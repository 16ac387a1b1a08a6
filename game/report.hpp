// A run's metrics, a value per frame and name, written as JSON: {"scene", "frames", "hash", "metrics": {NAME: [...]}}.
// Systems add their metrics by name; one that starts late has null for the frames before.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/content/result.hpp"

namespace fascicle::game {

class Report {
 public:
  // Every frame begins once; metrics recorded until the next belong to it.
  void begin_frame();
  // The last value wins where a metric is recorded twice in a frame. Values that are not finite become null.
  void record(std::string_view name, double value);

  std::uint64_t frames() const { return frames_; }
  std::string to_json(std::string_view scene, std::uint64_t hash) const;

 private:
  struct Metric {
    std::string name;
    std::vector<double> values;  // NaN: not recorded
  };
  std::vector<Metric> metrics_;  // in the order of their first value
  std::uint64_t frames_ = 0;
};

}  // namespace fascicle::game
