#include "modules/muscle/asset/surface/surface_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

// Edges: normals that turn by a radian count like places so many mean edges apart.
constexpr float kEdgesPerRadian = 4.0f;

constexpr std::size_t kAxes = 6;  // of place and normal

struct Item {
  std::array<float, kAxes> at{};
  std::uint32_t triangle = 0;
};

class Builder {
 public:
  Builder(const SurfaceAsset& asset, SurfaceTree& tree) : asset_(asset), tree_(tree), owned_(asset.vertex_count, 0) {
    const float radian = kEdgesPerRadian * asset.mean_edge;
    items_.resize(asset.triangle_count());
    tree_.rest_normals.assign(asset.vertex_count, SurfaceRange{});
    std::vector<std::uint8_t> seen(asset.vertex_count, 0);
    for (std::uint32_t t = 0; t < items_.size(); ++t) {
      const glm::vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
      const glm::vec3 area = glm::cross(b - a, c - a);
      const float length = glm::length(area);
      const glm::vec3 normal = length > 0.0f ? area / length : glm::vec3(0.0f);
      const glm::vec3 middle = (a + b + c) / 3.0f, turn = radian * normal;
      items_[t] = {{middle.x, middle.y, middle.z, turn.x, turn.y, turn.z}, t};
      for (std::size_t k = 0; k < 3 && length > 0.0f; ++k) {
        const std::uint32_t v = asset.triangles[3 * t + k];
        SurfaceRange& range = tree_.rest_normals[v];
        for (int axis = 0; axis < 3; ++axis) {
          float& lower = range.lower[static_cast<std::size_t>(axis)];
          float& upper = range.upper[static_cast<std::size_t>(axis)];
          lower = seen[v] != 0 ? std::min(lower, normal[axis]) : normal[axis];
          upper = seen[v] != 0 ? std::max(upper, normal[axis]) : normal[axis];
        }
        seen[v] = 1;
      }
    }
    if (items_.empty()) return;
    split(0, items_.size());
    tree_.triangles.reserve(items_.size());
    for (const Item& item : items_) tree_.triangles.push_back(item.triangle);
  }

 private:
  glm::vec3 corner(std::uint32_t t, std::size_t k) const {
    const SurfacePoint& p = asset_.rest[asset_.triangles[3 * t + k]];
    return {p.x, p.y, p.z};
  }

  void split(std::size_t begin, std::size_t end) {
    const std::size_t node = tree_.nodes.size();
    tree_.nodes.emplace_back();
    if (end - begin <= kSurfaceLeaf) return fill_leaf(node, begin, end);
    std::array<float, kAxes> lower = items_[begin].at, upper = lower;
    for (std::size_t i = begin + 1; i < end; ++i) {
      for (std::size_t axis = 0; axis < kAxes; ++axis) {
        lower[axis] = std::min(lower[axis], items_[i].at[axis]);
        upper[axis] = std::max(upper[axis], items_[i].at[axis]);
      }
    }
    std::size_t axis = 0;
    for (std::size_t other = 1; other < kAxes; ++other) {
      if (upper[other] - lower[other] > upper[axis] - lower[axis]) axis = other;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [axis](const Item& a, const Item& b) {
      return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.triangle < b.triangle;
    });
    split(begin, middle);
    tree_.nodes[node].right = static_cast<std::uint32_t>(tree_.nodes.size());
    split(middle, end);
  }

  void fill_leaf(std::size_t number, std::size_t begin, std::size_t end) {
    SurfaceTree::Node& node = tree_.nodes[number];
    node.first = static_cast<std::uint32_t>(begin);
    node.count = static_cast<std::uint32_t>(end - begin);
    node.first_vertex = static_cast<std::uint32_t>(tree_.vertices.size());
    std::array<std::uint32_t, 3 * kSurfaceLeaf> corners{};
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < 3; ++k) corners[count++] = asset_.triangles[3 * items_[i].triangle + k];
    }
    const auto last = corners.begin() + static_cast<std::ptrdiff_t>(count);
    std::sort(corners.begin(), last);
    const auto unique = std::unique(corners.begin(), last);
    const auto others = std::stable_partition(corners.begin(), unique, [&](std::uint32_t v) { return owned_[v] == 0; });
    for (auto v = corners.begin(); v != others; ++v) owned_[*v] = 1;
    node.own = static_cast<std::uint32_t>(others - corners.begin());
    node.vertex_count = static_cast<std::uint32_t>(unique - corners.begin());
    tree_.vertices.insert(tree_.vertices.end(), corners.begin(), unique);
  }

  const SurfaceAsset& asset_;
  SurfaceTree& tree_;
  std::vector<Item> items_;
  std::vector<std::uint8_t> owned_;  // by vertex: some leaf has it
};

}  // namespace

SurfaceTree build_surface_tree(const SurfaceAsset& asset) {
  SurfaceTree tree;
  Builder(asset, tree);
  return tree;
}

}  // namespace fascicle::muscle
