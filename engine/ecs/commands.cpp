#include "engine/ecs/commands.hpp"

#include <cassert>

namespace fascicle::ecs {

namespace {

// A placeholder's index: list number in the high bits, running number in the low ones. The number runs on over barriers
// so that a placeholder kept too long is not taken for a new one.
constexpr std::uint32_t kNumberBits = 22;
constexpr std::uint32_t kNumberMask = (1u << kNumberBits) - 1;
static_assert(Commands::kMaxLists == 1u << (32 - kNumberBits));

}  // namespace

Commands::Commands(std::uint32_t list) : list_(list) { assert(list < kMaxLists); }

Entity Commands::create() {
  const Entity pending{(list_ << kNumberBits) | (next_pending_ & kNumberMask), kPendingGeneration};
  ++next_pending_;
  push(pending, [this](World& world, Entity) { created_.push_back(world.create()); }, false);
  return pending;
}

void Commands::destroy(Entity entity) {
  push(entity, [](World& world, Entity target) { world.destroy(target); });
}

void Commands::run(std::function<void(World&)> function) {
  push(kNoEntity, [function = std::move(function)](World& world, Entity) { function(world); }, false);
}

void Commands::then(Entity entity, std::function<void(World&, Entity)> function) { push(entity, std::move(function)); }

Entity Commands::resolve(Entity entity) const {
  if (entity.generation != kPendingGeneration) return entity;
  if (entity.index >> kNumberBits != list_) return kNoEntity;
  const std::uint32_t number = (entity.index - first_pending_) & kNumberMask;
  return number < created_.size() ? created_[number] : kNoEntity;
}

void Commands::apply(World& world) {
  struct ClearAtEnd {
    Commands& commands;
    ~ClearAtEnd() { commands.clear(); }
  } clear_at_end{*this};
  for (const std::unique_ptr<Command>& command : commands_) {
    const Entity target = resolve(command->target);
    if (!command->needs_target || world.alive(target)) command->run(world, target);
  }
}

void Commands::clear() {
  commands_.clear();
  created_.clear();
  first_pending_ = next_pending_;
}

}  // namespace fascicle::ecs
