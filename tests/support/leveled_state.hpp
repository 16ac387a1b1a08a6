// A musculature with levels outside of any world, and how far two drawn surfaces are apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "engine/content/triangle_mesh.hpp"
#include "engine/geometry/closest_point.hpp"
#include "modules/muscle/systems/1_drive/select_levels.hpp"
#include "modules/muscle/systems/5_present/write_surfaces.hpp"
#include "tests/support/muscle_state.hpp"

namespace fascicle::test {

struct LeveledState : MuscleState {
  muscle::MuscleDetail detail;

  explicit LeveledState(std::shared_ptr<const muscle::MuscleLevels> levels, muscle::LevelChoice choice = {})
      : MuscleState(levels->assets.front()) {
    musculature.coarser = levels->morphs.data();
    sections.ends = levels->assets.front()->ends;
    detail = {.levels = levels, .twist = std::vector<float>(levels->assets.front()->size())};
    set(choice);
  }
  void set(muscle::LevelChoice choice) {
    muscle::set_level(choice, detail, musculature, lines, sections, surfaces);
  }
};

// A muscle's drawn surface as it is now.
inline TriangleMesh drawn_mesh(const MuscleState& state, std::uint32_t m) {
  const muscle::MuscleSurfaceView view = surface_of(state.asset(), state.surfaces, m);
  TriangleMesh mesh;
  for (const muscle::SurfaceVertex& vertex : view.vertices) mesh.positions.push_back(vertex.position);
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t index : {a, b, c}) mesh.indices.push_back(index - view.first_vertex);
  };
  std::size_t start = 0;
  for (std::size_t i = 0; i < view.strips.size(); ++i) {
    if (view.strips[i] == muscle::kRestartIndex) start = i + 1;
    else if (i >= start + 2) add(view.strips[i - 2], view.strips[i - 1], view.strips[i]);
  }
  start = 0;
  for (std::size_t i = 0; i < view.fans.size(); ++i) {
    if (view.fans[i] == muscle::kRestartIndex) start = i + 1;
    else if (i >= start + 2) add(view.fans[start], view.fans[i - 1], view.fans[i]);
  }
  return mesh;
}

// Distances between two surfaces of all muscles, from the vertices of each to the other's nearest point, m.
struct SurfaceGap {
  std::vector<float> distances;  // sorted

  SurfaceGap(const MuscleState& a, const MuscleState& b) {
    for (std::uint32_t m = 0; m < a.asset().size(); ++m) {
      const TriangleMesh mesh_a = drawn_mesh(a, m), mesh_b = drawn_mesh(b, m);
      add(mesh_a, ClosestPoints(mesh_b));
      add(mesh_b, ClosestPoints(mesh_a));
    }
    std::sort(distances.begin(), distances.end());
  }
  void add(const TriangleMesh& from, const ClosestPoints& to) {
    for (const glm::vec3& position : from.positions) distances.push_back(to.at(position).distance);
  }
  float max() const { return distances.back(); }
  float percentile(float p) const {  // 0..1
    return distances[static_cast<std::size_t>(p * static_cast<float>(distances.size() - 1))];
  }
  float rms() const {
    double sum = 0.0;
    for (const float d : distances) sum += double{d} * double{d};
    return static_cast<float>(std::sqrt(sum / static_cast<double>(distances.size())));
  }
};

}  // namespace fascicle::test
