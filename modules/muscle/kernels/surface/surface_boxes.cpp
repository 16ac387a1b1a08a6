#include "modules/muscle/kernels/surface/surface_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace fascicle::muscle {
namespace {

constexpr float kFar = std::numeric_limits<float>::max();
constexpr SurfaceRange kNothing{{kFar, kFar, kFar, kFar}, {-kFar, -kFar, -kFar, -kFar}};

void include(SurfaceRange& range, const float* lower, const float* upper) {
  for (std::size_t k = 0; k < 4; ++k) {
    range.lower[k] = std::min(range.lower[k], lower[k]);
    range.upper[k] = std::max(range.upper[k], upper[k]);
  }
}

void include(SurfaceRange& range, const SurfaceRange& other) {
  include(range, other.lower.data(), other.upper.data());
}

SurfaceNormal unit(const SurfaceNormal& n) {
  const float square = n.x * n.x + n.y * n.y + n.z * n.z;
  if (!(square > std::numeric_limits<float>::min())) return {};
  const float factor = 1.0f / std::sqrt(square);
  return {n.x * factor, n.y * factor, n.z * factor, 0.0f};
}

void place_normals(const SurfaceAsset& asset, std::span<const SurfacePoint> points, SurfaceBoxes& boxes) {
  std::fill(boxes.vertex_normals.begin(), boxes.vertex_normals.end(), SurfaceNormal{});
  for (std::size_t t = 0; t < boxes.triangle_normals.size(); ++t) {
    const std::uint32_t* corner = &asset.triangles[3 * t];
    const SurfacePoint &a = points[corner[0]], &b = points[corner[1]], &c = points[corner[2]];
    const float ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const SurfaceNormal normal{uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx, 0.0f};
    for (std::size_t k = 0; k < 3; ++k) {
      SurfaceNormal& sum = boxes.vertex_normals[corner[k]];
      sum = {sum.x + normal.x, sum.y + normal.y, sum.z + normal.z, 0.0f};
    }
    boxes.triangle_normals[t] = unit(normal);
  }
  for (SurfaceNormal& normal : boxes.vertex_normals) normal = unit(normal);
}

}  // namespace

void lay_out_boxes(const SurfaceTree& tree, const SurfaceAsset& asset, bool itself, SurfaceBoxes& boxes) {
  boxes.boxes.assign(tree.nodes.size(), kNothing);
  boxes.normal_ranges.assign(itself ? tree.nodes.size() : 0, kNothing);
  boxes.triangle_normals.assign(itself ? asset.triangle_count() : 0, SurfaceNormal{});
  boxes.vertex_normals.assign(itself ? asset.vertex_count : 0, SurfaceNormal{});
}

void place_boxes(const SurfaceTree& tree, const SurfaceAsset& asset, std::span<const SurfacePoint> points,
                 SurfaceBoxes& boxes) {
  const bool itself = !boxes.normal_ranges.empty();
  if (itself) place_normals(asset, points, boxes);
  for (std::size_t n = tree.nodes.size(); n-- > 0;) {
    const SurfaceTree::Node& node = tree.nodes[n];
    SurfaceRange box = kNothing, normals = kNothing;
    if (node.count == 0) {
      box = boxes.boxes[n + 1];
      include(box, boxes.boxes[node.right]);
      if (itself) {
        normals = boxes.normal_ranges[n + 1];
        include(normals, boxes.normal_ranges[node.right]);
      }
    } else {
      const std::uint32_t* vertices = &tree.vertices[node.first_vertex];
      for (std::uint32_t i = 0; i < node.vertex_count; ++i) {
        const float* p = &points[vertices[i]].x;
        include(box, p, p);
      }
      for (std::uint32_t i = 0; itself && i < node.count; ++i) {
        const float* normal = &boxes.triangle_normals[tree.triangles[node.first + i]].x;
        include(normals, normal, normal);
      }
      for (std::uint32_t i = 0; itself && i < node.own; ++i) {
        const float* normal = &boxes.vertex_normals[vertices[i]].x;
        include(normals, normal, normal);
      }
    }
    boxes.boxes[n] = box;
    if (itself) boxes.normal_ranges[n] = normals;
  }
}

}  // namespace fascicle::muscle
