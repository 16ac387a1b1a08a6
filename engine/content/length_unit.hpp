// The units that content and tools know for meshes' numbers, one list for all.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace fascicle {

struct LengthUnit {
  std::string_view name;
  float metres = 1.0f;
};

inline constexpr std::array<LengthUnit, 5> kLengthUnits{
    {{"m", 1.0f}, {"cm", 0.01f}, {"mm", 0.001f}, {"in", 0.0254f}, {"ft", 0.3048f}}};

// Metres a unit; nothing for a name that is not in the list.
constexpr std::optional<float> metres_of(std::string_view name) {
  for (const LengthUnit& unit : kLengthUnits) {
    if (unit.name == name) return unit.metres;
  }
  return std::nullopt;
}

}  // namespace fascicle
