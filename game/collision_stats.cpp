#include "game/collision_stats.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "modules/muscle/muscle.hpp"

namespace fascicle::game {
namespace {

constexpr float kDeep = 0.0005f;  // m

}  // namespace

std::string cost_owner(const SpawnedCharacter& character, std::size_t index) {
  return fmt::format("{} {}", character.asset->name, index + 1);
}

void CollisionStats::record(const Simulation& simulation, bool by_muscle) {
  last_ = CollisionCounts{};
  colliding_ = false;
  owners_.resize(simulation.characters().size());
  for (std::size_t i = 0; i < owners_.size(); ++i) {
    const SpawnedCharacter& character = simulation.characters()[i];
    if (character.musculature == ecs::kNoEntity) continue;
    const auto* collision = simulation.world().try_get<muscle::MuscleCollision>(character.musculature);
    const auto* contacts = simulation.world().try_get<muscle::MuscleContacts>(character.musculature);
    if (collision == nullptr || contacts == nullptr) continue;
    colliding_ = true;
    last_.contacts += collision->contact_count;
    last_.pairs += contacts->now.size();
    last_.began += contacts->began.size();
    last_.ended += contacts->ended.size();
    last_.fallbacks += collision->fallbacks;
    last_.overflows += collision->overflows;
    for (const float depth : collision->depth) last_.left = std::max(last_.left, depth);
    if (!by_muscle) continue;

    const muscle::MuscleAsset& asset = *character.asset->muscles;
    Owner& owner = owners_[i];
    if (owner.asset != character.asset.get()) {
      owner = {character.asset.get(), 0, std::vector<Row>(asset.size())};
      for (std::size_t m = 0; m < asset.size(); ++m) {
        owner.rows[m].owner = cost_owner(character, i);
        owner.rows[m].muscle = asset.muscles[m].name;
      }
    }
    ++owner.steps;
    for (std::size_t m = 0; m < std::min({owner.rows.size(), collision->cost.size(), collision->depth.size()}); ++m) {
      Row& row = owner.rows[m];
      row.contacts += static_cast<double>(collision->cost[m]);
      row.most = std::max(row.most, collision->cost[m]);
      row.depth = std::max(row.depth, collision->depth[m]);
      if (collision->depth[m] > kDeep) ++row.deep_steps;
    }
  }
  if (!colliding_) return;
  ++steps_;
  most_contacts_ = std::max(most_contacts_, last_.contacts);
  most_pairs_ = std::max(most_pairs_, last_.pairs);
  total_.contacts += last_.contacts;
  total_.pairs += last_.pairs;
  total_.began += last_.began;
  total_.ended += last_.ended;
  total_.left = std::max(total_.left, last_.left);
  total_.fallbacks = last_.fallbacks;
  total_.overflows = last_.overflows;
}

std::string CollisionStats::summary() const {
  if (steps_ == 0) return "none";
  const auto steps = static_cast<double>(steps_);
  return fmt::format(
      "{:.1f} contacts a step (most {}), {:.1f} pairs touching (most {}), {} began, {} ended, deepest left {:.3f} mm, "
      "{} fallbacks, {} overflows",
      static_cast<double>(total_.contacts) / steps, most_contacts_, static_cast<double>(total_.pairs) / steps,
      most_pairs_, total_.began, total_.ended, 1e3 * static_cast<double>(total_.left), total_.fallbacks,
      total_.overflows);
}

std::string CollisionStats::to_table() const {
  struct Line {
    const Row* row;
    std::uint64_t steps;
  };
  std::vector<Line> lines;
  for (const Owner& owner : owners_) {
    for (const Row& row : owner.rows) {
      if (row.contacts > 0.0) lines.push_back({&row, owner.steps});
    }
  }
  if (lines.empty()) return {};
  std::stable_sort(lines.begin(), lines.end(),
                   [](const Line& a, const Line& b) { return a.row->depth > b.row->depth; });
  std::string text = fmt::format("\n{:<16}  {:<32}  {:>9}  {:>9}  {:>12}  {:>14}\n", "owner", "muscle", "contacts",
                                 "most", "left max, mm", "steps > 0.5 mm");
  for (const Line& line : lines) {
    text += fmt::format("{:<16}  {:<32}  {:>9.1f}  {:>9.0f}  {:>12.3f}  {:>14}\n", line.row->owner, line.row->muscle,
                        line.row->contacts / static_cast<double>(line.steps), static_cast<double>(line.row->most),
                        1e3 * static_cast<double>(line.row->depth), line.row->deep_steps);
  }
  return text;
}

}  // namespace fascicle::game
