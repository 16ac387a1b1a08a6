// A muscle with known fibres: a closed round tube along z from 0, its lower cap attached as the origin, its upper cap
// as the insertion.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::test {

inline constexpr std::uint32_t kTubeSides = 32, kTubeLayers = 24;

inline TriangleMesh make_tube(float radius, float length) {
  std::vector<glm::vec2> outline;
  for (std::uint32_t i = 0; i < kTubeSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kTubeSides;
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  TriangleMesh mesh = make_wall(outline, 0.0f, length, kTubeLayers);
  const auto bottom = static_cast<std::uint32_t>(mesh.positions.size()), top = bottom + 1;
  mesh.positions.emplace_back(0.0f, 0.0f, 0.0f);
  mesh.positions.emplace_back(0.0f, 0.0f, length);
  for (std::uint32_t i = 0; i < kTubeSides; ++i) {
    const std::uint32_t next = (i + 1) % kTubeSides, first = kTubeSides * kTubeLayers;
    mesh.indices.insert(mesh.indices.end(), {bottom, next, i, top, first + i, first + next});
  }
  return mesh;
}

inline muscle::SurfaceMuscleDescription describe_tube(float radius = 0.02f, float length = 0.2f) {
  muscle::SurfaceMuscleDescription description;
  description.name = "tube";
  description.mesh = make_tube(radius, length);
  description.attachments = {{.bone = 0, .origin = true, .vertices = {}}, {.bone = 1, .origin = false, .vertices = {}}};
  for (std::uint32_t v = 0; v < description.mesh.positions.size(); ++v) {
    const float z = description.mesh.positions[v].z;
    if (z <= 0.0f) description.attachments[0].vertices.push_back(v);
    if (z >= length) description.attachments[1].vertices.push_back(v);
  }
  return description;
}

}  // namespace fascicle::test
