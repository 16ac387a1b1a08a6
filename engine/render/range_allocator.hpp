// Hands out ranges of a linear space, first fit; freed ranges join their neighbours. The space only grows.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace fascicle {

class RangeAllocator {
 public:
  // First element of a free range of `count`, or nothing where none is large enough. count 0 gives 0.
  std::optional<std::uint32_t> allocate(std::uint32_t count);
  // Gives back a range that `allocate` handed out.
  void release(std::uint32_t first, std::uint32_t count);
  // Adds the elements from the old capacity to the new one.
  void grow(std::uint32_t capacity);
  std::uint32_t capacity() const { return capacity_; }
  std::uint32_t free_count() const;

 private:
  struct Range {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  std::vector<Range> free_;  // by first, no two adjacent
  std::uint32_t capacity_ = 0;
};

}  // namespace fascicle
