#include "modules/muscle/kernels/hull/hull_state.hpp"

#include <algorithm>
#include <array>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "modules/muscle/kernels/hull/line_place.hpp"
#include "modules/muscle/kernels/hull/mesh_volume.hpp"

namespace fascicle::muscle {
namespace {

constexpr std::uint32_t kRotationIterations = 4;

SurfacePoint to_point(const glm::vec3& p) { return {p.x, p.y, p.z, 0.0f}; }

// Column `column` of the matrix in a lane.
glm::vec3 column_of(const MatrixPack& pack, std::size_t lane, std::size_t column) {
  return {pack.value[column][lane], pack.value[3 + column][lane], pack.value[6 + column][lane]};
}

// <R, S> - tr S, summed.
double turned_work(std::span<const MatrixPack> rotations, std::span<const MatrixPack> shape) {
  double sum = 0.0;
  for (std::size_t p = 0; p < shape.size(); ++p) {
    for (std::size_t i = 0; i < 9; ++i) {
      const float identity = i % 4 == 0 ? 1.0f : 0.0f;
      for (std::size_t lane = 0; lane < kPanelRows; ++lane) {
        sum += static_cast<double>(rotations[p].value[i][lane] - identity) * static_cast<double>(shape[p].value[i][lane]);
      }
    }
  }
  return sum;
}

// Where the rest's difference between two parts of the muscle is to be: turned and stretched as the line's is.
glm::vec3 along_line(const glm::vec3& rest, const glm::vec3& line_rest, const glm::vec3& line_now) {
  const float before = glm::length(line_rest), now = glm::length(line_now);
  if (!(before > 0.0f) || !(now > 0.0f)) return rest;
  return now / before * (glm::quat(line_rest / before, line_now / now) * rest);
}

}  // namespace

void find_load(const HullProblem& problem, HullScratch& scratch) {
  const HullAsset& hull = problem.hull;
  std::ranges::fill(scratch.load, SurfacePoint{});
  for (std::size_t i = 0; i < hull.attachments.size(); ++i) {
    const glm::mat4 moved = problem.step.attachments[i].to - glm::mat4(1.0f);
    const std::array<SurfacePoint, 4> rows{to_point(moved[0]), to_point(moved[1]), to_point(moved[2]), to_point(moved[3])};
    problem.kernels.multiply({.matrix = &hull.attachments[i].load, .in = rows, .out = scratch.load, .add = true});
  }
  const HullDirection& direction = hull.direction;
  if (direction.rest.empty()) return;
  const HullVector targets = HullVector(scratch.columns).first(direction.rest.size());
  for (std::size_t i = 0; i < direction.rest.size(); ++i) {
    const glm::vec3 now = place_along(problem.line, direction.along[i + 1]) - place_along(problem.line, direction.along[i]);
    targets[i] = to_point(along_line(direction.rest[i], direction.line[i], now) - direction.rest[i]);
  }
  problem.kernels.multiply({.matrix = &direction.load, .in = targets, .out = scratch.load, .add = true});
}

void add_columns(HullRow columns, std::span<MatrixPack> packs) {
  for (std::size_t row = 0; row < columns.size(); ++row) {
    const std::size_t cluster = row / 3, column = row % 3, lane = cluster % kPanelRows;
    MatrixPack& pack = packs[cluster / kPanelRows];
    pack.value[column][lane] += columns[row].x;
    pack.value[3 + column][lane] += columns[row].y;
    pack.value[6 + column][lane] += columns[row].z;
  }
}

void gather_rotations(const HullProblem& problem, std::span<const MatrixPack> rotations, HullVector columns,
                      HullVector out) {
  constexpr std::array<glm::vec3, 3> kIdentity{glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)};
  for (std::size_t row = 0; row < columns.size(); ++row) {
    const std::size_t cluster = row / 3;
    set(columns[row], column_of(rotations[cluster / kPanelRows], cluster % kPanelRows, row % 3) - kIdentity[row % 3]);
  }
  problem.kernels.multiply({.matrix = &problem.hull.shape.gather, .in = columns, .out = out});
}

void evaluate(const HullProblem& problem, HullScratch& scratch, HullState& state) {
  const HullAsset& hull = problem.hull;
  problem.kernels.multiply({.matrix = &hull.samples.weights, .in = state.moved, .out = state.samples});
  for (std::size_t i = 0; i < state.samples.size(); ++i) {
    const SurfacePoint& rest = problem.step.asset->rest[hull.samples.vertices[i]];
    state.samples[i].x += rest.x;
    state.samples[i].y += rest.y;
    state.samples[i].z += rest.z;
  }
  state.volume = measure_volume(hull.samples.triangles, state.samples, {});
  std::ranges::copy(hull.shape.rest, state.shape.begin());
  problem.kernels.multiply({.matrix = &hull.shape.spread, .in = state.moved, .out = scratch.columns});
  add_columns(scratch.columns, state.shape);
  problem.kernels.fit_rotations(
      {.matrices = state.shape, .rotations = state.rotations, .iterations = kRotationIterations});
  problem.kernels.multiply({.matrix = &hull.shape.stiffness, .in = state.moved, .out = state.stiff});
  state.energy = 0.5 * dot(HullRow(state.moved), HullRow(state.stiff)) -
                 dot(HullRow(state.moved), HullRow(scratch.load)) - turned_work(state.rotations, state.shape);
}

}  // namespace fascicle::muscle
