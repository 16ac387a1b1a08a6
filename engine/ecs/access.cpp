#include "engine/ecs/access.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace fascicle::ecs {

void Access::declare(AccessEntry entry) {
  for (AccessEntry& known : entries_) {
    if (known.type == entry.type && known.resource == entry.resource) {
      known.write = known.write || entry.write;
      return;
    }
  }
  const auto by_name = [](const AccessEntry& a, const AccessEntry& b) {
    return std::tie(a.type->name, a.type->full_name) < std::tie(b.type->name, b.type->full_name);
  };
  entries_.insert(std::upper_bound(entries_.begin(), entries_.end(), entry, by_name), entry);
}

std::vector<std::string_view> find_conflicts(const Access& earlier, const Access& later) {
  std::vector<std::string_view> names;
  for (const AccessEntry& a : earlier.entries()) {
    for (const AccessEntry& b : later.entries()) {
      if (a.type == b.type && a.resource == b.resource && (a.write || b.write)) names.push_back(a.type->name);
    }
  }
  return names;
}

std::string to_text(const Access& access) {
  std::string text;
  for (const bool write : {false, true}) {
    const char* separator = write ? "writes " : "reads ";
    for (const AccessEntry& entry : access.entries()) {
      if (entry.write != write) continue;
      if (*separator != ',' && !text.empty()) text += "; ";
      text += fmt::format("{}{}", separator, entry.type->name);
      separator = ", ";
    }
  }
  if (access.commands()) text += text.empty() ? "commands" : "; commands";
  return text.empty() ? "nothing" : text;
}

}  // namespace fascicle::ecs
