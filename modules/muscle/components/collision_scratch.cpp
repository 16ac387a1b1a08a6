#include "modules/muscle/components/collision_scratch.hpp"

#include <algorithm>
#include <thread>

#include "engine/parallel/worker_arena.hpp"

namespace fascicle::muscle {

CollisionScratch::CollisionScratch() {
  for (int i = 0; i < parallel::hardware_workers(); ++i) slots_.push_back(std::make_unique<Slot>());
}

void CollisionScratch::reserve(const CollisionAsset& asset) {
  for (const std::unique_ptr<Slot>& slot : slots_) slot->work.reserve(asset);
}

CollisionScratch::Loan::Loan(const CollisionScratch& scratch) {
  // A worker comes back to the same one, whose memory its core still has.
  const std::size_t first = static_cast<std::size_t>(std::max(parallel::current_worker(), 0));
  for (std::size_t i = first;; ++i) {
    Slot& slot = *scratch.slots_[i % scratch.slots_.size()];
    if (!slot.taken.test_and_set(std::memory_order_acquire)) {
      taken_ = &slot.taken;
      work_ = &slot.work;
      return;
    }
    if ((i - first + 1) % scratch.slots_.size() == 0) std::this_thread::yield();
  }
}

CollisionScratch::Loan::~Loan() { taken_->clear(std::memory_order_release); }

std::size_t CollisionScratch::heap_bytes() const {
  std::size_t sum = 0;
  for (const std::unique_ptr<Slot>& slot : slots_) sum += sizeof(Slot) + muscle::heap_bytes(slot->work);
  return sum;
}

}  // namespace fascicle::muscle
