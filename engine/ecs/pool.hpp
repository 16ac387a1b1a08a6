// All components of one type: a sparse set. `sparse` maps an entity index to a position in two dense arrays, the
// entities and their values, which hold no gaps and are what systems walk over. Adding appends; removing moves the last
// into the gap. The order is therefore a function of the adds and removes alone. A plain (not paged) sparse array
// serves: entities number 10^3 to 10^5, 4 bytes each a pool.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/ecs/entity.hpp"
#include "engine/ecs/type_info.hpp"

namespace fascicle::ecs {

// The part that does not depend on the component's type.
class PoolBase {
 public:
  static constexpr std::uint32_t kAbsent = 0xffffffff;

  explicit PoolBase(TypeId type) : type_(type) {}
  virtual ~PoolBase() = default;
  PoolBase(const PoolBase&) = delete;
  PoolBase& operator=(const PoolBase&) = delete;

  TypeId type() const { return type_; }
  std::size_t size() const { return entities_.size(); }
  std::span<const Entity> entities() const { return entities_; }  // in dense order

  // Position in dense order; kAbsent for entities that lack the component, stale ones among them.
  std::uint32_t position(Entity entity) const {
    if (entity.index >= sparse_.size()) return kAbsent;
    const std::uint32_t position = sparse_[entity.index];
    return position != kAbsent && entities_[position] == entity ? position : kAbsent;
  }
  bool contains(Entity entity) const { return position(entity) != kAbsent; }

  // False when there was nothing to remove.
  virtual bool remove(Entity entity) = 0;
  // The pool's own arrays and what the components say they own.
  virtual std::size_t bytes() const = 0;

 protected:
  void append(Entity entity) {
    if (entity.index >= sparse_.size()) sparse_.resize(entity.index + std::size_t{1}, kAbsent);
    sparse_[entity.index] = static_cast<std::uint32_t>(entities_.size());
    entities_.push_back(entity);
  }

  void move_last_to(std::uint32_t position) {
    sparse_[entities_.back().index] = position;
    const std::uint32_t removed = entities_[position].index;
    entities_[position] = entities_.back();
    sparse_[removed] = kAbsent;
    entities_.pop_back();
  }

  std::size_t index_bytes() const {
    return sparse_.capacity() * sizeof(std::uint32_t) + entities_.capacity() * sizeof(Entity);
  }

 private:
  TypeId type_;
  std::vector<std::uint32_t> sparse_;
  std::vector<Entity> entities_;
};

// A component type may say what it owns on the heap by a function `heap_bytes(const T&)` beside it.
template <class T>
concept KnowsHeapBytes = requires(const T& value) {
  { heap_bytes(value) } -> std::convertible_to<std::size_t>;
};

template <class T>
class Pool final : public PoolBase {
  static_assert(!std::is_same_v<T, bool>, "a component must be a type of its own; wrap the bool in a struct");
  static_assert(std::is_move_constructible_v<T> && std::is_move_assignable_v<T>, "a component must be movable");

 public:
  Pool() : PoolBase(type_id<T>()) {}

  // Replaces the value when the entity has one. The reference holds until the next add or remove in this pool.
  T& add(Entity entity, T value) {
    if (T* present = find(entity)) return *present = std::move(value);
    append(entity);
    return values_.emplace_back(std::move(value));
  }

  bool remove(Entity entity) override {
    const std::uint32_t place = position(entity);
    if (place == kAbsent) return false;
    if (place + std::size_t{1} != values_.size()) values_[place] = std::move(values_.back());
    values_.pop_back();
    move_last_to(place);
    return true;
  }

  T* find(Entity entity) {
    const std::uint32_t place = position(entity);
    return place == kAbsent ? nullptr : &values_[place];
  }
  const T* find(Entity entity) const { return const_cast<Pool*>(this)->find(entity); }

  T& value_at(std::size_t place) { return values_[place]; }
  const T& value_at(std::size_t place) const { return values_[place]; }
  std::span<T> values() { return values_; }
  std::span<const T> values() const { return values_; }

  std::size_t bytes() const override {
    std::size_t total = index_bytes() + values_.capacity() * sizeof(T);
    if constexpr (KnowsHeapBytes<T>) {
      for (const T& value : values_) total += heap_bytes(value);
    }
    return total;
  }

 private:
  std::vector<T> values_;
};

}  // namespace fascicle::ecs
