#include "modules/muscle/asset/fit/match_order.hpp"

#include <algorithm>

namespace fascicle::muscle {

void order_matches(std::span<const double> radii, std::span<const std::uint8_t> hits,
                   std::vector<std::uint32_t>& ordered) {
  ordered.clear();
  const std::uint32_t count = static_cast<std::uint32_t>(radii.size()), half = count / 2;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t opposite = (i + half) % count;
    if (hits[i] != 0 && hits[opposite] != 0 && radii[i] >= 0.0 && radii[opposite] < 0.0) ordered.push_back(i);
  }
  std::size_t start = 0;
  std::uint32_t largest = 0;
  for (std::size_t j = 0; j < ordered.size(); ++j) {
    const std::size_t next = (j + 1) % ordered.size();
    const std::uint32_t gap = (ordered[next] + count - ordered[j]) % count;
    if (gap <= largest) continue;
    largest = gap;
    start = next;
  }
  std::rotate(ordered.begin(), ordered.begin() + static_cast<std::ptrdiff_t>(start), ordered.end());
}

}  // namespace fascicle::muscle
