#include "tools/fascicle_cook/choose_tags.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/content/edit_collision.hpp"
#include "modules/muscle/content/tag_place.hpp"

namespace fascicle::cook {
namespace {

using muscle::CharacterAsset;
using muscle::MuscleAsset;
using muscle::SectionTag;
using muscle::TransversalTag;

TransversalTag make_tag(const MuscleAsset& asset, const FacingList& list, const Facing& facing) {
  TransversalTag tag;
  tag.first = as_written(tag_of(asset, list.muscle, facing.section, facing.vertex));
  tag.bone = list.bone;
  if (list.bone < 0) {
    tag.second = as_written(tag_of(asset, list.other, facing.other_section, facing.other_vertex));
  }
  tag.automatic = true;
  return tag;
}

// Whether `tag` is, but for a section and a vertex, the mirror image of `original`.
bool is_image(const CharacterAsset& character, const SectionTag& original, const SectionTag& tag) {
  const MuscleAsset& asset = *character.muscles;
  const muscle::MuscleLayout& layout = asset.muscles[tag.muscle];
  const SectionTag image = mirror_tag(asset, original, tag.muscle, character.mirror.axis);
  const float turn = 2.0f * std::numbers::pi_v<float>;
  float apart = std::abs(image.angle - tag.angle);
  apart = std::min(apart, turn - apart);
  const float step = 1.5f * turn / static_cast<float>(layout.section_vertices);
  const float section = 1.5f / static_cast<float>(layout.section_count - 1);
  return apart < step && std::abs(image.fraction - tag.fraction) < section;
}

// Arc lengths along the muscle where the author has tagged it with the other, or the bone.
std::vector<float> author_places(const CharacterAsset& character, const FacingList& list) {
  const MuscleAsset& asset = *character.muscles;
  const float length = arc_at(asset, list.muscle, asset.muscles[list.muscle].section_count - 1);
  std::vector<float> places;
  for (const TransversalTag& tag : character.collision.transversals) {
    if (tag.automatic || tag.bone != list.bone) continue;
    const bool of_bone = list.bone >= 0;
    if (tag.first.muscle == list.muscle && (of_bone || tag.second.muscle == list.other)) {
      places.push_back(length * tag.first.fraction);
    } else if (!of_bone && tag.second.muscle == list.muscle && tag.first.muscle == list.other) {
      places.push_back(length * tag.second.fraction);
    }
  }
  return places;
}

// Sections of the muscle, rising, that are closest to the other on either side and keep their distance.
std::vector<std::uint32_t> choose_sections(const CharacterAsset& character, const FacingList& list,
                                           const FacingList* image, float every) {
  std::map<std::uint32_t, float> closest;
  for (const FacingList* side : {&list, image}) {
    if (side == nullptr) continue;
    for (const auto& [section, facing] : side->sections) {
      const auto [known, fresh] = closest.emplace(section, facing.distance);
      if (!fresh) known->second = std::min(known->second, facing.distance);
    }
  }
  std::vector<std::pair<float, std::uint32_t>> order;
  for (const auto& [section, distance] : closest) order.emplace_back(distance, section);
  std::sort(order.begin(), order.end());
  std::vector<float> taken = author_places(character, list);
  std::vector<std::uint32_t> chosen;
  for (const auto& [distance, section] : order) {
    const float arc = arc_at(*character.muscles, list.muscle, section);
    const auto crowds = [&](float other) { return std::abs(other - arc) < every; };
    if (std::any_of(taken.begin(), taken.end(), crowds)) continue;
    taken.push_back(arc);
    chosen.push_back(section);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

const Facing* find_facing(const FacingList* list, std::uint32_t section) {
  if (list == nullptr) return nullptr;
  const auto at = list->sections.find(section);
  return at == list->sections.end() ? nullptr : &at->second;
}

}  // namespace

float arc_at(const MuscleAsset& asset, std::uint32_t m, std::uint32_t section) {
  return asset.rest_arc[asset.slot(m, section)];
}

void choose_tags(const CharacterAsset& character, const FacingList& list, const FacingList* image, float every,
                 std::vector<FoundTransversal>& found) {
  const MuscleAsset& asset = *character.muscles;
  const std::optional<bool> one_side = character.mirror.axis >= 0 ? std::optional(false) : std::nullopt;
  for (const std::uint32_t section : choose_sections(character, list, image, every)) {
    const Facing* here = find_facing(&list, section);
    const Facing* there = find_facing(image, section);
    if (here != nullptr && there != nullptr) {
      const TransversalTag tag = make_tag(asset, list, *here), other = make_tag(asset, *image, *there);
      if (is_image(character, tag.first, other.first) &&
          (tag.bone >= 0 || is_image(character, tag.second, other.second))) {
        found.push_back({tag, std::min(here->distance, there->distance), std::nullopt});
        continue;
      }
    }
    if (here != nullptr) found.push_back({make_tag(asset, list, *here), here->distance, one_side});
    if (there != nullptr) found.push_back({make_tag(asset, *image, *there), there->distance, one_side});
  }
}

}  // namespace fascicle::cook
