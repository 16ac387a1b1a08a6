// What a system reads and writes, as the schedule knows it from the system's signature. Two systems conflict when one
// writes a component or resource type that the other reads or writes; then the one registered earlier runs first.
#pragma once

#include <string>
#include <vector>

#include "engine/ecs/type_info.hpp"

namespace fascicle::ecs {

struct AccessEntry {
  TypeId type = nullptr;
  bool resource = false;  // else a component
  bool write = false;
};

class Access {
 public:
  // A second declaration of the same type adds to the first: a write wins over a read.
  void declare(AccessEntry entry);
  void declare_commands() { commands_ = true; }

  const std::vector<AccessEntry>& entries() const { return entries_; }  // sorted by name
  // Commands go to a list of the system's own and are no conflict.
  bool commands() const { return commands_; }

 private:
  std::vector<AccessEntry> entries_;
  bool commands_ = false;
};

// Names of the types on which the two conflict; empty when they may run side by side.
std::vector<std::string_view> find_conflicts(const Access& earlier, const Access& later);

// "reads ActionLine, FrameTime; writes CrossSections; commands"
std::string to_text(const Access& access);

}  // namespace fascicle::ecs
