#include "modules/muscle/content/resolve_collision.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "engine/content/closest_name.hpp"
#include "modules/muscle/content/mirror.hpp"
#include "modules/muscle/content/tag_place.hpp"

namespace fascicle::muscle {

namespace {

constexpr float kSamePlace = 1.0e-3f;  // of the length, and rad: closer places are one

std::string place_of(const Diagnostic& where) { return fmt::format("{}:{}", where.file, where.line); }

// A muscle with another or with a bone; the one that is not meant is -1.
struct Pair {
  std::int32_t muscle = -1, other = -1, bone = -1;
  bool complete() const { return muscle >= 0 && (other >= 0 || bone >= 0); }
  auto operator<=>(const Pair&) const = default;
};

Pair in_order(Pair pair) {
  if (pair.bone < 0 && pair.other < pair.muscle) std::swap(pair.muscle, pair.other);
  return pair;
}

class Resolver {
 public:
  Resolver(const CollisionScope& scope, Diagnostics& diagnostics) : scope_(scope), diagnostics_(diagnostics) {
    for (std::size_t i = 0; i < scope.muscles.size(); ++i) {
      muscle_names_.push_back(scope.muscles[i].name);
      muscles_.emplace(scope.muscles[i].name, static_cast<std::int32_t>(i));
    }
    std::sort(muscle_names_.begin(), muscle_names_.end());
    bones_with_mesh_.assign(scope.skeleton.size(), false);
    for (std::size_t i = 0; i < scope.skeleton.size(); ++i) {
      bones_.emplace(scope.skeleton.names[i], static_cast<std::int32_t>(i));
    }
    for (const BoneMeshEntry& entry : scope.bone_meshes) {
      const auto bone = bones_.find(entry.bone.text);
      if (bone == bones_.end()) meshes_known_ = false;
      if (bone == bones_.end() || bones_with_mesh_[static_cast<std::size_t>(bone->second)]) continue;
      bones_with_mesh_[static_cast<std::size_t>(bone->second)] = true;
      solid_names_.push_back(entry.bone.text);
    }
  }

  // -1 where none is named, where the name is unknown, which is told, or where its muscle has errors of its own.
  std::int32_t muscle(const NameEntry& name) {
    if (!name.given()) return -1;
    if (const auto known = muscles_.find(name.text); known != muscles_.end()) return known->second;
    if (!scope_.names.contains(name.text)) {
      name.node.error(diagnostics_, fmt::format("the character has no muscle '{}'", name.text),
                      suggest_name(name.text, muscle_names_, "muscles"));
    }
    return -1;
  }

  // The same of a bone; one without a mesh is an error, unless a mesh of a bone that there is not may be meant for it,
  // which is told where that mesh is named.
  std::int32_t bone(const NameEntry& name) {
    if (!name.given()) return -1;
    const auto known = bones_.find(name.text);
    if (known == bones_.end()) {
      name.node.error(diagnostics_, fmt::format("the skeleton has no bone '{}'", name.text),
                      suggest_name(name.text, scope_.skeleton.names, "bones"));
      return -1;
    }
    if (!bones_with_mesh_[static_cast<std::size_t>(known->second)]) {
      if (!meshes_known_) return -1;
      std::string others;
      if (!solid_names_.empty()) {
        others = ", or name another; " + suggest_name(name.text, solid_names_, "bones with a mesh");
      }
      name.node.error(diagnostics_, fmt::format("the bone '{}' has no mesh, so nothing can touch it", name.text),
                      fmt::format("give it one in \"bone_meshes\" of the character file{}", others));
      return -1;
    }
    return known->second;
  }

  // The muscle on the other side, itself where it lies on both; -1 where the other side has none.
  std::int32_t image_of_muscle(std::int32_t muscle) const {
    if (muscle < 0) return -1;
    const auto name = mirror_name(name_of(muscle), scope_.mirror.names);
    if (!name) return muscle;
    const auto known = muscles_.find(*name);
    return known == muscles_.end() ? -1 : known->second;
  }

