// Entities, their components and the resources: the state of a simulation. Only set-up code and commands hold a World;
// systems see Views and Resources. Entities and components may be added and removed freely outside Schedule::run, and
// inside it only by commands, at barriers (asserted).
#pragma once

#include <cassert>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/ecs/entity.hpp"
#include "engine/ecs/pool.hpp"
#include "engine/ecs/type_info.hpp"
#include "engine/ecs/view.hpp"

namespace fascicle::ecs {

struct ComponentMemory {
  std::string name;
  std::size_t count = 0;
  std::size_t bytes = 0;  // pool arrays, and heap memory where the type has heap_bytes(const T&)
};

class World {
 public:
  World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Entity create();
  // Removes all components. False when the entity is not alive (any more).
  bool destroy(Entity entity);
  bool alive(Entity entity) const {
    return entity.index < generations_.size() && generations_[entity.index] == entity.generation;
  }
  std::size_t entity_count() const { return generations_.size() - free_.size() - retired_; }

  // Replaces the value when there is one. The entity must be alive. The reference holds until the next add or remove of
  // a T.
  template <class T>
  T& add(Entity entity, T value = {}) {
    assert(alive(entity) && "component added to an entity that is not alive");
    assert(!locked_ && "components change only at barriers while a schedule runs");
    return pool<T>().add(entity, std::move(value));
  }
  // False when there was none.
  template <class T>
  bool remove(Entity entity) {
    assert(!locked_ && "components change only at barriers while a schedule runs");
    Pool<T>* found = find_pool<T>();
    return found != nullptr && found->remove(entity);
  }
  template <class T>
  bool has(Entity entity) const {
    const Pool<T>* found = find_pool<T>();
    return found != nullptr && found->contains(entity);
  }

  // Null when the entity lacks the component or is stale.
  template <class T>
  T* try_get(Entity entity) {
    Pool<std::remove_const_t<T>>* found = find_pool<std::remove_const_t<T>>();
    return found == nullptr ? nullptr : found->find(entity);
  }
  template <class T>
  const T* try_get(Entity entity) const {
    return const_cast<World*>(this)->try_get<T>(entity);
  }
  template <class T>
  T& get(Entity entity) {
    T* component = try_get<T>(entity);
    assert(component != nullptr && "the entity lacks this component");
    return *component;
  }
  template <class T>
  const T& get(Entity entity) const {
    return const_cast<World*>(this)->get<T>(entity);
  }

  // One value of each type, shared by all systems. Setting again replaces the value; its address stays.
  template <class T>
  T& set_resource(T value) {
    if (ResourceHolder<T>* holder = find_resource<T>()) return holder->value.emplace(std::move(value));
    auto made = std::make_unique<ResourceHolder<T>>();
    ResourceHolder<T>& holder = *made;
    holder.value.emplace(std::move(value));
    resource_of_.insert(type_id<T>(), made.get());
    resources_.push_back(std::move(made));
    return *holder.value;
  }
  template <class T>
  T* try_resource() {
    ResourceHolder<std::remove_const_t<T>>* holder = find_resource<std::remove_const_t<T>>();
    return holder == nullptr ? nullptr : &*holder->value;
  }
  template <class T>
  const T* try_resource() const {
    return const_cast<World*>(this)->try_resource<T>();
  }
  template <class T>
  T& resource() {
    T* found = try_resource<T>();
    assert(found != nullptr && "the world holds no such resource; call set_resource first");
    return *found;
  }
  template <class T>
  const T& resource() const {
    return const_cast<World*>(this)->resource<T>();
  }

  template <class... Ts>
  View<Ts...> view() {
    return View<Ts...>(find_pool<std::remove_const_t<Ts>>()...);
  }
  template <class... Ts>
  View<Ts...> view() const
    requires(std::is_const_v<Ts> && ...)
  {
    return const_cast<World*>(this)->view<Ts...>();
  }

  // Sorted by name.
  std::vector<ComponentMemory> memory_by_component() const;

  // For Schedule: between lock and unlock, structural changes assert.
  void lock_structure(bool locked) { locked_ = locked; }

 private:
  struct ResourceHolderBase {
    virtual ~ResourceHolderBase() = default;
  };
  template <class T>
  struct ResourceHolder final : ResourceHolderBase {
    std::optional<T> value;
  };

  template <class T>
  Pool<T>* find_pool() const {
    PoolBase* const* found = pool_of_.find(type_id<T>());
    return found == nullptr ? nullptr : static_cast<Pool<T>*>(*found);
  }
  template <class T>
  Pool<T>& pool() {
    if (Pool<T>* found = find_pool<T>()) return *found;
    auto made = std::make_unique<Pool<T>>();
    Pool<T>& result = *made;
    pool_of_.insert(type_id<T>(), made.get());
    pools_.push_back(std::move(made));
    return result;
  }
  template <class T>
  ResourceHolder<T>* find_resource() const {
    ResourceHolderBase* const* found = resource_of_.find(type_id<T>());
    return found == nullptr ? nullptr : static_cast<ResourceHolder<T>*>(*found);
  }

  std::vector<std::uint32_t> generations_;  // by entity index: the generation that is alive, or the next one
  std::vector<std::uint32_t> free_;         // indices to reuse, last first
  std::size_t retired_ = 0;  // indices whose generations are used up
  bool locked_ = false;

  std::vector<std::unique_ptr<PoolBase>> pools_;  // in order of first use
  TypeTable<PoolBase*> pool_of_;
  std::vector<std::unique_ptr<ResourceHolderBase>> resources_;
  TypeTable<ResourceHolderBase*> resource_of_;
};

}  // namespace fascicle::ecs
