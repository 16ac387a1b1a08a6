#include "engine/parallel/task_set.hpp"

#include <tbb/task_group.h>

#include <new>

namespace fascicle::parallel {

namespace {

tbb::task_group& group_in(std::byte* storage) { return *std::launder(reinterpret_cast<tbb::task_group*>(storage)); }

}  // namespace

TaskSet::TaskSet() {
  static_assert(sizeof(tbb::task_group) <= kBytes && alignof(tbb::task_group) <= 128);
  new (storage_) tbb::task_group;
}

TaskSet::~TaskSet() { group_in(storage_).~task_group(); }

void TaskSet::start(Function function, void* context, std::size_t index) {
  group_in(storage_).run([=] { function(context, index); });
}

void TaskSet::wait() { group_in(storage_).wait(); }

}  // namespace fascicle::parallel
