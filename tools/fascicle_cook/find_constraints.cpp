#include "tools/fascicle_cook/find_constraints.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "tools/fascicle_cook/beside_bones.hpp"
#include "tools/fascicle_cook/close_sections.hpp"

namespace fascicle::cook {
namespace {

using muscle::CharacterAsset;
using muscle::MuscleAsset;

using Pair = std::pair<std::uint32_t, std::uint32_t>;

// What has been found of one pair so far.
struct PairRecord {
  FacingList facing;
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

// Whether a muscle and its image have the same sections, so that their tags can be compared.
bool alike(const MuscleAsset& asset, std::uint32_t m, std::int32_t image) {
  return image >= 0 && asset.muscles[m].section_count == asset.muscles[static_cast<std::size_t>(image)].section_count;
}

PairList list_pairs(const CharacterAsset& character) {
  const auto count = static_cast<std::uint32_t>(character.descriptions.size());
  const MuscleAsset& asset = *character.muscles;
  std::set<Pair> ignored, listed;
  for (const muscle::IgnoredPair& pair : character.collision.ignored) {
    if (pair.bone < 0) ignored.insert(in_order({pair.muscle, pair.other}));
  }
  const auto image_of = [&](std::uint32_t m) { return character.mirror.axis < 0 ? -1 : character.mirror.muscles[m]; };
  PairList list;
  for (std::uint32_t x = 0; x < count; ++x) {
    for (std::uint32_t y = x + 1; y < count; ++y) {
      if (!listed.insert({x, y}).second) continue;
      const bool wanted = !ignored.contains({x, y});
      if (wanted) list.entries.push_back({.pair = {x, y}});
      if (!alike(asset, x, image_of(x)) || !alike(asset, y, image_of(y))) continue;
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
    const auto [known, fresh] = record.facing.sections.emplace(section.section, facing);
    if (!fresh && facing.distance < known->second.distance) known->second = facing;
  }
}

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

// Tags with bones: of sections beside bones that `near` still has. Counts them before thinning.
void choose_bone_tags(const CharacterAsset& character, const std::vector<std::vector<BesideBone>>& beside,
                      const std::vector<Nearness>& near, float every, FoundConstraints& found) {
  std::map<std::pair<std::uint32_t, std::int32_t>, FacingList> lists;  // by muscle and bone
  for (std::uint32_t m = 0; m < beside.size(); ++m) {
    for (const BesideBone& section : beside[m]) {
      if (!section.stays || !near[m].contains(section.bone)) continue;
      FacingList& list = lists[{m, section.bone}];
      list.muscle = m;
      list.bone = section.bone;
      list.sections.emplace(section.section, Facing{.section = section.section, .vertex = section.vertex,
                                                    .distance = section.distance});
      ++found.beside_bones;
    }
  }
  const muscle::MirrorMap& mirror = character.mirror;
  std::set<std::pair<std::uint32_t, std::int32_t>> done;
  for (const auto& [key, list] : lists) {
    if (!done.insert(key).second) continue;
    const FacingList* image = nullptr;
    if (mirror.axis >= 0 && alike(*character.muscles, list.muscle, mirror.muscles[list.muscle])) {
      const auto at = lists.find({static_cast<std::uint32_t>(mirror.muscles[list.muscle]),
                                  mirror.bones[static_cast<std::size_t>(list.bone)]});
      if (at != lists.end() && done.insert(at->first).second) image = &at->second;
    }
    choose_tags(character, list, image, every, found.transversals);
  }
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
  for (std::size_t i = 0; i < records.size(); ++i) {
    records[i].facing.muscle = pairs.entries[i].pair.first;
    records[i].facing.other = pairs.entries[i].pair.second;
  }
  std::vector<Nearness> near(asset.size());
  std::vector<std::vector<BesideBone>> beside(asset.size());
  parallel::for_range(asset.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m) {
      beside[m] = find_beside_bones(asset, static_cast<std::uint32_t>(m), rest[m].positions, bones,
                                    character.skeleton->rest_world, options.near);
    }
  });
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
        follow_beside_bones(muscles, static_cast<std::uint32_t>(m), pose.vertices[m], bones, matrices, beside[m]);
      }
    });
  }
  for (std::size_t i = 0; i < pairs.entries.size(); ++i) {
    const PairList::Entry& entry = pairs.entries[i];
    found.close_pairs += records[i].close.empty() ? 0 : 1;
    found.close_sections += records[i].facing.sections.size();
    found.buried += records[i].close.size() - records[i].facing.sections.size();
    if (entry.is_image) continue;
    choose_tags(character, records[i].facing, entry.image >= 0 ? &records[i + 1].facing : nullptr, options.every,
                found.transversals);
  }
  near = drop_ignored(character, std::move(near));
  choose_bone_tags(character, beside, near, options.every, found);
  choose_bones(character, near, found);
  return found;
}

}  // namespace fascicle::cook
