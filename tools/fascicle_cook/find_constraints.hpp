// Where a character's muscles come close to each other and to bones, at rest and over its animation, and the tags that
// follow from it: what `fascicle-cook constrain` writes.
//
// The rules:
// - Close is nearer than `near`, or within each other. The ends' sections are left out: they are attached to bone.
// - Of a section of one muscle the facing vertex is the one nearest to the other's surface, or deepest within it. Its
//   partner is the section of the other muscle whose facing vertex is nearest, and no further than `near` and the way
//   to the next section. Both must point towards each other, and no more than half of either section may lie within
//   the other muscle: beyond that nothing faces anything.
// - Over the poses the closest one that keeps these rules counts.
// - Along the first muscle of a pair tags keep `every` from each other, the closest first.
// - A pair and its mirror image are thinned together; a tag that both sides have (the same section, partners within one
//   section and one vertex) is written once and mirrored, others are for one side.
// - Sections that lie beside a bone over the animation get tags with it (beside_bones.hpp), thinned likewise.
// - Each muscle gets the list of the bones that any of its sections comes close to.
// - Pairs that the author ignores get nothing, nor do places along a pair where the author has tags, nor a muscle for
//   which the author says what to stay out of, as far as bones go.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "modules/muscle/content/character_asset.hpp"
#include "tools/fascicle_cook/choose_tags.hpp"

namespace fascicle::cook {

struct ConstrainOptions {
  float near = 0.005f;   // m
  float every = 0.04f;   // m
};

struct FoundStayOut {
  muscle::BoneTag tag;
  std::vector<float> distances;  // m, by bone of the tag
  std::optional<bool> mirror;
};

struct FoundConstraints {
  std::vector<FoundTransversal> transversals;
  std::vector<FoundStayOut> stay_out;
  std::size_t close_pairs = 0;     // of muscles
  std::size_t close_sections = 0;  // pairs of sections that keep the rules, before thinning
  std::size_t buried = 0;          // pairs of sections that are close in no pose that keeps the rules
  std::size_t beside_bones = 0;    // sections and bones that keep the rules, before thinning
};

// The same for any number of workers.
FoundConstraints find_constraints(const muscle::CharacterAsset& character,
                                  std::span<const std::vector<glm::mat4>> poses, const ConstrainOptions& options);

}  // namespace fascicle::cook