  std::int32_t image_of_bone(std::int32_t bone) const {
    if (bone < 0) return -1;
    const auto name = mirror_name(name_of_bone(bone), scope_.mirror.bones);
    if (!name) return bone;
    const auto known = bones_.find(*name);
    if (known == bones_.end() || !bones_with_mesh_[static_cast<std::size_t>(known->second)]) return -1;
    return known->second;
  }

  // Whether to mirror at all; an error where it was asked for and there is no rule.
  bool mirrors(const MirrorEntry& entry) {
    if (entry.wanted == false) return false;
    if (scope_.mirror.given()) return true;
    if (entry.wanted) {
      entry.node.error(diagnostics_, "the character has no mirror rule",
                       "add \"mirror\" to the character file, or leave it out here and write both sides");
    }
    return false;
  }

  Pair image_of(const Pair& pair) const {
    return {image_of_muscle(pair.muscle), image_of_muscle(pair.other), image_of_bone(pair.bone)};
  }

  void miss_image(const MirrorEntry& entry) {
    if (!entry.wanted) return;  // the default is quiet about a character of one side
    entry.node.error(diagnostics_, "the other side lacks one of these muscles or bones",
                     "leave \"mirror\" out, or add what is missing to the character");
  }

  const std::string& name_of(std::int32_t muscle) const {
    return scope_.muscles[static_cast<std::size_t>(muscle)].name;
  }
  const std::string& name_of_bone(std::int32_t bone) const {
    return scope_.skeleton.names[static_cast<std::size_t>(bone)];
  }
  std::string names_of(const Pair& pair) const {
    return fmt::format("'{}' and '{}'", name_of(pair.muscle),
                       pair.bone >= 0 ? name_of_bone(pair.bone) : name_of(pair.other));
  }

 private:
  const CollisionScope& scope_;
  Diagnostics& diagnostics_;
  std::map<std::string, std::int32_t, std::less<>> muscles_, bones_;
  std::vector<std::string> muscle_names_, solid_names_;
  std::vector<bool> bones_with_mesh_;
  bool meshes_known_ = true;  // all of them are of bones that there are
};

using IgnoredPairs = std::map<Pair, Diagnostic>;

IgnoredPairs resolve_ignored(const CollisionFile& file, Resolver& names, CollisionDescription& out,
                             Diagnostics& diagnostics) {
  IgnoredPairs known;
  const auto add = [&](const Pair& pair, const JsonNode& node, bool image) {
    const auto [place, fresh] = known.emplace(in_order(pair), node.where());
    if (fresh) {
      out.ignored.push_back({static_cast<std::uint32_t>(pair.muscle), pair.bone,
                             static_cast<std::uint32_t>(std::max(pair.other, 0)), node.where()});
    } else if (!image) {
      node.warning(diagnostics, fmt::format("the pair {} is ignored already, at {}", names.names_of(place->first),
                                            place_of(place->second)),
                   "leave one of the two out");
    }
  };
  for (const IgnoredEntry& entry : file.ignored) {
    const Pair pair{names.muscle(entry.muscle), names.muscle(entry.other), names.bone(entry.bone)};
    const bool mirrored = names.mirrors(entry.mirror);
    if (!entry.sound || !pair.complete()) continue;
    if (pair.other == pair.muscle) {
      entry.node.error(diagnostics, fmt::format("'{}' is paired with itself", entry.muscle.text),
                       "a muscle never collides with itself: leave it out, or name two muscles");
      continue;
    }
    add(pair, entry.node, false);
    if (!mirrored) continue;
    if (const Pair image = names.image_of(pair); image.complete()) {
      add(image, entry.node, true);
    } else {
      names.miss_image(entry.mirror);
    }
  }
  return known;
}

// False where the pair is ignored, which is an error, but for an automatic entry: that is as good as gone.
bool allowed(const Pair& pair, bool automatic, const JsonNode& node, const IgnoredPairs& ignored, const Resolver& names,
             Diagnostics& diagnostics) {
  const auto found = ignored.find(in_order(pair));
  if (found == ignored.end()) return true;
  const std::string cause = fmt::format("the pair {} is ignored, at {}", names.names_of(pair), place_of(found->second));
  if (automatic) {
    node.warning(diagnostics, cause + ", so this automatic entry counts for nothing",
                 "run `fascicle-cook constrain` again");
  } else {
    node.error(diagnostics, cause, "leave out this entry, or no longer ignore the pair");
  }
  return false;
}

// A pair of places, near ones alike, in either order.
using PlaceKey = std::tuple<std::uint32_t, long, long>;
using PlacesKey = std::tuple<PlaceKey, PlaceKey, std::int32_t>;

PlaceKey key_of(const SectionTag& tag) {
  const long turn = std::lround(2.0f * std::numbers::pi_v<float> / kSamePlace);
  return {tag.muscle, std::lround(tag.fraction / kSamePlace), std::lround(tag.angle / kSamePlace) % turn};
}

PlacesKey key_of(const TransversalTag& tag) {
  PlaceKey a = key_of(tag.first), b = tag.bone >= 0 ? PlaceKey{} : key_of(tag.second);
  if (tag.bone < 0 && b < a) std::swap(a, b);
  return {a, b, tag.bone};
}

// Which muscle yields, or -1 for both.
std::int64_t yielding(const TransversalTag& tag) {
  if (tag.yields == Yields::kBoth) return -1;
  return tag.yields == Yields::kFirst ? tag.first.muscle : tag.second.muscle;
}

class TransversalList {
 public:
  TransversalList(ResolvedCollision& out, Diagnostics& diagnostics) : out_(out), diagnostics_(diagnostics) {}

