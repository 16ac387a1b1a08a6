#include "engine/geometry/drop_triangles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <glm/geometric.hpp>

#include "engine/geometry/mesh_edges.hpp"

namespace fascicle {
namespace {

constexpr int kMaxRounds = 8;

class Dropper {
 public:
  Dropper(std::span<const glm::vec3> positions, double tolerance, std::vector<std::uint32_t>& indices,
          std::vector<std::uint32_t>& sources)
      : positions_(positions), tolerance_(tolerance), indices_(indices), sources_(sources) {}

  DroppedTriangles drop() {
    drop_collapsed();
    drop_duplicates();
    for (int round = 0; round < kMaxRounds; ++round) {
      const std::vector<std::uint32_t> flat = find_flat();
      if (flat.empty()) return dropped_;
      if (round == 0) dropped_.degenerate += flat.size();
      split_neighbours(flat);
      drop_duplicates();
    }
    gone_.assign(sources_.size(), 0);
    for (const std::uint32_t t : find_flat()) gone_[t] = 1;
    compact();
    return dropped_;
  }

 private:
  std::array<std::uint32_t, 3> corners(std::uint32_t t) const {
    return {indices_[3 * t], indices_[3 * t + 1], indices_[3 * t + 2]};
  }

  void drop_collapsed() {
    gone_.assign(sources_.size(), 0);
    for (std::uint32_t t = 0; t < sources_.size(); ++t) {
      const auto [a, b, c] = corners(t);
      gone_[t] = a == b || b == c || c == a;
      dropped_.degenerate += gone_[t];
    }
    compact();
  }

  void drop_duplicates() {
    struct Entry {
      std::uint32_t middle, high, triangle;
    };
    // A counting sort by the lowest corner, then small sorts by the others.
    std::vector<std::uint32_t> ends(positions_.size() + 1, 0);
    for (std::uint32_t t = 0; t < sources_.size(); ++t) ++ends[std::ranges::min(corners(t)) + 1];
    for (std::size_t v = 0; v < positions_.size(); ++v) ends[v + 1] += ends[v];
    std::vector<Entry> entries(sources_.size());
    for (std::uint32_t t = 0; t < sources_.size(); ++t) {
      std::array<std::uint32_t, 3> sorted = corners(t);
      std::ranges::sort(sorted);
      entries[ends[sorted[0]]++] = {sorted[1], sorted[2], t};
    }
    gone_.assign(sources_.size(), 0);
    for (std::size_t v = 0, begin = 0; v < positions_.size(); begin = ends[v], ++v) {
      const std::span<Entry> group = std::span(entries).subspan(begin, ends[v] - begin);
      std::ranges::sort(group, {}, [](const Entry& e) { return std::tie(e.middle, e.high, e.triangle); });
      for (std::size_t i = 1; i < group.size(); ++i) {
        if (group[i].middle != group[i - 1].middle || group[i].high != group[i - 1].high) continue;
        gone_[group[i].triangle] = 1;
        ++dropped_.duplicate;
      }
    }
    compact();
  }

  glm::dvec3 point(std::uint32_t vertex) const { return glm::dvec3(positions_[vertex]); }
  double length(std::uint32_t side) const {
    return glm::distance(point(indices_[side]), point(indices_[next_side(side)]));
  }
  std::uint32_t longest_side(std::uint32_t t) const {
    std::uint32_t longest = 3 * t;
    for (const std::uint32_t side : {3 * t + 1, 3 * t + 2}) {
      if (length(side) > length(longest)) longest = side;
    }
    return longest;
  }

  std::vector<std::uint32_t> find_flat() const {
    std::vector<std::uint32_t> flat;
    for (std::uint32_t t = 0; t < sources_.size(); ++t) {
      const auto [a, b, c] = corners(t);
      const double area = glm::length(glm::cross(point(b) - point(a), point(c) - point(a)));  // twice
      const double longest = std::max({length(3 * t), length(3 * t + 1), length(3 * t + 2)});
      if (!(area > tolerance_ * longest)) flat.push_back(t);
    }
    return flat;
  }

  // Each flat triangle and its neighbour across its longest edge become the two halves of the neighbour. Neighbours
  // that changed already wait for the next round.
  void split_neighbours(std::span<const std::uint32_t> flat) {
    const MeshEdges edges = find_edges(indices_, positions_.size());
    std::vector<std::uint8_t> changed(sources_.size(), 0);
    gone_.assign(sources_.size(), 0);
    for (const std::uint32_t t : flat) {
      const std::uint32_t side = longest_side(t), other = edges.opposite[side];
      if (changed[t] != 0) continue;
      if (other == kNoSide) {
        gone_[t] = 1;
        changed[t] = 1;
        continue;
      }
      const std::uint32_t neighbour = other / 3;
      if (changed[neighbour] != 0) continue;
      changed[t] = changed[neighbour] = 1;
      const std::uint32_t start = indices_[other], end = indices_[next_side(other)];
      const std::uint32_t tip = indices_[next_side(next_side(other))];
      const std::uint32_t third = indices_[next_side(next_side(side))];
      const std::array<std::uint32_t, 3> halves[2] = {{start, third, tip}, {third, end, tip}};
      std::ranges::copy(halves[0], indices_.begin() + 3 * neighbour);
      std::ranges::copy(halves[1], indices_.begin() + 3 * t);
      sources_[t] = sources_[neighbour];
    }
    compact();
  }

  // Removes the triangles marked in gone_.
  void compact() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < sources_.size(); ++t) {
      if (gone_[t] != 0) continue;
      for (std::size_t k = 0; k < 3; ++k) indices_[3 * kept + k] = indices_[3 * t + k];
      sources_[kept++] = sources_[t];
    }
    indices_.resize(3 * kept);
    sources_.resize(kept);
  }

  std::span<const glm::vec3> positions_;
  double tolerance_;
  std::vector<std::uint32_t>& indices_;
  std::vector<std::uint32_t>& sources_;
  std::vector<std::uint8_t> gone_;
  DroppedTriangles dropped_;
};

}  // namespace

DroppedTriangles drop_triangles(std::span<const glm::vec3> positions, double tolerance,
                                std::vector<std::uint32_t>& indices, std::vector<std::uint32_t>& sources) {
  return Dropper(positions, tolerance, indices, sources).drop();
}

}  // namespace fascicle
