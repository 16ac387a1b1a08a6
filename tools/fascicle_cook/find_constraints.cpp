#include "tools/fascicle_cook/find_constraints.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "modules/muscle/content/edit_collision.hpp"
#include "modules/muscle/content/tag_place.hpp"
#include "tools/fascicle_cook/close_sections.hpp"

namespace fascicle::cook {
namespace {

using muscle::CharacterAsset;
using muscle::MuscleAsset;
using muscle::SectionTag;
using muscle::TransversalTag;

using Pair = std::pair<std::uint32_t, std::uint32_t>;

// A pair of sections that face each other, in the pose in which they are closest.
struct Facing {
  std::uint32_t section = 0, vertex = 0;              // of the pair's first muscle
  std::uint32_t other_section = 0, other_vertex = 0;  // of its second
  float distance = 0.0f;                              // m
};

// What has been found of one pair so far: by section of its first muscle.
struct PairRecord {
  std::map<std::uint32_t, Facing> facing;
  std::set<std::uint32_t> close;  // sections that were close in some pose
};

// Pairs of muscles to look at, each once, a pair beside its mirror image: `image` is its place in the list, or none.
struct PairList {
  struct Entry {
    Pair pair;
    std::ptrdiff_t image = -1;  // a mirrored pair is the entry after its original
    bool is_image = false;
  };
  std::vector<Entry> entries;
};

Pair in_order(Pair pair) { return {std::min(pair.first, pair.second), std::max(pair.first, pair.second)}; }

PairList list_pairs(const CharacterAsset& character) {
  const auto count = static_cast<std::uint32_t>(character.descriptions.size());
  const MuscleAsset& asset = *character.muscles;
  std::set<Pair> ignored, listed;
  for (const muscle::IgnoredPair& pair : character.collision.ignored) {
    if (pair.bone < 0) ignored.insert(in_order({pair.muscle, pair.other}));
  }
  const auto image_of = [&](std::uint32_t m) { return character.mirror.axis < 0 ? -1 : character.mirror.muscles[m]; };
  const auto alike = [&](std::uint32_t m, std::int32_t image) {
    return image >= 0 &&
           asset.muscles[m].section_count == asset.muscles[static_cast<std::uint32_t>(image)].section_count;
  };
  PairList list;
  for (std::uint32_t x = 0; x < count; ++x) {
    for (std::uint32_t y = x + 1; y < count; ++y) {
      if (!listed.insert({x, y}).second) continue;
      const bool wanted = !ignored.contains({x, y});
      if (wanted) list.entries.push_back({.pair = {x, y}});
      if (!alike(x, image_of(x)) || !alike(y, image_of(y))) continue;
      const Pair image{static_cast<std::uint32_t>(image_of(x)), static_cast<std::uint32_t>(image_of(y))};
      if (ignored.contains(in_order(image)) || !listed.insert(in_order(image)).second) continue;
      if (wanted) list.entries.back().image = static_cast<std::ptrdiff_t>(list.entries.size());
      list.entries.push_back({.pair = image, .is_image = wanted});
    }
  }
  return list;
}

// All muscles of one pose.
struct Pose {
  std::vector<std::vector<glm::vec3>> vertices;      // by muscle
  std::vector<std::unique_ptr<const Solid>> solids;
};

Pose take_pose(PosedMuscles& muscles, const std::vector<TriangleMesh>& rest, const std::vector<glm::mat4>& bones) {
  muscles.pose(bones);
  const std::size_t count = rest.size();
  Pose pose{std::vector<std::vector<glm::vec3>>(count), std::vector<std::unique_ptr<const Solid>>(count)};
  parallel::for_range(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m) {
      pose.vertices[m] = muscles.vertices(static_cast<std::uint32_t>(m));
      TriangleMesh mesh = rest[m];
      mesh.positions = pose.vertices[m];
      mesh.normals.clear();
      pose.solids[m] = std::make_unique<const Solid>(mesh);
    }
  });
  return pose;
}

float arc_at(const MuscleAsset& asset, std::uint32_t m, std::uint32_t section) {
  return asset.rest_arc[asset.slot(m, section)];
}

// How far a section (no end) is from the further one of its neighbours, m.
float spacing(const MuscleAsset& asset, std::uint32_t m, std::uint32_t section) {
  const float here = arc_at(asset, m, section);
  return std::max(here - arc_at(asset, m, section - 1), arc_at(asset, m, section + 1) - here);
}

