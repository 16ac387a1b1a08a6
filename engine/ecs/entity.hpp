// An entity is a name: an index that is reused, and a generation that tells this use from earlier ones, so that a
// handle kept too long is recognised as stale instead of pointing at a stranger.
#pragma once

#include <cstdint>

namespace fascicle::ecs {

struct Entity {
  std::uint32_t index = 0xffffffff;
  std::uint32_t generation = 0;

  friend bool operator==(const Entity&, const Entity&) = default;
};

// Never alive.
inline constexpr Entity kNoEntity{};

// Generation of the placeholders that Commands::create gives out; no living entity reaches it.
inline constexpr std::uint32_t kPendingGeneration = 0xffffffff;

}  // namespace fascicle::ecs
