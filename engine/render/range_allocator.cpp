#include "engine/render/range_allocator.hpp"

#include <algorithm>
#include <cassert>

namespace fascicle {

std::optional<std::uint32_t> RangeAllocator::allocate(std::uint32_t count) {
  if (count == 0) return 0u;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    Range& range = free_[i];
    if (range.count < count) continue;
    const std::uint32_t first = range.first;
    range.first += count;
    range.count -= count;
    if (range.count == 0) free_.erase(free_.begin() + static_cast<std::ptrdiff_t>(i));
    return first;
  }
  return std::nullopt;
}

void RangeAllocator::release(std::uint32_t first, std::uint32_t count) {
  if (count == 0) return;
  assert(first + count <= capacity_);
  auto next = std::lower_bound(free_.begin(), free_.end(), first,
                               [](const Range& range, std::uint32_t at) { return range.first < at; });
  assert(next == free_.end() || first + count <= next->first);
  next = free_.insert(next, {first, count});
  const auto joins = [](const Range& a, const Range& b) { return a.first + a.count == b.first; };
  if (next + 1 != free_.end() && joins(*next, *(next + 1))) {
    next->count += (next + 1)->count;
    free_.erase(next + 1);
  }
  if (next != free_.begin() && joins(*(next - 1), *next)) {
    (next - 1)->count += next->count;
    free_.erase(next);
  }
}

void RangeAllocator::grow(std::uint32_t capacity) {
  assert(capacity >= capacity_);
  const std::uint32_t old = capacity_;
  capacity_ = capacity;
  if (capacity > old) release(old, capacity - old);
}

std::uint32_t RangeAllocator::free_count() const {
  std::uint32_t count = 0;
  for (const Range& range : free_) count += range.count;
  return count;
}

}  // namespace fascicle
