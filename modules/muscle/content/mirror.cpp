#include "modules/muscle/content/mirror.hpp"

namespace fascicle::muscle {

namespace {

// Where `part` stands in `name` by the order of mirror_name, or npos. Larger rank is better.
struct Match {
  std::size_t at = std::string_view::npos;
  int rank = 0;
};

Match find_part(std::string_view name, std::string_view part) {
  if (name.ends_with(part)) return {name.size() - part.size(), 3};
  if (name.starts_with(part)) return {0, 2};
  const std::size_t at = name.rfind(part);
  return at == std::string_view::npos ? Match{} : Match{at, 1};
}

}  // namespace

std::optional<std::string> mirror_name(std::string_view name, std::span<const MirrorRule::Pair> pairs) {
  for (const auto& [left, right] : pairs) {
    const Match a = find_part(name, left);
    const Match b = find_part(name, right);
    if (a.rank == 0 && b.rank == 0) continue;
    // Equal ranks inside the name: the one that stands later, as for a single part.
    const bool forward = a.rank != b.rank ? a.rank > b.rank : a.at >= b.at;
    std::string mirrored(name);
    if (forward) {
      mirrored.replace(a.at, left.size(), right);
    } else {
      mirrored.replace(b.at, right.size(), left);
    }
    return mirrored;
  }
  return std::nullopt;
}

glm::vec3 mirror_point(glm::vec3 point, int axis) {
  point[axis] = -point[axis];
  return point;
}

}  // namespace fascicle::muscle
