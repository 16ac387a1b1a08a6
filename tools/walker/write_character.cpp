#include "tools/walker/write_character.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "tools/walker/skeleton.hpp"

namespace fascicle::walker {
namespace {

// At most 7 decimals (0.1 micrometre), without trailing zeros or a negative nought.
std::string number(double value) {
  std::string text = fmt::format("{:.7f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

// Ends that are attached to a patch of bone rather than a point, where their meshes say so.
constexpr std::array<std::string_view, 4> kWideOrigins{"gluteus_medius_2_r", "gluteus_medius_3_r", "adductor_magnus_2_r",
                                                       "vastus_intermedius_r"};
constexpr std::array<std::string_view, 1> kWideInsertions{"quadratus_femoris_r"};

std::string point(const PathPoint& p, bool counts_field) {
  const bool counts = p.kind == PointKind::kPublished;
  return fmt::format(R"({{ "bone": "{}", "position": [{}, {}, {}]{} }})", p.bone, number(p.position.x),
                     number(p.position.y), number(p.position.z), counts_field && !counts ? R"(, "counts": false)" : "");
}

std::string end_point(const PathPoint& p, std::span<const std::string_view> wide, std::string_view muscle) {
  std::string text = point(p, false);
  if (std::ranges::find(wide, muscle) != wide.end()) text.insert(text.size() - 2, R"(, "area": { "within_mm": 4 })");
  return text;
}

std::string muscle_text(const MuscleSpec& muscle) {
  std::string text = fmt::format("    {{ \"name\": \"{}\", \"mirror\": true,\n", muscle.name);
  text += fmt::format("      \"origin\": {},\n", end_point(muscle.path.front(), kWideOrigins, muscle.name));
  if (muscle.path.size() > 2) {
    text += "      \"via\": [";
    for (std::size_t i = 1; i + 1 < muscle.path.size(); ++i)
      text += fmt::format("{}\n        {}", i == 1 ? "" : ",", point(muscle.path[i], true));
    text += " ],\n";
  }
  text += fmt::format("      \"insertion\": {},\n", end_point(muscle.path.back(), kWideInsertions, muscle.name));
  text += fmt::format(
      "      \"max_isometric_force\": {}, \"optimal_fibre_length\": {}, \"tendon_slack_length\": {}, \"pennation\": "
      "{},\n",
      number(muscle.max_isometric_force), number(muscle.optimal_fibre_length), number(muscle.tendon_slack_length),
      number(muscle.pennation));
  // A line of one segment needs more sections to follow its mesh than those of several.
  const char* level = muscle.path.size() == 2 ? "\"longitudinal_subdivision\": 3, " : "";
  text += fmt::format("      \"source_length\": {}, {}\"mesh\": \"{}\" }}", number(published_length(muscle)), level,
                      muscle.name);
  return text;
}

}  // namespace

bool write_character(const std::filesystem::path& file, const std::vector<MuscleSpec>& muscles) {
  std::string text = R"({
  "$schema": "../../schema/character.schema.json",
  "version": 1,
  "name": "walker",
  "skeleton": { "gltf": "walker.glb" },
  "skin": { "gltf": "walker.glb", "meshes": ["skin"] },
  "bone_meshes": [)";
  for (std::size_t i = 0; i < bones().size(); ++i)
    text += fmt::format("{}\n    {{ \"bone\": \"{}\", \"file\": \"bones.glb#{}\" }}", i == 0 ? "" : ",",
                        bones()[i].name, bones()[i].name);
  text += R"(
  ],
  "muscle_meshes": { "file": "muscles.glb", "bones_space": "character" },
  "mirror": { "axis": "x", "bones": [["_r", "_l"]], "names": [["_r", "_l"]] },
  "attachment_space": "bone",
  "level": { "section_vertices": 16, "longitudinal_subdivision": 2 },
  "specific_tension": 610000,
  "collision": "walker.collision.json",
  "muscles": [
)";
  for (std::size_t i = 0; i < muscles.size(); ++i)
    text += muscle_text(muscles[i]) + (i + 1 < muscles.size() ? ",\n" : "\n");
  text += "  ]\n}\n";
  std::ofstream out(file, std::ios::binary);
  out << text;
  return static_cast<bool>(out);
}

}  // namespace fascicle::walker
