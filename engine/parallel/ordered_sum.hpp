// Sums whose bits do not depend on the number of workers. Floating-point addition is not associative, so the order is
// fixed: chunks of a fixed size are summed one after another inside, and the chunks' sums are added in chunk order.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/parallel/for_range.hpp"

namespace fascicle::parallel {

// Sum over chunks of f(begin, end), which returns the sum of its elements and whose type T has operator+=.
// `partial` holds at least chunk_count(count, chunk) values and is overwritten: the form for frames, which must not
// allocate. The first chunk's value starts the sum; T{} is the sum of nothing.
template <class T, class F>
T ordered_sum(std::size_t count, std::size_t chunk, std::span<T> partial, F&& f) {
  if (count == 0) return T{};
  chunk = std::max<std::size_t>(chunk, 1);
  for_range(count, chunk, [&](std::size_t begin, std::size_t end) { partial[begin / chunk] = f(begin, end); });
  T sum = partial[0];
  for (std::size_t i = 1; i < chunk_count(count, chunk); ++i) sum += partial[i];
  return sum;
}

// The same with its own array of partial sums, which it allocates.
template <class F>
auto ordered_sum(std::size_t count, std::size_t chunk, F&& f) {
  using T = std::remove_cvref_t<decltype(f(count, count))>;
  std::vector<T> partial(chunk_count(count, chunk));
  return ordered_sum<T>(count, chunk, std::span<T>(partial), f);
}

}  // namespace fascicle::parallel
