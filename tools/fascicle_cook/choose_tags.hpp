// Which of the places where a muscle faces another or a bone become tags: the closest, thinned along the muscle, and
// a side's beside its mirror image's.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::cook {

// A section that faces something, in the pose in which the two are closest.
struct Facing {
  std::uint32_t section = 0, vertex = 0;              // of the muscle
  std::uint32_t other_section = 0, other_vertex = 0;  // of the other muscle; of a bone there is neither
  float distance = 0.0f;                              // m, negative within each other
};

// All that was found of a muscle facing one other, or one bone.
struct FacingList {
  std::uint32_t muscle = 0, other = 0;
  std::int32_t bone = -1;                    // >= 0: then there is no other muscle
  std::map<std::uint32_t, Facing> sections;  // by section of `muscle`
};

struct FoundTransversal {
  muscle::TransversalTag tag;
  float distance = 0.0f;       // m, the smallest over the poses, negative within each other
  std::optional<bool> mirror;  // as it is to be written
};

// m: where a section lies along its muscle at rest.
float arc_at(const muscle::MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section);

// Adds the tags of `list` to `found`, at least `every` (m) from each other and from the author's own along the muscle.
// `image`: what was found of the mirror image, whose muscles have the same sections; or null.
void choose_tags(const muscle::CharacterAsset& character, const FacingList& list, const FacingList* image, float every,
                 std::vector<FoundTransversal>& found);

}  // namespace fascicle::cook
