#include "game/surface_stats.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "game/collision_stats.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"

namespace fascicle::game {

void SurfaceStats::record(const Simulation& simulation) {
  const ecs::World& world = simulation.world();
  const auto& characters = simulation.characters();
  std::size_t next = 0;
  const auto take = [&](ecs::Entity entity, const muscle::SurfaceMuscle& surface, const muscle::SurfaceState& state) {
    if (next == rows_.size() || rows_[next].entity != entity) {
      rows_.resize(next);
      Row row;
      row.entity = entity;
      const auto owner = std::find_if(characters.begin(), characters.end(), [&](const SpawnedCharacter& character) {
        return character.entity == surface.character;
      });
      if (owner != characters.end()) {
        row.owner = cost_owner(*owner, static_cast<std::size_t>(owner - characters.begin()));
      }
      row.muscle = surface.asset->name;
      row.vertices = surface.asset->vertex_count;
      rows_.push_back(std::move(row));
    }
    Row& row = rows_[next++];
    ++row.steps;
    row.fallbacks = state.fallbacks;
    if (surface.asset->volume > 0.0) {
      const double ratio = state.volume / surface.asset->volume;
      row.least_volume = std::min(row.least_volume, ratio);
      row.most_volume = std::max(row.most_volume, ratio);
    }
    const auto* hull = world.try_get<muscle::SurfaceHull>(entity);
    if (hull != nullptr && hull->solver == muscle::SurfaceSolver::kCoarseHull) {
      ++row.posed;
      row.iterations += hull->pose.iterations;
    }
    const auto* contacts = world.try_get<muscle::SurfaceContacts>(entity);
    if (contacts == nullptr) return;
    for (const muscle::SurfaceContact& contact : contacts->now) {
      row.held += static_cast<double>(contact.vertices);
      row.depth = std::max(row.depth, contact.depth);
    }
  };
  world.view<const muscle::SurfaceMuscle, const muscle::SurfaceState>().each(take);
  rows_.resize(next);
}

std::string SurfaceStats::to_table() const {
  if (rows_.empty()) return {};
  std::string text = fmt::format("\n{:<16}  {:<32}  {:>9}  {:>9}  {:>12}  {:>19}  {:>9}", "owner", "surface muscle",
                                 "vertices", "at bones", "pushed, mm", "volume, %", "fallbacks");
  const bool any_posed = std::any_of(rows_.begin(), rows_.end(), [](const Row& row) { return row.posed > 0; });
  text += any_posed ? "  steps posed  iterations\n" : "\n";
  for (const Row& row : rows_) {
    const std::string volume = fmt::format("{:.3f} .. {:.3f}", 100.0 * row.least_volume, 100.0 * row.most_volume);
    text += fmt::format("{:<16}  {:<32}  {:>9}  {:>9.1f}  {:>12.3f}  {:>19}  {:>9}", row.owner, row.muscle,
                        row.vertices, row.held / static_cast<double>(row.steps), 1e3 * static_cast<double>(row.depth),
                        volume, row.fallbacks);
    const auto posed = static_cast<double>(std::max<std::uint64_t>(row.posed, 1));
    text += any_posed ? fmt::format("  {:>11}  {:>10.1f}\n", row.posed,
                                    static_cast<double>(row.iterations) / posed) : "\n";
  }
  return text;
}

}  // namespace fascicle::game
