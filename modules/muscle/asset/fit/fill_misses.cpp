#include "modules/muscle/asset/fit/fill_misses.hpp"

#include <algorithm>
#include <cstddef>

namespace fascicle::muscle {
namespace {

void fill_section(std::span<const std::uint8_t> hits, std::span<double> radii) {
  const std::size_t count = radii.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (hits[i] != 0) continue;
    std::size_t back = 1, on = 1;
    while (hits[(i + count - back) % count] == 0) ++back;
    while (hits[(i + on) % count] == 0) ++on;
    const double before = radii[(i + count - back) % count], after = radii[(i + on) % count];
    radii[i] = before + (after - before) * static_cast<double>(back) / static_cast<double>(back + on);
  }
}

}  // namespace

void fill_misses(std::uint32_t count, std::span<const double> arcs, std::span<const std::uint8_t> hits,
                 std::span<double> radii) {
  const std::size_t sections = arcs.size();
  const auto has_hits = [&](std::size_t k) { return std::ranges::count(hits.subspan(k * count, count), 1) > 0; };
  for (std::size_t k = 0; k < sections; ++k) {
    if (has_hits(k)) fill_section(hits.subspan(k * count, count), radii.subspan(k * count, count));
  }
  for (std::size_t k = 0; k < sections; ++k) {
    if (has_hits(k)) continue;
    std::size_t before = k, after = k;
    while (before > 0 && !has_hits(before)) --before;
    while (after + 1 < sections && !has_hits(after)) ++after;
    if (!has_hits(before)) before = after;
    if (!has_hits(after)) after = before;
    const double length = arcs[after] - arcs[before];
    const double s = length > 0.0 ? (arcs[k] - arcs[before]) / length : 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      radii[k * count + i] = (1.0 - s) * radii[before * count + i] + s * radii[after * count + i];
    }
  }
}

}  // namespace fascicle::muscle
