// What a system sees of the components: all entities that have every one of Ts. `View<const A, B>` reads A and writes
// B; a View gives no way to anything else, so a system cannot touch what its signature does not declare. The smallest
// pool drives (the first named among equals) and is walked in its dense order. A View is a handful of pointers: copy it
// freely; it holds for one run of a system, in which no component is added or removed.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "engine/ecs/pool.hpp"

namespace fascicle::ecs {

template <class... Ts>
class View {
  static_assert(sizeof...(Ts) > 0, "a View names at least one component");
  static_assert((!std::is_reference_v<Ts> && ...), "name components by type: View<const A, B>");

  template <class T>
  static constexpr std::size_t kTimesNamed = (std::size_t{std::is_same_v<T, std::remove_const_t<Ts>>} + ...);
  static_assert(((kTimesNamed<std::remove_const_t<Ts>> == 1) && ...), "a View names each component once");

 public:
  // Null for a component type that no entity ever had: the View is then empty.
  explicit View(Pool<std::remove_const_t<Ts>>*... pools) : pools_(pools...) {
    const std::array<const PoolBase*, sizeof...(Ts)> all{pools...};
    for (const PoolBase* pool : all) {
      if (pool == nullptr) {
        driver_ = nullptr;
        return;
      }
      if (driver_ == nullptr || pool->size() < driver_->size()) driver_ = pool;
    }
  }

  // Calls f(Ts&...) or f(Entity, Ts&...) for each entity, in order.
  template <class F>
  void each(F&& f) const {
    for (std::size_t i = 0; i < candidates(); ++i) visit(i, f);
  }

  // Random access for parallel loops: candidates are the entities of the driving pool, in order; row(i) is empty for
  // one that lacks another component. Different rows may be written by different threads.
  std::size_t candidates() const { return driver_ == nullptr ? 0 : driver_->size(); }
  Entity entity_at(std::size_t i) const { return driver_->entities()[i]; }
  std::optional<std::tuple<Ts&...>> row(std::size_t i) const {
    const std::tuple<Ts*...> found = find_row(i);
    if (!((std::get<Ts*>(found) != nullptr) && ...)) return std::nullopt;
    return std::tuple<Ts&...>(*std::get<Ts*>(found)...);
  }

  // Calls f(Ts&...) or f(Entity, Ts&...) for candidate i, unless it lacks a component; says whether it did.
  template <class F>
  bool visit(std::size_t i, F&& f) const {
    const std::tuple<Ts*...> found = find_row(i);
    if (!((std::get<Ts*>(found) != nullptr) && ...)) return false;
    if constexpr (std::is_invocable_v<F&, Entity, Ts&...>) {
      f(entity_at(i), *std::get<Ts*>(found)...);
    } else {
      static_assert(std::is_invocable_v<F&, Ts&...>, "the function takes (Ts&...) or (Entity, Ts&...)");
      f(*std::get<Ts*>(found)...);
    }
    return true;
  }

  // An upper bound of the number of entities; exact for a View of one component.
  std::size_t size_hint() const { return candidates(); }

  bool contains(Entity entity) const {
    return driver_ != nullptr && (std::get<Pool<std::remove_const_t<Ts>>*>(pools_)->contains(entity) && ...);
  }

  // The component of any entity that has it, whether or not the entity has the View's others. Constness as declared.
  template <class T>
  auto* try_get(Entity entity) const {
    using Declared = DeclaredAs<T>;
    auto* pool = std::get<Pool<std::remove_const_t<T>>*>(pools_);
    return pool == nullptr ? static_cast<Declared*>(nullptr) : static_cast<Declared*>(pool->find(entity));
  }
  template <class T>
  auto& get(Entity entity) const {
    auto* component = try_get<T>(entity);
    assert(component != nullptr && "the entity lacks this component");
    return *component;
  }

 private:
  // T as the View names it: const T when it was declared const.
  template <class T>
  using DeclaredAs = std::conditional_t<(std::is_same_v<const std::remove_const_t<T>, Ts> || ...),
                                        const std::remove_const_t<T>, std::remove_const_t<T>>;

  std::tuple<Ts*...> find_row(std::size_t i) const {
    const Entity entity = entity_at(i);
    return {find_component(std::get<Pool<std::remove_const_t<Ts>>*>(pools_), i, entity)...};
  }

  template <class T>
  T* find_component(Pool<T>* pool, std::size_t i, Entity entity) const {
    return pool == driver_ ? &pool->value_at(i) : pool->find(entity);
  }

  std::tuple<Pool<std::remove_const_t<Ts>>*...> pools_;
  const PoolBase* driver_ = nullptr;
};

}  // namespace fascicle::ecs