  // `original`: of a mirror image, else null.
  void add(const TransversalTag& tag, const JsonNode& node, const TransversalTag* original) {
    const auto [place, fresh] = known_.emplace(key_of(tag), Known{yielding(tag), node.where(), node});
    if (!fresh) return tell(place->second, tag, node, original != nullptr);
    if (original != nullptr) {
      out_.images.push_back({out_.description.transversals.size(), original->first, original->second});
    }
    out_.description.transversals.push_back(tag);
  }

 private:
  struct Known {
    std::int64_t yielding = -1;
    Diagnostic where;
    JsonNode node;
  };

  void tell(const Known& known, const TransversalTag& tag, const JsonNode& node, bool image) {
    if (known.node == node) return;  // the entry is its own mirror image
    const std::string which = image ? "the mirror image of these places is" : "these places are";
    if (known.yielding != yielding(tag)) {
      node.error(diagnostics_, fmt::format("{} tagged already, at {}, and there another muscle yields", which,
                                           place_of(known.where)),
                 "give both the same \"yields\", or leave one out");
    } else {
      node.warning(diagnostics_, fmt::format("{} tagged already, at {}", which, place_of(known.where)),
                   image ? "leave one out, or give it \"mirror\": false" : "leave one of the two out");
    }
  }

  ResolvedCollision& out_;
  Diagnostics& diagnostics_;
  std::map<PlacesKey, Known> known_;
};

// On a reflected line angles run the other way round; place_images knows better where its frames start elsewhere.
SectionTag make_place(const PlaceEntry& place, std::int32_t muscle, bool image) {
  if (muscle < 0) return {};
  const bool turned = image && place.angle > 0.0f;
  return {static_cast<std::uint32_t>(muscle), place.at,
          turned ? 2.0f * std::numbers::pi_v<float> - place.angle : place.angle};
}

TransversalTag make_tag(const TransversalEntry& entry, const Pair& pair, bool image) {
  TransversalTag tag;
  tag.first = make_place(entry.first, pair.muscle, image);
  tag.bone = pair.bone;
  tag.second = make_place(entry.second, pair.other, image);
  tag.yields = entry.yields;
  tag.sweeps = entry.sweeps;
  tag.automatic = entry.automatic;
  tag.where = entry.node.where();
  return tag;
}

void resolve_transversals(const CollisionFile& file, const IgnoredPairs& ignored, Resolver& names,
                          ResolvedCollision& out, Diagnostics& diagnostics) {
  TransversalList list(out, diagnostics);
  for (const TransversalEntry& entry : file.transversals) {
    const Pair pair{names.muscle(entry.first.muscle), names.muscle(entry.second.muscle), names.bone(entry.second.bone)};
    const bool mirrored = names.mirrors(entry.mirror);
    if (!entry.sound || !pair.complete()) continue;
    if (pair.other == pair.muscle) {
      entry.node.error(diagnostics, fmt::format("both ends are on '{}'", entry.first.muscle.text),
                       "a constraint joins two muscles, or a muscle and a bone");
      continue;
    }
    if (!allowed(pair, entry.automatic, entry.node, ignored, names, diagnostics)) continue;
    const TransversalTag tag = make_tag(entry, pair, false);
    list.add(tag, entry.node, nullptr);
    if (!mirrored) continue;
    const Pair image = names.image_of(pair);
    if (!image.complete()) {
      names.miss_image(entry.mirror);
    } else if (!ignored.contains(in_order(image))) {
      list.add(make_tag(entry, image, true), entry.node, &tag);
    }
  }
}

void resolve_stay_out(const CollisionFile& file, const IgnoredPairs& ignored, Resolver& names,
                      CollisionDescription& out, Diagnostics& diagnostics) {
  for (const StayOutEntry& entry : file.stay_out) {
    const std::int32_t muscle = names.muscle(entry.muscle);
    std::vector<std::int32_t> bones;
    bool sound = entry.sound && muscle >= 0;
    for (const NameEntry& name : entry.bones) {
      const std::int32_t bone = names.bone(name);
      if (bone < 0) {
        sound = false;
      } else if (std::find(bones.begin(), bones.end(), bone) != bones.end()) {
        name.node.warning(diagnostics, fmt::format("the bone '{}' is named twice", name.text), "leave one out");
      } else if (muscle < 0 || allowed({muscle, -1, bone}, entry.automatic, name.node, ignored, names, diagnostics)) {
        bones.push_back(bone);
      }
    }
    const bool mirrored = names.mirrors(entry.mirror);
    if (!sound || bones.empty()) continue;
    out.bone_tags.push_back({static_cast<std::uint32_t>(muscle), entry.from, entry.to, bones, entry.automatic,
                             entry.node.where()});
    if (!mirrored) continue;
    const std::int32_t muscle_image = names.image_of_muscle(muscle);
    std::vector<std::int32_t> images;
    for (const std::int32_t bone : bones) images.push_back(names.image_of_bone(bone));
    if (muscle_image < 0 || std::find(images.begin(), images.end(), -1) != images.end()) {
      names.miss_image(entry.mirror);
      continue;
    }
    std::erase_if(images, [&](std::int32_t bone) { return ignored.contains({muscle_image, -1, bone}); });
    const bool own_image = muscle_image == muscle && images == bones;
    if (images.empty() || own_image) continue;
    out.bone_tags.push_back({static_cast<std::uint32_t>(muscle_image), entry.from, entry.to, std::move(images),
                             entry.automatic, entry.node.where()});
  }
}

}  // namespace

ResolvedCollision resolve_collision(const CollisionFile& file, const CollisionScope& scope, Diagnostics& diagnostics) {
  ResolvedCollision out;
  out.description.settings = file.settings;
  Resolver names(scope, diagnostics);
  const IgnoredPairs ignored = resolve_ignored(file, names, out.description, diagnostics);
  resolve_transversals(file, ignored, names, out, diagnostics);
  resolve_stay_out(file, ignored, names, out.description, diagnostics);
  return out;
}

void place_images(const MuscleAsset& asset, int mirror_axis, ResolvedCollision& collision) {
  for (const MirrorImage& image : collision.images) {
    TransversalTag& tag = collision.description.transversals[image.transversal];
    tag.first = mirror_tag(asset, image.first, tag.first.muscle, mirror_axis);
    if (tag.bone < 0) tag.second = mirror_tag(asset, image.second, tag.second.muscle, mirror_axis);
  }
}

}  // namespace fascicle::muscle
