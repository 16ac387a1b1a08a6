#include "engine/parallel/for_range.hpp"

namespace fascicle::parallel::detail {

void FirstFailure::note(std::size_t begin) {
  const std::lock_guard lock(mutex_);
  if (exception_ && begin_ <= begin) return;
  begin_ = begin;
  exception_ = std::current_exception();
}

}  // namespace fascicle::parallel::detail
