// Structural changes a system asks for: they are noted while it runs and carried out at the next barrier, system by
// system in the order of registration and, within a system, in the order asked, whatever thread ran it. A command whose
// entity is not alive any more by then does nothing. Not to be shared between threads: collect inside a parallel loop,
// ask after it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "engine/ecs/entity.hpp"
#include "engine/ecs/world.hpp"

namespace fascicle::ecs {

class Commands {
 public:
  // `list` tells the placeholders of different lists apart; below kMaxLists.
  explicit Commands(std::uint32_t list = 0);

  // A placeholder for an entity that the barrier will make. Good for the commands of this list up to that barrier, and
  // for nothing else: it is never alive. Use then() to store the real entity.
  Entity create();
  void destroy(Entity entity);
  template <class T>
  void add(Entity entity, T value = {}) {
    push(entity, [value = std::move(value)](World& world, Entity target) mutable {
      world.add<T>(target, std::move(value));
    });
  }
  template <class T>
  void remove(Entity entity) {
    push(entity, [](World& world, Entity target) { world.remove<T>(target); });
  }
  // Anything else that needs the whole world.
  void run(std::function<void(World&)> function);
  // The same with an entity, which arrives as the real one if it was a placeholder; not called if it is not alive.
  void then(Entity entity, std::function<void(World&, Entity)> function);

  bool empty() const { return commands_.empty(); }
  std::size_t size() const { return commands_.size(); }

  // Carries all out and empties the list. Also when a command throws: the rest is dropped.
  void apply(World& world);
  void clear();

  static constexpr std::uint32_t kMaxLists = 1u << 10;

 private:
  // One command; virtual because each kind carries other data. Structural changes are rare beside per-element work.
  struct Command {
    virtual ~Command() = default;
    virtual void run(World& world, Entity target) = 0;
    Entity target;
    bool needs_target = true;
  };
  template <class F>
  struct CommandOf final : Command {
    explicit CommandOf(F f) : function(std::move(f)) {}
    void run(World& world, Entity entity) override { function(world, entity); }
    F function;
  };

  template <class F>
  void push(Entity target, F function, bool needs_target = true) {
    auto command = std::make_unique<CommandOf<F>>(std::move(function));
    command->target = target;
    command->needs_target = needs_target;
    commands_.push_back(std::move(command));
  }
  Entity resolve(Entity entity) const;

  std::vector<std::unique_ptr<Command>> commands_;
  std::vector<Entity> created_;     // by placeholder, filled during apply
  std::uint32_t list_ = 0;
  std::uint32_t first_pending_ = 0;  // number of the first placeholder since the last barrier
  std::uint32_t next_pending_ = 0;
};

}  // namespace fascicle::ecs
