#include "tools/fascicle_cook/inside_table.hpp"

#include <array>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "engine/animation/skeleton.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/asset/fit/fit_muscles.hpp"

namespace fascicle::cook {
namespace {

using namespace fascicle::muscle;

constexpr std::uint32_t kMostSupersampling = 6;
constexpr std::array<std::uint32_t, 4> kSectionVertices{6, 8, 10, 12};
constexpr std::array<std::uint32_t, 2> kSubdivisions{1, 2};

std::size_t count_outside(const CharacterAsset& character, std::uint32_t supersampling, std::uint32_t section_vertices,
                          std::uint32_t subdivision) {
  std::vector<MuscleDescription> descriptions = character.descriptions;
  std::vector<FitInput> inputs;
  for (MuscleDescription& description : descriptions) {
    const auto mesh = character.muscle_meshes.find(description.name);
    if (mesh == character.muscle_meshes.end()) continue;
    description.section_vertices = section_vertices;
    description.longitudinal_subdivision = subdivision;
    // Extra via points would add sections that the article's count does not have.
    std::erase_if(description.attachments, [](const AttachmentDescription& attachment) { return !attachment.counts; });
    inputs.push_back({.description = &description, .mesh = mesh->second.get(), .areas = {}});
  }
  const FitOptions options{.supersampling = supersampling, .restore_ends = false, .rescue = false};
  std::size_t outside = 0;
  for (const FittedMuscle& fitted : fit_muscles(inputs, character.skeleton->rest_world, options)) {
    for (const SectionReport& section : fitted.sections) outside += section.inside ? 0 : 1;
  }
  return outside;
}

}  // namespace

Result<std::string> make_inside_table(const CharacterAsset& character) {
  if (character.muscle_meshes.empty()) {
    return Diagnostic{character.name, 0, 0, {}, "no muscle has a mesh", "give them meshes: \"mesh\" in the character file"};
  }
  std::string table;
  for (std::uint32_t supersampling = 1; supersampling <= kMostSupersampling; ++supersampling) {
    table += fmt::format("CSS {}:", supersampling);
    for (const std::uint32_t subdivision : kSubdivisions) {
      if (subdivision != kSubdivisions.front()) table += " |";
      for (const std::uint32_t section_vertices : kSectionVertices) {
        table += fmt::format(" {}", count_outside(character, supersampling, section_vertices, subdivision));
      }
    }
    table += '\n';
  }
  return table;
}

}  // namespace fascicle::cook
