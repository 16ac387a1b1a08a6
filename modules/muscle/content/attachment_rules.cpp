#include "modules/muscle/content/attachment_rules.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include "modules/muscle/content/mirror.hpp"

namespace fascicle::muscle {

namespace {

constexpr float kSamePlace = 1e-5f;  // m
constexpr int kMaxDepth = 100000;    // no hierarchy is deeper; guards against a broken one

std::vector<std::int32_t> chain_to_root(const Skeleton& skeleton, std::int32_t bone) {
  std::vector<std::int32_t> chain;
  for (int depth = 0; bone >= 0 && depth < kMaxDepth; ++depth) {
    chain.push_back(bone);
    bone = skeleton.parents[static_cast<std::size_t>(bone)];
  }
  return chain;
}

bool contains(std::span<const std::int32_t> bones, std::int32_t bone) {
  return std::find(bones.begin(), bones.end(), bone) != bones.end();
}

bool is_leaf(const Skeleton& skeleton, std::int32_t bone) { return !contains(skeleton.parents, bone); }

const std::string& bone_name(const Skeleton& skeleton, std::int32_t bone) {
  return skeleton.names[static_cast<std::size_t>(bone)];
}

// Next to the path: parent of its topmost bone, or a leaf child of one of its bones.
bool is_near(const Skeleton& skeleton, std::span<const std::int32_t> path, std::int32_t bone) {
  const std::int32_t parent = skeleton.parents[static_cast<std::size_t>(bone)];
  if (parent >= 0 && contains(path, parent) && is_leaf(skeleton, bone)) return true;
  for (const std::int32_t member : path) {
    const std::int32_t above = skeleton.parents[static_cast<std::size_t>(member)];
    if (above == bone && !contains(path, above)) return true;
  }
  return false;
}

bool on_other_side(const Skeleton& skeleton, std::span<const std::int32_t> path, std::int32_t bone,
                   const MirrorRule& mirror) {
  const std::optional<std::string> image = mirror_name(bone_name(skeleton, bone), mirror.bones);
  if (!image) return false;
  const std::int32_t other = skeleton.find(*image);
  return other >= 0 && contains(path, other);
}

bool check_via_bones(std::span<const PlacedAttachment> line, const Skeleton& skeleton, const MirrorRule& mirror,
                     Diagnostics& diagnostics) {
  const std::vector<std::int32_t> path = bones_between(skeleton, line.front().bone, line.back().bone);
  bool fine = true;
  for (const PlacedAttachment& via : line.subspan(1, line.size() - 2)) {
    if (contains(path, via.bone)) continue;
    if (is_near(skeleton, path, via.bone) && !on_other_side(skeleton, path, via.bone, mirror)) continue;
    std::vector<std::string> names;
    for (const std::int32_t bone : path) names.push_back(bone_name(skeleton, bone));
    via.bone_node.error(diagnostics,
                        fmt::format("a via point on '{}', which is not between the bones of origin and insertion",
                                    bone_name(skeleton, via.bone)),
                        fmt::format("put it on one of {}", fmt::join(names, ", ")));
    fine = false;
  }
  return fine;
}

bool check_distances(std::span<const PlacedAttachment> line, const MuscleDescription& values,
                     Diagnostics& diagnostics) {
  const HillParameters& hill = values.hill;
  if (hill.optimal_fibre_length <= 0.0f || line.size() < 3) return true;
  float longest = 2.0f * (hill.tendon_slack_length + 2.0f * hill.optimal_fibre_length);
  if (values.source_length > 0.0f) {
    // The straight distance from origin to insertion is the one measure of the character's size that a misplaced via
    // point cannot spoil.
    const float straight = glm::distance(line.front().rest, line.back().rest);
    longest *= std::max(1.0f, straight / values.source_length);
  }
  const auto length_of = [&](std::size_t segment) {
    return glm::distance(line[segment].rest, line[segment + 1].rest);
  };
  const auto too_long = [&](std::size_t segment) { return length_of(segment) > longest; };
  bool fine = true;
  const auto blame = [&](std::size_t point, float distance) {
    fine = false;
    line[point].node.error(
        diagnostics,
        fmt::format("this point is {:.3g} m from its neighbour; the whole muscle can be {:.3g} m long at most",
                    distance, longest),
        "check its bone and the frame and unit (m) of its position, or the muscle's fibre and tendon lengths");
  };
  // A misplaced point makes the segments on both sides too long; a single long segment is blamed on an end of the line
  // where it is the first or the last.
  for (std::size_t segment = 0; segment + 1 < line.size(); ++segment) {
    if (!too_long(segment)) continue;
    const bool next_too = segment + 2 < line.size() && too_long(segment + 1);
    const std::size_t point = segment == 0 && !next_too ? 0 : segment + 1;
    blame(point, length_of(segment));
    if (next_too) ++segment;  // the same point's other side
  }
  return fine;
}

}  // namespace

std::vector<std::int32_t> bones_between(const Skeleton& skeleton, std::int32_t from, std::int32_t to) {
  const std::vector<std::int32_t> up = chain_to_root(skeleton, from);
  const std::vector<std::int32_t> down = chain_to_root(skeleton, to);
  std::vector<std::int32_t> path;
  for (const std::int32_t bone : up) {
    path.push_back(bone);
    const auto meeting = std::find(down.begin(), down.end(), bone);
    if (meeting == down.end()) continue;
    for (auto next = std::make_reverse_iterator(meeting); next != down.rend(); ++next) path.push_back(*next);
    return path;
  }
  return {from, to};
}

bool check_attachments(std::span<const PlacedAttachment> line, const MuscleDescription& values,
                       const Skeleton& skeleton, const MirrorRule& mirror, Diagnostics& diagnostics) {
  if (line.size() < 2) return false;
  bool fine = true;
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (glm::distance(line[i - 1].rest, line[i].rest) > kSamePlace) continue;
    line[i].node.error(diagnostics,
                       fmt::format("this point lies where the one before it does, at ({:.4g}, {:.4g}, {:.4g}) at rest",
                                   line[i].rest.x, line[i].rest.y, line[i].rest.z),
                       "move one of the two, or leave one out");
    fine = false;
  }
  fine = check_via_bones(line, skeleton, mirror, diagnostics) && fine;
  return check_distances(line, values, diagnostics) && fine;
}

}  // namespace fascicle::muscle
