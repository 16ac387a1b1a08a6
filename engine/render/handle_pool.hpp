// Things behind handles: a slot is reused with a new generation, so that a handle of a removed thing is recognised.
#pragma once

#include <cassert>
#include <cstdint>
#include <utility>
#include <vector>

namespace fascicle {

template <class T, class Handle>
class HandlePool {
 public:
  Handle add(T value) {
    std::uint32_t index = 0;
    if (free_.empty()) {
      index = static_cast<std::uint32_t>(slots_.size());
      slots_.emplace_back();
    } else {
      index = free_.back();
      free_.pop_back();
    }
    slots_[index].value = std::move(value);
    slots_[index].used = true;
    return {index, slots_[index].generation};
  }

  // The thing, which must exist.
  T& get(Handle handle) {
    assert(contains(handle) && "the handle's thing was removed, or never was");
    return slots_[handle.index].value;
  }

  bool contains(Handle handle) const {
    return handle.index < slots_.size() && slots_[handle.index].used &&
           slots_[handle.index].generation == handle.generation;
  }

  T remove(Handle handle) {
    T value = std::move(get(handle));
    slots_[handle.index] = {T{}, slots_[handle.index].generation + 1, false};
    free_.push_back(handle.index);
    return value;
  }

  // f(T&) for each thing, in the order of their slots.
  template <class F>
  void each(F&& f) {
    for (Slot& slot : slots_) {
      if (slot.used) f(slot.value);
    }
  }

 private:
  struct Slot {
    T value{};
    std::uint32_t generation = 1;
    bool used = false;
  };
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;
};

}  // namespace fascicle