void look_at_pair(const PosedMuscles& muscles, const Pose& pose, const Pair& pair, float near, PairRecord& record) {
  const auto [x, y] = pair;
  if (!pose.solids[x]->bounds().near(pose.solids[y]->bounds(), near)) return;
  const glm::mat4 still(1.0f);
  const auto of_x = close_sections(muscles, x, pose.vertices[x], *pose.solids[y], still, near);
  if (of_x.empty()) return;
  const auto of_y = close_sections(muscles, y, pose.vertices[y], *pose.solids[x], still, near);
  for (const CloseSection& section : of_x) {
    record.close.insert(section.section);
    const CloseSection* partner = nullptr;
    float nearest = 0.0f;
    for (const CloseSection& other : of_y) {
      const float apart = glm::distance(other.place, section.place);
      if (partner != nullptr && apart >= nearest) continue;
      partner = &other;
      nearest = apart;
    }
    if (partner == nullptr || section.buried || partner->buried) continue;
    if (glm::dot(section.outward, partner->outward) >= 0.0f) continue;
    if (nearest > near + spacing(muscles.asset(), y, partner->section)) continue;
    const Facing facing{section.section, section.vertex, partner->section, partner->vertex,
                        std::min(section.distance, partner->distance)};
    const auto [known, fresh] = record.facing.emplace(section.section, facing);
    if (!fresh && facing.distance < known->second.distance) known->second = facing;
  }
}

TransversalTag make_tag(const MuscleAsset& asset, const Pair& pair, const Facing& facing) {
  TransversalTag tag;
  tag.first = as_written(tag_of(asset, pair.first, facing.section, facing.vertex));
  tag.second = as_written(tag_of(asset, pair.second, facing.other_section, facing.other_vertex));
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

// Arc lengths along the pair's first muscle where the author has tagged it with its second.
std::vector<float> author_places(const CharacterAsset& character, const Pair& pair) {
  const MuscleAsset& asset = *character.muscles;
  const float length = arc_at(asset, pair.first, asset.muscles[pair.first].section_count - 1);
  std::vector<float> places;
  for (const TransversalTag& tag : character.collision.transversals) {
    if (tag.automatic || tag.bone >= 0) continue;
    if (Pair{tag.first.muscle, tag.second.muscle} == pair) places.push_back(length * tag.first.fraction);
    if (Pair{tag.second.muscle, tag.first.muscle} == pair) places.push_back(length * tag.second.fraction);
  }
  return places;
}

class Chooser {
 public:
  Chooser(const CharacterAsset& character, const ConstrainOptions& options, FoundConstraints& found)
      : character_(character), options_(options), found_(found) {}

  // `image`: what was found of the mirrored pair, or null.
  void choose(const Pair& pair, const PairRecord& record, const Pair& image_pair, const PairRecord* image) {
    count(record);
    if (image != nullptr) count(*image);
    const MuscleAsset& asset = *character_.muscles;
    std::map<std::uint32_t, float> closest;  // by section, over both sides
    for (const PairRecord* side : {&record, image}) {
      if (side == nullptr) continue;
      for (const auto& [section, facing] : side->facing) {
        const auto [known, fresh] = closest.emplace(section, facing.distance);
        if (!fresh) known->second = std::min(known->second, facing.distance);
      }
    }
    std::vector<std::pair<float, std::uint32_t>> order;
    for (const auto& [section, distance] : closest) order.emplace_back(distance, section);
    std::sort(order.begin(), order.end());
    std::vector<float> taken = author_places(character_, pair);
    std::vector<std::uint32_t> chosen;
    for (const auto& [distance, section] : order) {
      const float arc = arc_at(asset, pair.first, section);
      const auto crowds = [&](float other) { return std::abs(other - arc) < options_.every; };
      if (std::any_of(taken.begin(), taken.end(), crowds)) continue;
      taken.push_back(arc);
      chosen.push_back(section);
    }
    std::sort(chosen.begin(), chosen.end());
    for (const std::uint32_t section : chosen) {
      const auto here = record.facing.find(section);
      const Facing* there = nullptr;
      if (image != nullptr) {
        const auto at = image->facing.find(section);
        if (at != image->facing.end()) there = &at->second;
      }
      write(pair, here == record.facing.end() ? nullptr : &here->second, image_pair, there);
    }
  }

 private:
  void count(const PairRecord& record) {
    found_.close_pairs += record.close.empty() ? 0 : 1;
    found_.close_sections += record.facing.size();
    found_.buried += record.close.size() - record.facing.size();
  }

  void write(const Pair& pair, const Facing* here, const Pair& image_pair, const Facing* there) {
    const MuscleAsset& asset = *character_.muscles;
    const bool has_sides = character_.mirror.axis >= 0;
    const std::optional<bool> one_side = has_sides ? std::optional(false) : std::nullopt;
    if (here != nullptr && there != nullptr) {
      const TransversalTag tag = make_tag(asset, pair, *here), image = make_tag(asset, image_pair, *there);
      if (is_image(character_, tag.first, image.first) && is_image(character_, tag.second, image.second)) {
        found_.transversals.push_back({tag, std::min(here->distance, there->distance), std::nullopt});
        return;
      }
    }
    if (here != nullptr) found_.transversals.push_back({make_tag(asset, pair, *here), here->distance, one_side});
    if (there != nullptr) {
      found_.transversals.push_back({make_tag(asset, image_pair, *there), there->distance, one_side});
    }
  }

  const CharacterAsset& character_;
  const ConstrainOptions& options_;
  FoundConstraints& found_;
};

using Nearness = std::map<std::int32_t, float>;  // m, by bone

std::vector<Nearness> drop_ignored(const CharacterAsset& character, std::vector<Nearness> near) {
  for (const muscle::IgnoredPair& pair : character.collision.ignored) {
    if (pair.bone >= 0) near[pair.muscle].erase(pair.bone);
  }
  for (const muscle::BoneTag& tag : character.collision.bone_tags) {
    if (!tag.automatic) near[tag.muscle].clear();
  }
  return near;
}

void choose_bones(const CharacterAsset& character, const std::vector<Nearness>& near, FoundConstraints& found) {
  const muscle::MirrorMap& mirror = character.mirror;
  std::vector<bool> done(near.size(), false);
  for (std::uint32_t m = 0; m < near.size(); ++m) {
    if (near[m].empty() || done[m]) continue;
    FoundStayOut entry;
    entry.tag.muscle = m;
    entry.tag.automatic = true;
    for (const auto& [bone, distance] : near[m]) {
      entry.tag.bones.push_back(bone);
      entry.distances.push_back(distance);
    }
    const std::int32_t image = mirror.axis < 0 ? -1 : mirror.muscles[m];
    if (mirror.axis >= 0) {
      std::set<std::int32_t> bones, images;
      for (const std::int32_t bone : entry.tag.bones) images.insert(mirror.bones[static_cast<std::size_t>(bone)]);
      if (image >= 0) {
        for (const auto& [bone, distance] : near[static_cast<std::size_t>(image)]) bones.insert(bone);
      }
      if (image >= 0 && bones == images) {
        done[static_cast<std::size_t>(image)] = true;
      } else {
        entry.mirror = false;
      }
    }
    found.stay_out.push_back(std::move(entry));
  }
}

}  // namespace

