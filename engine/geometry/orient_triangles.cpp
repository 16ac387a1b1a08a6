#include "engine/geometry/orient_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/geometric.hpp>

#include "engine/geometry/mesh_edges.hpp"

namespace fascicle {
namespace {

constexpr double kSheet = 0.75;  // caps that are this part of the surface make it a sheet
constexpr double kFlat = 1e-9;   // a volume below this part of area^1.5 is none
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
  // Whether they were apart.
  bool join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parents_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }
  void put_back(std::uint32_t v) { parents_[v] = v; }

 private:
  std::vector<std::uint32_t> parents_;
};

// One component, in the sense of its first triangle.
struct Component {
  std::size_t triangles = 0, against = 0;  // against: those that must be turned to have the sense of the first
  double area = 0.0, cap_area = 0.0;       // twice the area
  double volume = 0.0;                     // six times the volume, with the caps
  bool turn = false;                       // the sense of the first is inward
  bool sheet = false;                      // caps are so large that its volume says nothing
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
    std::vector<std::uint32_t> open;
    for (std::size_t e = 0; e < edges_.count(); ++e) {
      const std::span<const std::uint32_t> sides = edges_.sides_of(e);
      senses_.crowded_edges += sides.size() > 2;
      senses_.twisted_edges += sides.size() == 2 && rises(sides[0]) == rises(sides[1]);
      if (sides.size() == 1) open.push_back(sides[0]);
      if (sides.size() != 2) rims_.insert(rims_.end(), sides.begin(), sides.end());
    }
    senses_.open_edges = open.size();
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t side : open) {
      vertices.push_back(from(side));
      vertices.push_back(to(side));
      senses_.holes -= sets_.join(from(side), to(side));
    }
    std::ranges::sort(vertices);
    senses_.holes += static_cast<std::size_t>(std::unique(vertices.begin(), vertices.end()) - vertices.begin());
    put_back(open);
  }

  void put_back(std::span<const std::uint32_t> sides) {
    for (const std::uint32_t side : sides) {
      sets_.put_back(from(side));
      sets_.put_back(to(side));
    }
  }

  // Twice a triangle's area, and six times the volume of its tetrahedron with the origin.
  struct Measures {
    double area, volume;
  };
  static Measures measure(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return {glm::length(glm::cross(b - a, c - a)), glm::dot(a, glm::cross(b, c))};
  }

  void measure_triangles() {
    for (std::uint32_t t = 0; t < component_of_.size(); ++t) {
      const Measures m = measure(point(indices_[3 * t]), point(indices_[3 * t + 1]), point(indices_[3 * t + 2]));
      Component& component = components_[component_of_[t]];
      component.area += m.area;
      component.volume += senses_.turned[t] != 0 ? -m.volume : m.volume;
    }
  }

  // Closes each component, in thought, by fans from the middle of each connected set of its rims.
  void measure_caps() {
    std::ranges::stable_sort(rims_, {}, [&](std::uint32_t side) { return component_of_[side / 3]; });
    for (std::size_t begin = 0, end = 0; begin < rims_.size(); begin = end) {
      const std::uint32_t id = component_of_[rims_[begin] / 3];
      while (end < rims_.size() && component_of_[rims_[end] / 3] == id) ++end;
      const std::span<std::uint32_t> rim = std::span(rims_).subspan(begin, end - begin);
      for (const std::uint32_t side : rim) sets_.join(from(side), to(side));
      std::ranges::stable_sort(rim, {}, [&](std::uint32_t side) { return sets_.find(from(side)); });
      for (std::size_t first = 0, last = 0; first < rim.size(); first = last) {
        while (last < rim.size() && sets_.find(from(rim[last])) == sets_.find(from(rim[first]))) ++last;
        measure_cap(rim.subspan(first, last - first), components_[id]);
      }
      put_back(rim);
    }
  }

  void measure_cap(std::span<const std::uint32_t> rim, Component& component) const {
    glm::dvec3 apex(0.0);
    for (const std::uint32_t side : rim) apex += point(from(side)) + point(to(side));
    apex /= 2.0 * static_cast<double>(rim.size());
    for (const std::uint32_t side : rim) {
      const Measures m = measure(point(to(side)), point(from(side)), apex);
      component.cap_area += m.area;
      component.volume += senses_.turned[side / 3] != 0 ? -m.volume : m.volume;
    }
  }

  void choose_senses() {
    std::size_t sheets = 0;
    for (Component& component : components_) {
      component.sheet = component.cap_area >= kSheet * component.area;
      sheets += component.sheet;
      const bool flat = std::abs(component.volume) <= kFlat * std::pow(component.area, 1.5);
      component.turn = component.sheet || flat ? 2 * component.against > component.triangles : component.volume < 0.0;
    }
    if (sheets < 2 || !sheets_face_inward()) return;
    for (Component& component : components_) component.turn ^= component.sheet;
  }

  // Whether the sheets, each in its chosen sense, face the middle of them all more than they face away.
  bool sheets_face_inward() const {
    glm::dvec3 sum(0.0);
    double area = 0.0;
    const auto for_each_sheet_triangle = [&](auto f) {
      for (std::uint32_t t = 0; t < component_of_.size(); ++t) {
        const Component& component = components_[component_of_[t]];
        if (!component.sheet) continue;
        const bool turned = component.turn != (senses_.turned[t] != 0);
        f(point(indices_[3 * t]), point(indices_[3 * t + 1]), point(indices_[3 * t + 2]), turned);
      }
    };
    for_each_sheet_triangle([&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, bool) {
      const double part = measure(a, b, c).area;
      area += part;
      sum += part * (a + b + c) / 3.0;
    });
    if (area == 0.0) return false;
    const glm::dvec3 middle = sum / area;
    double volume = 0.0;
    for_each_sheet_triangle([&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, bool turned) {
      volume += (turned ? -1.0 : 1.0) * measure(a - middle, b - middle, c - middle).volume;
    });
    return volume < -kFlat * std::pow(area, 1.5);
  }

  std::span<const glm::vec3> positions_;
  std::span<const std::uint32_t> indices_;
  MeshEdges edges_;
  std::vector<std::uint32_t> component_of_;  // of each triangle
  std::vector<std::uint32_t> rims_;          // sides at edges that have not two triangles
  std::vector<Component> components_;
  VertexSets sets_;
  glm::dvec3 middle_{0.0};
  TriangleSenses senses_;
};

}  // namespace

TriangleSenses orient_triangles(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices) {
  return Orienter(positions, indices).orient();
}

}  // namespace fascicle
