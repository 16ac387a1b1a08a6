#include "engine/geometry/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

#include "engine/geometry/finite.hpp"

namespace fascicle {
namespace {

struct Item {
  glm::vec3 middle;  // a third of the corners' sum
  std::uint32_t number;
};

class Builder {
 public:
  Builder(const TriangleMesh& mesh, TriangleTree& tree) : mesh_(mesh), tree_(tree) {
    items_.reserve(mesh.indices.size() / 3);
    for (std::uint32_t t = 0; 3 * std::size_t{t} + 2 < mesh.indices.size(); ++t) {
      const std::array<glm::vec3, 3> corners = corners_of(t);
      if (!is_finite(corners[0]) || !is_finite(corners[1]) || !is_finite(corners[2])) continue;
      items_.push_back({corners[0] / 3.0f + corners[1] / 3.0f + corners[2] / 3.0f, t});
    }
    if (items_.empty()) return;
    tree_.nodes.reserve(2 * (items_.size() / (kTreeLeafSize / 2) + 1));
    split(0, items_.size());
    tree_.triangles.reserve(items_.size());
    tree_.numbers.reserve(items_.size());
    for (const Item& item : items_) {
      tree_.triangles.push_back(corners_of(item.number));
      tree_.numbers.push_back(item.number);
    }
  }

 private:
  std::array<glm::vec3, 3> corners_of(std::uint32_t t) const {
    return {mesh_.positions[mesh_.indices[3 * t]], mesh_.positions[mesh_.indices[3 * t + 1]],
            mesh_.positions[mesh_.indices[3 * t + 2]]};
  }

  void split(std::size_t begin, std::size_t end) {
    const std::size_t node = tree_.nodes.size();
    tree_.nodes.emplace_back();
    if (end - begin <= kTreeLeafSize) {
      TriangleTree::Node leaf;
      leaf.lower = leaf.upper = corners_of(items_[begin].number)[0];
      for (std::size_t i = begin; i < end; ++i) {
        for (const glm::vec3& corner : corners_of(items_[i].number)) {
          leaf.lower = glm::min(leaf.lower, corner);
          leaf.upper = glm::max(leaf.upper, corner);
        }
      }
      leaf.first = static_cast<std::uint32_t>(begin);
      leaf.count = static_cast<std::uint32_t>(end - begin);
      tree_.nodes[node] = leaf;
      return;
    }
    glm::vec3 lower = items_[begin].middle, upper = lower;
    for (std::size_t i = begin + 1; i < end; ++i) {
      lower = glm::min(lower, items_[i].middle);
      upper = glm::max(upper, items_[i].middle);
    }
    const glm::dvec3 size = glm::dvec3(upper) - glm::dvec3(lower);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [axis](const Item& a, const Item& b) {
      return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis] : a.number < b.number;
    });
    split(begin, middle);
    const std::size_t right = tree_.nodes.size();
    split(middle, end);
    TriangleTree::Node& inner = tree_.nodes[node];
    inner.lower = glm::min(tree_.nodes[node + 1].lower, tree_.nodes[right].lower);
    inner.upper = glm::max(tree_.nodes[node + 1].upper, tree_.nodes[right].upper);
    inner.first = static_cast<std::uint32_t>(right);
  }

  const TriangleMesh& mesh_;
  TriangleTree& tree_;
  std::vector<Item> items_;
};

}  // namespace

TriangleTree build_triangle_tree(const TriangleMesh& mesh) {
  TriangleTree tree;
  Builder(mesh, tree);
  return tree;
}

}  // namespace fascicle
