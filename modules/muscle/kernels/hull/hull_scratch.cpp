#include "modules/muscle/kernels/hull/hull_scratch.hpp"

#include <algorithm>

namespace fascicle::muscle {
namespace {

constexpr std::size_t kMostIterations = 1000;  // that a game may ask for without an allocation

void lay_out(const SurfaceAsset& surface, const HullAsset& hull, HullState& state) {
  const std::size_t count = hull.rest.size();
  state.moved.resize(count);
  state.stiff.resize(count);
  state.samples.clear();
  for (const std::uint32_t vertex : hull.samples.vertices) state.samples.push_back(surface.rest[vertex]);
  state.shape.resize(hull.shape.rest.size());
  state.rotations.resize(hull.shape.rest.size());
  state.contacts.reserve(hull.samples.vertices.size() * std::max<std::size_t>(surface.bones.size(), 1));
}

}  // namespace

void lay_out(const SurfaceAsset& surface, const HullAsset& hull, HullScratch& scratch) {
  const std::size_t count = hull.rest.size(), bones = surface.bones.size(), samples = hull.samples.vertices.size();
  const std::size_t vertices = surface.vertex_count, packs = (vertices + kPanelRows - 1) / kPanelRows;
  scratch.residuals.reserve(kMostIterations);
  scratch.refined.reserve(kMostIterations);
  scratch.touches.resize(bones);
  scratch.bones.resize(bones);
  scratch.balls.resize((std::max(vertices, samples) + kBallVertices - 1) / kBallVertices);
  scratch.near.resize(std::max(vertices, samples));
  scratch.taken.resize(hull.shape.clusters);
  lay_out(surface, hull, scratch.state);
  lay_out(surface, hull, scratch.trial);
  for (auto* rows : {&scratch.load, &scratch.step, &scratch.residual, &scratch.direction, &scratch.conditioned,
                     &scratch.product, &scratch.volume_row, &scratch.volume_solution}) {
    rows->resize(count);
  }
  scratch.columns.resize(3 * hull.shape.clusters);
  scratch.sample_gradient.resize(samples);
  scratch.sample_moves.resize(samples);
  scratch.turn_inverse.resize(hull.shape.clusters);
  scratch.brought.resize(vertices);
  scratch.before.resize(vertices);
  scratch.bent.resize(vertices);
  scratch.gradient.resize(vertices);
  scratch.vertex_shape.resize(packs);
  scratch.vertex_rotations.resize(packs);
  scratch.columns_of_factor.resize(hull.full.factor.size);
}

}  // namespace fascicle::muscle
