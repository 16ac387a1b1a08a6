#include "engine/ecs/world.hpp"

#include <algorithm>

namespace fascicle::ecs {

Entity World::create() {
  assert(!locked_ && "entities are created only at barriers while a schedule runs");
  if (free_.empty()) {
    generations_.push_back(0);
    return {static_cast<std::uint32_t>(generations_.size() - 1), 0};
  }
  const std::uint32_t index = free_.back();
  free_.pop_back();
  return {index, generations_[index]};
}

bool World::destroy(Entity entity) {
  assert(!locked_ && "entities are destroyed only at barriers while a schedule runs");
  if (!alive(entity)) return false;
  for (const std::unique_ptr<PoolBase>& pool : pools_) pool->remove(entity);
  // An index whose generations are used up is not reused, or the oldest handles would come to life again.
  if (++generations_[entity.index] == kPendingGeneration) {
    ++retired_;
  } else {
    free_.push_back(entity.index);
  }
  return true;
}

std::vector<ComponentMemory> World::memory_by_component() const {
  std::vector<ComponentMemory> result;
  for (const std::unique_ptr<PoolBase>& pool : pools_) {
    result.push_back({std::string(pool->type()->name), pool->size(), pool->bytes()});
  }
  std::sort(result.begin(), result.end(),
            [](const ComponentMemory& a, const ComponentMemory& b) { return a.name < b.name; });
  return result;
}

}  // namespace fascicle::ecs
