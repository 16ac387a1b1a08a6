#include "modules/muscle/measure/penetration.hpp"

#include <algorithm>
#include <tuple>

namespace fascicle::muscle {
namespace {

// The order of a Penetration's lists.
auto key_of(const PairDepth& pair) {
  return pair.bone >= 0 ? std::tuple(pair.muscle, static_cast<std::uint32_t>(pair.bone))
                        : std::tuple(std::min(pair.muscle, pair.other), std::max(pair.muscle, pair.other));
}

float most_beyond(const std::vector<PairDepth>& now, const Penetration& rest) {
  float most = 0.0f;
  for (const PairDepth& pair : now) most = std::max(most, pair.depth - depth_of(pair, rest));
  return most;
}

}  // namespace

PairDepth deepest(const std::vector<PairDepth>& pairs) {
  PairDepth found;
  for (const PairDepth& pair : pairs) {
    if (pair.depth > found.depth) found = pair;
  }
  return found;
}

float depth_of(const PairDepth& pair, const Penetration& there) {
  const std::vector<PairDepth>& pairs = pair.bone >= 0 ? there.bones : there.muscles;
  const auto found = std::lower_bound(pairs.begin(), pairs.end(), pair, [](const PairDepth& a, const PairDepth& b) {
    return key_of(a) < key_of(b);
  });
  return found != pairs.end() && key_of(*found) == key_of(pair) ? found->depth : 0.0f;
}

DepthsBeyond beyond(const Penetration& now, const Penetration& rest) {
  return {.bone = std::max(deepest(now.bones).depth - deepest(rest.bones).depth, 0.0f),
          .muscle = std::max(deepest(now.muscles).depth - deepest(rest.muscles).depth, 0.0f),
          .bone_pair = most_beyond(now.bones, rest),
          .muscle_pair = most_beyond(now.muscles, rest)};
}

}  // namespace fascicle::muscle
