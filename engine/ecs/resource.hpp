// A system's access to one resource of the world: Resource<const T> reads it, Resource<T> writes it. Never empty: the
// schedule refuses to run a system whose resource the world does not hold.
#pragma once

#include <type_traits>

namespace fascicle::ecs {

template <class T>
class Resource {
  static_assert(!std::is_reference_v<T>);

 public:
  explicit Resource(T& value) : value_(&value) {}

  T& operator*() const { return *value_; }
  T* operator->() const { return value_; }
  T& get() const { return *value_; }

 private:
  T* value_;
};

}  // namespace fascicle::ecs
