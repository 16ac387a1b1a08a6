// Gathers what the overlay shows from the running simulation, and keeps the texts that it points to.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "engine/loop/cost_ledger.hpp"
#include "engine/render/overlay.hpp"
#include "engine/render/renderer.hpp"
#include "game/collision_stats.hpp"
#include "game/simulation.hpp"

namespace fascicle::game {

// The overlay's switches, in this order; each flips a field of the DrawView.
struct ViewSwitch {
  const char* name;
  const char* shortcut;
  Key key;
  bool DrawView::* field;
};
inline constexpr std::array<ViewSwitch, 9> kViewSwitches = {{
    {"skin", "S", Key::s, &DrawView::skins},
    {"bones", "B", Key::b, &DrawView::meshes},
    {"muscles", "M", Key::m, &DrawView::strips},
    {"action lines", "A", Key::a, &DrawView::lines},
    {"sections", "C", Key::c, &DrawView::rings},
    {"tendons", "T", Key::t, &DrawView::tendons},
    {"fibres", "F", Key::f, &DrawView::fibres},
    {"ground", "G", Key::g, &DrawView::ground},
    {"collision", "K", Key::k, &DrawView::marks},
}};

class OverlayFeed {
 public:
  OverlayFeed(std::string title, std::string subtitle) : title_(std::move(title)), subtitle_(std::move(subtitle)) {}

  // Call after each simulation step: smooths the systems' times.
  void record_step(const ecs::Schedule& schedule);
  // The model of this frame; what it points to lives until the next call. `shown` is the character whose muscles are
  // listed.
  const OverlayModel& build(Simulation& simulation, const Renderer& renderer, const DrawView& view,
                            float frame_milliseconds, std::size_t shown, const CollisionStats& collision,
                            const OverlayTask& task);

  // Messages of a live reload, until the next one or until dismissed.
  void set_messages(const Diagnostics& diagnostics);
  void clear_messages();
  bool has_errors() const { return !errors_.empty(); }

  // What the user set for a muscle of the shown character, by its name.
  struct ItemState {
    bool visible = true;
    bool highlighted = false;
  };
  ItemState& item_state(const std::string& name) { return item_states_[name]; }
  // Of an item of the last model, whose index the overlay's actions tell: its name; empty where there is none.
  std::string item_name(std::size_t index) const;

 private:
  // A column of the list of muscles, and how it is filled in.
  enum Column : std::size_t { kLength, kVolume, kShare, kForce, kContacts, kDepth, kVertices, kHull, kSolve, kColumns };

  void list_items(const Simulation& simulation, std::size_t shown);
  void list_units(const Simulation& simulation, const SpawnedCharacter& character, const std::string& owner);
  void list_surfaces(const Simulation& simulation, const SpawnedCharacter& character, const std::string& owner);
  void choose_columns();
  void read_costs(const Simulation& simulation);
  float cost_of(const std::string& owner, const std::string& item) const;  // us; NaN: not measured

  std::string title_, subtitle_;
  std::vector<std::string> errors_, warnings_;
  std::vector<float> smoothed_ms_;  // one a system
  std::vector<OverlayTiming> systems_, gpu_, counts_;
  std::vector<OverlaySwitch> switches_;
  std::array<OverlaySlider, 1> sliders_;
  std::vector<OverlayItem> items_;
  std::vector<ItemCost> costs_;  // what the ledger last gave of the solve
  int builds_ = 0;
  std::map<std::string, ItemState> item_states_;
  OverlayModel model_;
};

}  // namespace fascicle::game
