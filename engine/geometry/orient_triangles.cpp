#include "engine/geometry/orient_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/geometric.hpp>

#include "engine/geometry/mesh_edges.hpp"

namespace fascicle {
namespace {

constexpr std::uint32_t kNoComponent = std::numeric_limits<std::uint32_t>::max();

// Vertices that hang together. Made for all vertices once, used and put back for few of them at a time.
class VertexSets {
 public:
  explicit VertexSets(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }

  std::uint32_t find(std::uint32_t v) {
    while (parents_[v] != v) {
      parents_[v] = parents_[parents_[v]];
      v = parents_[v];
    }
    return v;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }
  void put_back(std::uint32_t v) { parents_[v] = v; }

 private:
  std::vector<std::uint32_t> parents_;
};

// One component, in the sense of its first triangle.
struct Component {
  std::size_t triangles = 0, against = 0;  // against: those that must be turned to have the sense of the first
  double area = 0.0, cap_area = 0.0;
  double volume = 0.0;                     // with the caps
  bool turn = false;                       // the sense of the first is inward
  bool sheet = false;                      // volume says nothing about it
};

class Orienter {
 public:
  Orienter(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices)
      : positions_(positions),
        indices_(indices),
        edges_(find_edges(indices, positions.size())),
        component_of_(indices.size() / 3, kNoComponent),
        sets_(positions.size()) {
    senses_.turned.assign(indices.size() / 3, 0);
  }

  TriangleSenses orient() {
    if (indices_.empty()) return std::move(senses_);
    middle_ = glm::dvec3(positions_[indices_[0]]);  // volumes far from the origin would lose digits
    flood();
    count_edges();
    measure_triangles();
    measure_caps();
    choose_senses();
    for (std::size_t t = 0; t < component_of_.size(); ++t)
      senses_.turned[t] ^= static_cast<std::uint8_t>(components_[component_of_[t]].turn);
    senses_.components = components_.size();
    return std::move(senses_);
  }

 private:
  std::uint32_t from(std::uint32_t side) const { return indices_[side]; }
  std::uint32_t to(std::uint32_t side) const { return indices_[next_side(side)]; }
  glm::dvec3 point(std::uint32_t vertex) const { return glm::dvec3(positions_[vertex]) - middle_; }
  // Whether the side goes from the lower vertex to the higher, once its triangle is turned.
  bool rises(std::uint32_t side) const { return (from(side) < to(side)) != (senses_.turned[side / 3] != 0); }

  void flood() {
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t first = 0; first < component_of_.size(); ++first) {
      if (component_of_[first] != kNoComponent) continue;
      const auto id = static_cast<std::uint32_t>(components_.size());
      Component& component = components_.emplace_back();
      component_of_[first] = id;
      waiting.push_back(first);
      while (!waiting.empty()) {
        const std::uint32_t t = waiting.back();
        waiting.pop_back();
        ++component.triangles;
        component.against += senses_.turned[t];
        for (std::uint32_t side = 3 * t; side < 3 * t + 3; ++side) {
          const std::uint32_t other = edges_.opposite[side];
          if (other == kNoSide || component_of_[other / 3] != kNoComponent) continue;
          component_of_[other / 3] = id;
          senses_.turned[other / 3] = rises(side) == rises(other) ? 1 : 0;
          waiting.push_back(other / 3);
        }
      }
    }
  }

  void count_edges() {
    std::vector<std::uint32_t> rims;
    for (std::size_t e = 0; e < edges_.count(); ++e) {
      const std::span<const std::uint32_t> sides = edges_.sides_of(e);
      senses_.open_edges += sides.size() == 1;
      senses_.crowded_edges += sides.size() > 2;
      senses_.twisted_edges += sides.size() == 2 && rises(sides[0]) == rises(sides[1]);
      if (sides.size() == 1) rims.push_back(sides[0]);
      if (sides.size() != 2) ends_.insert(ends_.end(), sides.begin(), sides.end());
    }
    join_vertices(rims);
    for (const std::uint32_t side : rims) {
      for (const std::uint32_t v : {from(side), to(side)}) senses_.holes += counts_once(v);
    }
    put_back(rims);
  }

  // --- sets of rim vertices ---
  void join_vertices(std::span<const std::uint32_t> sides) {
    for (const std::uint32_t side : sides) sets_.join(from(side), to(side));
    counted_.clear();
  }
  // Whether this is the first call for the root of a set.
  bool counts_once(std::uint32_t vertex) {
    if (sets_.find(vertex) != vertex) return false;
    counted_.push_back(vertex);
    return std::count(counted_.begin(), counted_.end(), vertex) == 1;
  }
  void put_back(std::span<const std::uint32_t> sides) {
    for (const std::uint32_t side : sides) sets_.put_back(from(side)), sets_.put_back(to(side));
  }
};

}  // namespace
}  // namespace fascicle
