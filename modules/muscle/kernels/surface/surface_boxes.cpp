#include "modules/muscle/kernels/surface/surface_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "modules/muscle/kernels/surface/surface_range.hpp"

namespace fascicle::muscle {
namespace {

using namespace FASCICLE_ISA;

constexpr float kFar = std::numeric_limits<float>::max();
constexpr SurfaceRange kNothing{{kFar, kFar, kFar, 0.0f}, {-kFar, -kFar, -kFar, 0.0f}};

SurfaceNormal unit(const SurfaceNormal& n) {
  const float square = n.x * n.x + n.y * n.y + n.z * n.z;
  if (!(square > std::numeric_limits<float>::min())) return {};
  const float factor = 1.0f / std::sqrt(square);
  return {n.x * factor, n.y * factor, n.z * factor, 0.0f};
}

void place_normals(const SurfaceAsset& asset, std::span<const SurfacePoint> points, SurfaceBoxes& boxes) {
  std::fill(boxes.vertex_normals.begin(), boxes.vertex_normals.end(), kNothing);
  for (std::size_t t = 0; t < boxes.triangle_normals.size(); ++t) {
    const std::uint32_t* corner = &asset.triangles[3 * t];
    const SurfacePoint &a = points[corner[0]], &b = points[corner[1]], &c = points[corner[2]];
    const float ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    SurfaceNormal& normal = boxes.triangle_normals[t];
    normal = unit({uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx, 0.0f});
    const FourLanes lanes = load<4>(&normal.x);
    for (std::size_t k = 0; k < 3; ++k) {
      WideRange range = load_range(boxes.vertex_normals[corner[k]]);
      include(range, lanes);
      store_range(range, boxes.vertex_normals[corner[k]]);
    }
  }
}

}  // namespace

void lay_out_boxes(const SurfaceTree& tree, const SurfaceAsset& asset, bool itself, SurfaceBoxes& boxes) {
  boxes.boxes.assign(tree.nodes.size(), kNothing);
  boxes.normal_ranges.assign(itself ? tree.nodes.size() : 0, kNothing);
  boxes.triangle_normals.assign(itself ? asset.triangle_count() : 0, SurfaceNormal{});
  const std::size_t planes = itself ? asset.triangle_count() + kPlaneLanes : 0;
  for (AlignedVector<float>* plane : {&boxes.plane_x, &boxes.plane_y, &boxes.plane_z, &boxes.plane_height}) {
    plane->assign(planes, 0.0f);
  }
  boxes.own_points.assign(itself ? tree.vertices.size() : 0, SurfacePoint{});
  boxes.vertex_normals.assign(itself ? asset.vertex_count : 0, kNothing);
}

void place_boxes(const SurfaceTree& tree, const SurfaceAsset& asset, std::span<const SurfacePoint> points,
                 SurfaceBoxes& boxes) {
  boxes.placed = true;
  const bool itself = !boxes.normal_ranges.empty();
  if (itself) place_normals(asset, points, boxes);
  for (std::size_t n = tree.nodes.size(); n-- > 0;) {
    const SurfaceTree::Node& node = tree.nodes[n];
    WideRange box = load_range(kNothing), normals = box;
    if (node.count == 0) {
      box = load_range(boxes.boxes[n + 1]);
      include(box, load_range(boxes.boxes[node.right]));
      if (itself) {
        normals = load_range(boxes.normal_ranges[n + 1]);
        include(normals, load_range(boxes.normal_ranges[node.right]));
      }
    } else {
      const std::uint32_t* vertices = &tree.vertices[node.first_vertex];
      for (std::uint32_t i = 0; i < node.vertex_count; ++i) include(box, load<4>(&points[vertices[i]].x));
      for (std::uint32_t i = 0; itself && i < node.count; ++i) {
        const std::uint32_t place = node.first + i, t = tree.triangles[place];
        const SurfaceNormal& normal = boxes.triangle_normals[t];
        const SurfacePoint& corner = points[asset.triangles[3 * std::size_t{t}]];
        include(normals, load<4>(&normal.x));
        boxes.plane_x[place] = normal.x;
        boxes.plane_y[place] = normal.y;
        boxes.plane_z[place] = normal.z;
        boxes.plane_height[place] = normal.x * corner.x + normal.y * corner.y + normal.z * corner.z;
      }
      for (std::uint32_t i = 0; itself && i < node.own; ++i) {
        include(normals, load_range(boxes.vertex_normals[vertices[i]]));
        boxes.own_points[node.first_vertex + i] = points[vertices[i]];
      }
    }
    store_range(box, boxes.boxes[n]);
    boxes.boxes[n].lower[3] = boxes.boxes[n].upper[3] = 0.0f;  // there a point has its inverse mass
    if (itself) store_range(normals, boxes.normal_ranges[n]);
  }
}

}  // namespace fascicle::muscle
