// Time per character and per muscle (or whatever else a system works through), on request. The ledger is a resource; a
// system that can tell its items' times apart takes `Resource<const CostLedger>` and writes nanoseconds into cells:
//
//   const SystemCosts costs = ledger->system("solve_constraints");
//   view.each([&](Entity character, ...) {
//     const CostRow row = costs.row(character);
//     for (std::uint32_t muscle = 0; muscle < count; ++muscle) {
//       const ScopedCost timer(row, muscle);   // reads no clock while the ledger is off
//       ...
//     }
//   });
//
// Cells are written through a const ledger, so that systems which share it still run side by side. That is safe because
// a cell has one writer: the system it is named after, on the one thread that works on that item.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/ecs/entity.hpp"
#include "engine/ecs/monotonic_clock.hpp"

namespace fascicle {

// The cells of one system and one owner. Empty while the ledger is off: adding then does nothing.
class CostRow {
 public:
  CostRow() = default;
  explicit CostRow(std::span<std::int64_t> cells) : cells_(cells) {}

  explicit operator bool() const { return !cells_.empty(); }
  // Time of item `item` of the owner, ns; adds up within a frame. Items beyond those announced are not kept.
  void add(std::uint32_t item, std::int64_t ns) const {
    if (std::size_t{item} + 1 < cells_.size()) cells_[std::size_t{item} + 1] += ns;
  }
  // Time spent on the owner as a whole, where items cannot be told apart.
  void add_whole(std::int64_t ns) const {
    if (!cells_.empty()) cells_[0] += ns;
  }

 private:
  std::span<std::int64_t> cells_;  // the owner's own, then one an item
};

// Adds the time between construction and destruction to an item, or to the whole owner.
class ScopedCost {
 public:
  static constexpr std::uint32_t kWhole = 0xffffffff;

  ScopedCost(const CostRow& row, std::uint32_t item) : row_(row), item_(item), start_(row ? monotonic_ns() : 0) {}
  ~ScopedCost() {
    if (!row_) return;
    const std::int64_t ns = monotonic_ns() - start_;
    item_ == kWhole ? row_.add_whole(ns) : row_.add(item_, ns);
  }
  ScopedCost(const ScopedCost&) = delete;
  ScopedCost& operator=(const ScopedCost&) = delete;

 private:
  CostRow row_;
  std::uint32_t item_;
  std::int64_t start_;
};

class CostLedger;

// One system's part of the ledger; empty while the ledger is off or for a system it does not know.
class SystemCosts {
 public:
  SystemCosts() = default;
  explicit operator bool() const { return ledger_ != nullptr; }
  inline CostRow row(ecs::Entity owner) const;

 private:
  friend class CostLedger;
  SystemCosts(const CostLedger* ledger, std::size_t system) : ledger_(ledger), system_(system) {}

  const CostLedger* ledger_ = nullptr;
  std::size_t system_ = 0;
};

// Time a frame of one system on one item, or on an owner: its items' and its own together (`item` is empty then).
struct ItemCost {
  std::string system;
  std::string owner;
  std::string item;
  std::uint64_t frames = 0;
  double min_ms = 0;
  double mean_ms = 0;
  double max_ms = 0;
};

class CostLedger {
 public:
  bool enabled() const { return enabled_; }
  // Between frames only, as all that follows but system(). Takes memory for all cells while on.
  void set_enabled(bool enabled);

  // Announces a system; again changes nothing.
  void add_system(std::string_view name);
  // Announces an owner (a character) and its items (its muscles), item i with labels[i]. Again replaces the old ones.
  void add_owner(ecs::Entity owner, std::string label, std::span<const std::string> item_labels);
  void remove_owner(ecs::Entity owner);

  // By any thread, within a frame.
  SystemCosts system(std::string_view name) const;

  // Takes the frame's cells into the statistics (unless it is a warm-up frame) and clears them.
  void end_frame(bool warm_up = false);

  // For each system and owner: the owner's row, then its items'. Those never written are left out.
  std::vector<ItemCost> statistics() const;

 private:
  friend class SystemCosts;

  struct Extent {
    std::int64_t total = 0;
    std::int64_t min = 0;
    std::int64_t max = 0;
    void take(std::int64_t ns, bool first);
  };
  struct Owner {
    ecs::Entity entity;
    std::string label;
    std::vector<std::string> items;
    std::uint64_t frames = 0;
    // Mutable: written by systems through a const ledger, a cell by one thread (see above).
    mutable std::vector<std::int64_t> cells;  // systems x (1 + items)
    std::vector<Extent> extents;              // systems x (1 + items); the first of a system: the sum
  };

  void lay_cells(Owner& owner) const;
  const Owner* find_owner(ecs::Entity entity) const;
  CostRow row(std::size_t system, ecs::Entity entity) const;

  bool enabled_ = false;
  std::vector<std::string> systems_;
  std::vector<Owner> owners_;
  std::vector<std::uint32_t> owner_of_index_;  // by entity index: place in owners_
};

inline CostRow SystemCosts::row(ecs::Entity owner) const {
  return ledger_ == nullptr ? CostRow() : ledger_->row(system_, owner);
}

}  // namespace fascicle
