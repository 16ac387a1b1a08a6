// Counts heap allocations of the whole test program. Linking fascicle_test_support and naming any function below
// replaces the global operator new and delete, the aligned and nothrow forms among them, by counting ones.
#pragma once

#include <cstdint>

namespace fascicle::test {

// Calls of any form of operator new since the program began, by all threads.
std::uint64_t allocation_count();
// Calls of any form of operator delete with a pointer that is not null.
std::uint64_t deallocation_count();

// Allocations since construction: EXPECT_EQ(scope.allocations(), 0).
class AllocationScope {
 public:
  AllocationScope() : start_(allocation_count()) {}
  std::uint64_t allocations() const { return allocation_count() - start_; }

 private:
  std::uint64_t start_;
};

}  // namespace fascicle::test
