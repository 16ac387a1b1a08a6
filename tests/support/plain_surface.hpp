// A surface asset made by hand from a mesh, without the checks, the sorting and the colours of build_surface_asset: what
// tests of the measuring need to know the answer beforehand.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::test {

inline std::vector<muscle::SurfacePoint> to_points(const std::vector<glm::vec3>& positions) {
  std::vector<muscle::SurfacePoint> points;
  for (const glm::vec3& p : positions) points.push_back({p.x, p.y, p.z, 1.0f});
  return points;
}

// An edge with one triangle has no hinge.
inline muscle::SurfaceAsset plain_surface(const TriangleMesh& mesh) {
  muscle::SurfaceAsset asset;
  asset.name = mesh.name;
  asset.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
  for (const muscle::SurfacePoint& p : to_points(mesh.positions)) asset.rest.push_back(p);
  asset.triangles = mesh.indices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> opposite;
  double volume = 0.0;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const std::uint32_t* corner = mesh.indices.data() + t;
    for (std::size_t i = 0; i < 3; ++i) opposite[{corner[i], corner[(i + 1) % 3]}] = corner[(i + 2) % 3];
    const glm::dvec3 a(mesh.positions[corner[0]]), b(mesh.positions[corner[1]]), c(mesh.positions[corner[2]]);
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  asset.volume = volume;
  for (const auto& [edge, left] : opposite) {
    const auto right = opposite.find({edge.second, edge.first});
    if (edge.first > edge.second || right == opposite.end()) continue;
    const glm::dvec3 p1(mesh.positions[edge.first]), p2(mesh.positions[edge.second]), p3(mesh.positions[left]),
        p4(mesh.positions[right->second]), e = p2 - p1;
    const glm::dvec3 n1 = glm::cross(e, p3 - p1), n2 = glm::cross(p4 - p1, e);
    const double angle = std::atan2(glm::dot(glm::cross(n1, n2), e) / glm::length(e), glm::dot(n1, n2));
    asset.hinges.push_back({{edge.first, edge.second, left, right->second},
                            static_cast<float>(glm::length(e)), static_cast<float>(angle)});
  }
  return asset;
}

// Attaches vertices to a bone; the lists stay in order where calls come by rising vertices.
inline void attach(muscle::SurfaceAsset& asset, std::int32_t bone, const std::vector<std::uint32_t>& vertices) {
  const auto attachment = static_cast<std::uint32_t>(asset.attachments.size());
  asset.attachments.push_back({bone, attachment == 0, static_cast<std::uint32_t>(vertices.size())});
  for (const std::uint32_t vertex : vertices) asset.attached.push_back({vertex, attachment});
}

}  // namespace fascicle::test
