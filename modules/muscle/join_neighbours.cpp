#include "modules/muscle/join_neighbours.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/ecs/world.hpp"
#include "modules/muscle/asset/surface/rest_clearance.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/components/surface_neighbours.hpp"

namespace fascicle::muscle {
namespace {

// Pairs there is room for between muscles that are not near at rest: a character may have dozens.
constexpr std::size_t kRoomApart = 4096;

bool collides(const SurfaceMuscle& muscle) {
  return muscle.settings.collide_with_muscles && muscle.asset->tree != nullptr;
}

void make_room(const SurfaceMuscle& muscle, SurfaceState& state) {
  SurfaceBoxes& boxes = state.scratch.boxes;
  if (boxes.boxes.empty()) lay_out_boxes(*muscle.asset->tree, *muscle.asset, false, boxes);
}

}  // namespace

void join_neighbours(ecs::World& world, ecs::Entity entity) {
  const SurfaceMuscle& muscle = world.get<SurfaceMuscle>(entity);
  if (!collides(muscle) || !world.alive(muscle.character)) return;
  SurfaceNeighbours* found = world.try_get<SurfaceNeighbours>(muscle.character);
  SurfaceNeighbours& neighbours = found != nullptr ? *found : world.add(muscle.character, SurfaceNeighbours{});
  const auto second = static_cast<std::uint32_t>(neighbours.muscles.size());
  for (std::uint32_t first = 0; first < second; ++first) {
    const SurfaceMuscle& other = world.get<SurfaceMuscle>(neighbours.muscles[first]);
    NeighbourPair pair;
    pair.first = first;
    pair.second = second;
    const float reach = std::max(muscle.settings.contact_distance, other.settings.contact_distance);
    pair.first_clearance = find_rest_clearance(*other.asset, *muscle.asset, reach);
    pair.second_clearance = find_rest_clearance(*muscle.asset, *other.asset, reach);
    const auto touches = [reach](float clearance) { return clearance < reach; };
    const bool near = std::ranges::any_of(pair.first_clearance, touches);
    const std::size_t vertices = muscle.asset->vertex_count + other.asset->vertex_count;
    lay_out_pairs(near ? usual_pair_capacity(vertices) : kRoomApart, pair.pairs);
    neighbours.pairs.push_back(std::move(pair));
    make_room(other, world.get<SurfaceState>(neighbours.muscles[first]));
    make_room(muscle, world.get<SurfaceState>(entity));
  }
  neighbours.muscles.push_back(entity);
  neighbours.solved.assign(neighbours.muscles.size(), 0);
}

void leave_neighbours(ecs::World& world, ecs::Entity entity) {
  const SurfaceMuscle* muscle = world.try_get<SurfaceMuscle>(entity);
  SurfaceNeighbours* neighbours = muscle != nullptr ? world.try_get<SurfaceNeighbours>(muscle->character) : nullptr;
  if (neighbours == nullptr) return;
  const auto place = std::find(neighbours->muscles.begin(), neighbours->muscles.end(), entity);
  if (place == neighbours->muscles.end()) return;
  const auto gone = static_cast<std::uint32_t>(place - neighbours->muscles.begin());
  std::erase_if(neighbours->pairs,
                [gone](const NeighbourPair& pair) { return pair.first == gone || pair.second == gone; });
  for (NeighbourPair& pair : neighbours->pairs) {
    pair.first -= pair.first > gone;
    pair.second -= pair.second > gone;
  }
  neighbours->muscles.erase(place);
  neighbours->solved.resize(neighbours->muscles.size());
}

}  // namespace fascicle::muscle
