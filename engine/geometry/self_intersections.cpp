#include "engine/geometry/self_intersections.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <vector>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "engine/geometry/triangles_cross.hpp"
#include "engine/parallel/for_range.hpp"

namespace fascicle {
namespace {

constexpr std::size_t kLeaf = 4;       // triangles
constexpr std::size_t kTestCost = 16;  // of two triangles, in looks at a box
// The search ends beyond these: usual meshes take about 250 a triangle, a thousand million about ten seconds.
constexpr std::size_t kMaxCost = 500'000'000, kMaxCostPerTriangle = 500, kMaxQueryCost = 1'000'000;
// Triangles between looks at what was found: few where each meets very many others.
constexpr std::size_t kRound = 16384, kShortRound = 256, kHighCost = 10000;

struct Box {
  glm::vec3 lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};

  void add(const Box& other) {
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
  }
  bool meets(const Box& other) const {
    return glm::all(glm::lessThanEqual(lower, other.upper)) && glm::all(glm::lessThanEqual(other.lower, upper));
  }
};

// The lower 21 bits of `value`, each followed by two zeros.
std::uint64_t spread_bits(std::uint64_t value) {
  value = (value | value << 32) & 0x001f00000000ffffu;
  value = (value | value << 16) & 0x001f0000ff0000ffu;
  value = (value | value << 8) & 0x100f00f00f00f00fu;
  value = (value | value << 4) & 0x10c30c30c30c30c3u;
  return (value | value << 2) & 0x1249249249249249u;
}

struct Found {
  std::size_t pairs = 0, cost = 0;
};

// Triangles along a space-filling curve, and a complete binary tree of boxes over them.
class TriangleTree {
 public:
  TriangleTree(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices) : positions_(positions) {
    sort_triangles(indices);
    leaf_count_ = std::bit_ceil((triangles_.size() + kLeaf - 1) / kLeaf);
    nodes_.resize(2 * leaf_count_);
    for (std::size_t t = 0; t < triangles_.size(); ++t) nodes_[leaf_count_ + t / kLeaf].add(boxes_[t]);
    for (std::size_t n = leaf_count_ - 1; n > 0; --n) {
      nodes_[n].add(nodes_[2 * n]);
      nodes_[n].add(nodes_[2 * n + 1]);
    }
  }

  std::size_t size() const { return triangles_.size(); }

  // Pairs of triangle t with those after it, at most `limit`.
  Found find(std::size_t t, std::size_t limit) const {
    Found found;
    visit(t, 1, 0, leaf_count_, limit, found);
    return found;
  }

 private:
  void sort_triangles(std::span<const std::uint32_t> indices) {
    struct Entry {
      std::uint64_t code;
      std::uint32_t triangle;
    };
    Box all;
    std::vector<Entry> order(indices.size() / 3);
    std::vector<Box> boxes(order.size());
    for (std::size_t t = 0; t < order.size(); ++t) {
      for (const std::uint32_t v : indices.subspan(3 * t, 3)) boxes[t].add({positions_[v], positions_[v]});
      all.add(boxes[t]);
    }
    const glm::dvec3 extent = glm::max(glm::dvec3(all.upper) - glm::dvec3(all.lower), glm::dvec3(1e-300));
    for (std::uint32_t t = 0; t < order.size(); ++t) {
      const glm::dvec3 middle = 0.5 * (glm::dvec3(boxes[t].lower) + glm::dvec3(boxes[t].upper));
      const glm::dvec3 cell = (middle - glm::dvec3(all.lower)) / extent * static_cast<double>((1 << 21) - 1);
      const auto bits = [](double c) { return spread_bits(static_cast<std::uint64_t>(c)); };
      order[t] = {bits(cell.x) | bits(cell.y) << 1 | bits(cell.z) << 2, t};
    }
    std::ranges::sort(order, [](const Entry& a, const Entry& b) {
      return a.code != b.code ? a.code < b.code : a.triangle < b.triangle;
    });
    for (const Entry& entry : order) {
      const std::size_t first = std::size_t{3} * entry.triangle;
      triangles_.push_back({indices[first], indices[first + 1], indices[first + 2]});
      boxes_.push_back(boxes[entry.triangle]);
    }
  }

  // `width` leaves from `first_leaf` on are under the node.
  void visit(std::size_t t, std::size_t node, std::size_t first_leaf, std::size_t width, std::size_t limit,
             Found& found) const {
    if ((first_leaf + width) * kLeaf <= t + 1 || found.pairs >= limit || found.cost >= kMaxQueryCost) return;
    ++found.cost;
    if (!nodes_[node].meets(boxes_[t])) return;
    if (node < leaf_count_) {
      visit(t, 2 * node, first_leaf, width / 2, limit, found);
      visit(t, 2 * node + 1, first_leaf + width / 2, width / 2, limit, found);
      return;
    }
    const std::size_t end = std::min((first_leaf + 1) * kLeaf, triangles_.size());
    for (std::size_t other = std::max(first_leaf * kLeaf, t + 1); other < end && found.pairs < limit; ++other) {
      if (!boxes_[other].meets(boxes_[t])) continue;
      found.cost += kTestCost;
      found.pairs += triangles_cross(positions_, triangles_[t], triangles_[other]);
    }
  }

  std::span<const glm::vec3> positions_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Box> boxes_;  // of triangles
  std::vector<Box> nodes_;  // node n has the children 2n and 2n + 1; leaves are last
  std::size_t leaf_count_ = 0;
};

}  // namespace

SelfIntersections find_self_intersections(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices,
                                          std::size_t max_pairs) {
  SelfIntersections all;
  if (indices.size() < 6) return all;
  const TriangleTree tree(positions, indices);
  std::vector<Found> found(std::min(kRound, tree.size()));
  const std::size_t max_cost = kMaxCost + kMaxCostPerTriangle * tree.size();
  std::size_t cost = 0;
  for (std::size_t first = 0, count = 0; first < tree.size(); first += count) {
    const bool costly = first == 0 || cost / first > kHighCost;
    count = std::min(costly ? kShortRound : kRound, tree.size() - first);
    parallel::for_range(count, 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) found[i] = tree.find(first + i, max_pairs);
    });
    for (std::size_t i = 0; i < count; ++i) {
      all.pairs += found[i].pairs;
      cost += found[i].cost;
      all.more |= found[i].cost >= kMaxQueryCost;
    }
    if (all.pairs < max_pairs && cost < max_cost) continue;
    all.more |= all.pairs >= max_pairs || first + count < tree.size();
    break;
  }
  all.pairs = std::min(all.pairs, max_pairs);
  return all;
}

}  // namespace fascicle