FoundConstraints find_constraints(const CharacterAsset& character, std::span<const std::vector<glm::mat4>> poses,
                                  const ConstrainOptions& options) {
  FoundConstraints found;
  if (!character.muscles) return found;
  const MuscleAsset& asset = *character.muscles;
  PosedMuscles muscles(character.muscles);
  std::vector<TriangleMesh> rest;
  for (std::uint32_t m = 0; m < asset.size(); ++m) rest.push_back(muscle::rest_surface(asset, m));
  const auto bones = bone_solids(character);
  const PairList pairs = list_pairs(character);
  std::vector<PairRecord> records(pairs.entries.size());
  std::vector<Nearness> near(asset.size());
  for (const std::vector<glm::mat4>& matrices : poses) {
    const Pose pose = take_pose(muscles, rest, matrices);
    parallel::for_range(records.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        look_at_pair(muscles, pose, pairs.entries[i].pair, options.near, records[i]);
      }
    });
    parallel::for_range(asset.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t m = begin; m < end; ++m) {
        for (std::size_t b = 0; b < bones.size(); ++b) {
          if (!bones[b]) continue;
          const glm::mat4 to_bone = glm::inverse(matrices[b]);
          for (const CloseSection& section : close_sections(muscles, static_cast<std::uint32_t>(m), pose.vertices[m],
                                                            *bones[b], to_bone, options.near)) {
            const auto [known, fresh] = near[m].emplace(static_cast<std::int32_t>(b), section.distance);
            if (!fresh) known->second = std::min(known->second, section.distance);
          }
        }
      }
    });
  }
  Chooser chooser(character, options, found);
  for (std::size_t i = 0; i < pairs.entries.size(); ++i) {
    const PairList::Entry& entry = pairs.entries[i];
    if (entry.is_image) continue;
    const bool mirrored = entry.image >= 0;
    chooser.choose(entry.pair, records[i], mirrored ? pairs.entries[i + 1].pair : Pair{},
                   mirrored ? &records[i + 1] : nullptr);
  }
  choose_bones(character, drop_ignored(character, std::move(near)), found);
  return found;
}

}  // namespace fascicle::cook
