// Resource: scratch for the musculatures that collide at the same time, one for each core. It carries nothing from one
// musculature or step to the next.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "modules/muscle/kernels/collision/collision_work.hpp"

namespace fascicle::muscle {

class CollisionScratch {
 public:
  CollisionScratch();

  void reserve(const CollisionAsset& asset);  // outside of frames

  // Borrowed scratch; waits for one where more threads than cores ask.
  class Loan {
   public:
    explicit Loan(const CollisionScratch& scratch);
    ~Loan();
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    CollisionWork& operator*() const { return *work_; }

   private:
    std::atomic_flag* taken_ = nullptr;
    CollisionWork* work_ = nullptr;
  };

  std::size_t heap_bytes() const;

 private:
  struct Slot {
    std::atomic_flag taken = ATOMIC_FLAG_INIT;
    CollisionWork work;
  };
  std::vector<std::unique_ptr<Slot>> slots_;
};

}  // namespace fascicle::muscle
