#include "engine/loop/cost_ledger.hpp"

#include <algorithm>
#include <utility>

namespace fascicle {

namespace {
constexpr std::uint32_t kNoOwner = 0xffffffff;
constexpr double kMsPerNs = 1e-6;
}  // namespace

void CostLedger::Extent::take(std::int64_t ns, bool first) {
  total += ns;
  min = first ? ns : std::min(min, ns);
  max = first ? ns : std::max(max, ns);
}

void CostLedger::lay_cells(Owner& owner) const {
  const std::size_t count = enabled_ ? systems_.size() * (1 + owner.items.size()) : 0;
  owner.frames = 0;
  owner.cells.assign(count, 0);
  owner.extents.assign(count, Extent{});
  owner.cells.shrink_to_fit();
  owner.extents.shrink_to_fit();
}

void CostLedger::set_enabled(bool enabled) {
  if (enabled == enabled_) return;
  enabled_ = enabled;
  for (Owner& owner : owners_) lay_cells(owner);
}

void CostLedger::add_system(std::string_view name) {
  if (std::find(systems_.begin(), systems_.end(), name) != systems_.end()) return;
  systems_.emplace_back(name);
  for (Owner& owner : owners_) lay_cells(owner);
}

void CostLedger::add_owner(ecs::Entity entity, std::string label, std::span<const std::string> item_labels) {
  if (entity == ecs::kNoEntity) return;
  remove_owner(entity);
  if (entity.index >= owner_of_index_.size()) owner_of_index_.resize(entity.index + std::size_t{1}, kNoOwner);
  // An earlier use of the index that was never taken out.
  if (owner_of_index_[entity.index] != kNoOwner) remove_owner(owners_[owner_of_index_[entity.index]].entity);
  owner_of_index_[entity.index] = static_cast<std::uint32_t>(owners_.size());
  Owner& owner = owners_.emplace_back();
  owner.entity = entity;
  owner.label = std::move(label);
  owner.items.assign(item_labels.begin(), item_labels.end());
  lay_cells(owner);
}

void CostLedger::remove_owner(ecs::Entity entity) {
  const Owner* found = find_owner(entity);
  if (found == nullptr) return;
  owner_of_index_[entity.index] = kNoOwner;
  owners_.erase(owners_.begin() + (found - owners_.data()));
  for (std::size_t i = 0; i < owners_.size(); ++i) {
    owner_of_index_[owners_[i].entity.index] = static_cast<std::uint32_t>(i);
  }
}

const CostLedger::Owner* CostLedger::find_owner(ecs::Entity entity) const {
  if (entity.index >= owner_of_index_.size() || owner_of_index_[entity.index] == kNoOwner) return nullptr;
  const Owner& owner = owners_[owner_of_index_[entity.index]];
  return owner.entity == entity ? &owner : nullptr;
}

SystemCosts CostLedger::system(std::string_view name) const {
  if (!enabled_) return {};
  const auto found = std::find(systems_.begin(), systems_.end(), name);
  if (found == systems_.end()) return {};
  return {this, static_cast<std::size_t>(found - systems_.begin())};
}

CostRow CostLedger::row(std::size_t system, ecs::Entity entity) const {
  const Owner* owner = find_owner(entity);
  if (owner == nullptr || owner->cells.empty()) return {};
  const std::size_t width = 1 + owner->items.size();
  return CostRow(std::span<std::int64_t>(owner->cells).subspan(system * width, width));
}

void CostLedger::end_frame(bool warm_up) {
  for (Owner& owner : owners_) {
    if (owner.cells.empty()) continue;
    const std::size_t width = 1 + owner.items.size();
    for (std::size_t first = 0; !warm_up && first < owner.cells.size(); first += width) {
      std::int64_t sum = owner.cells[first];
      for (std::size_t i = first + 1; i < first + width; ++i) {
        owner.extents[i].take(owner.cells[i], owner.frames == 0);
        sum += owner.cells[i];
      }
      owner.extents[first].take(sum, owner.frames == 0);
    }
    std::fill(owner.cells.begin(), owner.cells.end(), 0);
    if (!warm_up) ++owner.frames;
  }
}

std::vector<ItemCost> CostLedger::statistics() const {
  std::vector<ItemCost> result;
  for (std::size_t system = 0; system < systems_.size(); ++system) {
    for (const Owner& owner : owners_) {
      const std::size_t width = 1 + owner.items.size();
      for (std::size_t i = 0; i < width && !owner.extents.empty(); ++i) {
        const Extent& extent = owner.extents[system * width + i];
        if (extent.total == 0) continue;
        const auto frames = static_cast<double>(owner.frames);
        result.push_back({systems_[system], owner.label, i == 0 ? std::string() : owner.items[i - 1], owner.frames,
                          static_cast<double>(extent.min) * kMsPerNs,
                          static_cast<double>(extent.total) * kMsPerNs / frames,
                          static_cast<double>(extent.max) * kMsPerNs});
      }
    }
  }
  return result;
}

}  // namespace fascicle
