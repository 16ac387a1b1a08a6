// The last `capacity` samples of a row, in order of time and in one piece, so that percentiles and graphs need no copy
// to unwrap a ring: every sample is stored twice, half the buffer apart.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace fascicle {

class SampleWindow {
 public:
  explicit SampleWindow(std::size_t capacity) : capacity_(std::max<std::size_t>(capacity, 1)), twice_(2 * capacity_) {}

  void push(float sample) {
    twice_[next_] = twice_[next_ + capacity_] = sample;
    next_ = (next_ + 1) % capacity_;
    size_ = std::min(size_ + 1, capacity_);
  }

  // Oldest first.
  std::span<const float> values() const {
    const std::size_t first = size_ < capacity_ ? 0 : next_;
    return std::span<const float>(twice_).subspan(first, size_);
  }
  std::size_t capacity() const { return capacity_; }

 private:
  std::size_t capacity_;
  std::size_t next_ = 0;
  std::size_t size_ = 0;
  std::vector<float> twice_;
};

// Nearest-rank percentile: the smallest sample that at least `percent` % of them do not exceed. `sorted` ascending; 0
// of none.
inline float percentile(std::span<const float> sorted, double percent) {
  assert(percent >= 0 && percent <= 100);
  if (sorted.empty()) return 0;
  const double rank = std::ceil(percent / 100.0 * static_cast<double>(sorted.size()));
  const auto index = static_cast<std::size_t>(std::max(rank, 1.0)) - 1;
  return sorted[std::min(index, sorted.size() - 1)];
}

}  // namespace fascicle
