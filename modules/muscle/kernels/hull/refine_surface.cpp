#include "modules/muscle/kernels/hull/refine_surface.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "modules/muscle/kernels/hull/mesh_volume.hpp"
#include "modules/muscle/kernels/hull/vertex_curvature.hpp"

namespace fascicle::muscle {
namespace {

constexpr int kSpreadSweeps = 8;
constexpr std::uint32_t kRotationIterations = 4;
constexpr int kVolumeSteps = 3;
constexpr double kVolumeAccuracy = 1.0e-6;  // of the volume

struct FullMesh {
  const HullFullMesh& full;
  const AlignedVector<SurfacePoint>& rest;
  std::span<const SurfacePoint> points;

  glm::vec3 now(std::uint32_t v) const { return place(points[v]); }
  glm::vec3 edge(std::uint32_t v, std::uint32_t other) const { return now(v) - now(other); }
  glm::vec3 rest_edge(std::uint32_t v, std::uint32_t other) const { return place(rest[v]) - place(rest[other]); }
};

glm::mat3 rotation_of(std::span<const MatrixPack> rotations, std::uint32_t v) {
  const MatrixPack& pack = rotations[v / kPanelRows];
  const std::size_t lane = v % kPanelRows;
  return {pack.value[0][lane], pack.value[3][lane], pack.value[6][lane], pack.value[1][lane], pack.value[4][lane],
          pack.value[7][lane], pack.value[2][lane], pack.value[5][lane], pack.value[8][lane]};
}

// S_i = sum w_ij/2 e e_0' + beta m_i d_i d_0i'. Factors come after products, so that at rest it is symmetric to the bit.
void find_shape(const FullMesh& mesh, HullScratch& scratch) {
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    glm::mat3 s(0.0f);
    for (std::uint32_t i = mesh.full.first[v]; i < mesh.full.first[v + 1]; ++i) {
      const std::uint32_t other = mesh.full.neighbour[i];
      s += 0.5f * mesh.full.weight[i] * glm::outerProduct(mesh.edge(v, other), mesh.rest_edge(v, other));
    }
    const glm::vec3 bent = vertex_curvature(mesh.full, mesh.points, v, mesh.full.curvature[v].inverse_mass);
    set(scratch.bent[v], bent);
    const SurfacePoint& rest = mesh.full.curvature[v];
    s += mesh.full.bending / rest.inverse_mass * glm::outerProduct(bent, place(rest));
    MatrixPack& pack = scratch.vertex_shape[v / kPanelRows];
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        pack.value[static_cast<std::size_t>(3 * row + column)][v % kPanelRows] = s[column][row];
      }
    }
  }
}

// What is left of the equations for a free vertex: -(half gradient of the energy).
glm::vec3 force(const FullMesh& mesh, const HullScratch& scratch, std::uint32_t v) {
  const glm::mat3 rotation = rotation_of(scratch.vertex_rotations, v);
  glm::vec3 edges(0.0f), bent(0.0f);
  for (std::uint32_t i = mesh.full.first[v]; i < mesh.full.first[v + 1]; ++i) {
    const std::uint32_t other = mesh.full.neighbour[i];
    const glm::mat3 mean = 0.5f * (rotation + rotation_of(scratch.vertex_rotations, other));
    edges += mesh.full.weight[i] * (mean * mesh.rest_edge(v, other) - mesh.edge(v, other));
    bent += mesh.full.weight[i] * (place(scratch.bent[v]) - place(scratch.bent[other]));
  }
  const float pull = mesh.full.anchor / mesh.full.curvature[v].inverse_mass;
  return edges + mesh.full.bending * bent + pull * (place(scratch.brought[v]) - mesh.now(v));
}

// Vertices move by the solution's first three columns and `share` of its last three.
void move(const HullProblem& problem, const HullScratch& scratch, float whole, float share) {
  const SparseFactor& factor = problem.hull.full.factor;
  for (std::uint32_t i = 0; i < factor.size; ++i) {
    const std::array<float, 8>& x = scratch.columns_of_factor[i].value;
    SurfacePoint& p = problem.step.points[factor.order[i]];
    p.x += whole * x[0] + share * x[3];
    p.y += whole * x[1] + share * x[4];
    p.z += whole * x[2] + share * x[5];
  }
}

double volume_now(const HullProblem& problem, HullVector gradient) {
  const SurfaceAsset& asset = *problem.step.asset;
  return measure_volume(asset.triangles, HullRow(problem.step.points).first(asset.vertex_count), gradient);
}

}  // namespace

void attach_exactly(const HullProblem& problem, HullScratch& scratch) {
  const SurfaceStep& step = problem.step;
  const HullFullMesh& full = problem.hull.full;
  // Moves of attached vertices, spread over those beside them: a few sweeps of a harmonic function.
  std::ranges::fill(scratch.gradient, SurfacePoint{});
  for (const AttachedVertex& attached : step.asset->attached) {
    const glm::vec3 rest = place(step.asset->rest[attached.vertex]);
    const glm::vec3 to(step.attachments[attached.attachment].to * glm::vec4(rest, 1.0f));
    set(scratch.gradient[attached.vertex], to - place(step.points[attached.vertex]));
    set(step.points[attached.vertex], to);
  }
  for (int sweep = 0; sweep < kSpreadSweeps; ++sweep) {
    for (const std::uint32_t v : full.beside) {
      glm::vec3 sum(0.0f);
      float weights = 0.0f;
      for (std::uint32_t i = full.first[v]; i < full.first[v + 1]; ++i) {
        sum += full.weight[i] * place(scratch.gradient[full.neighbour[i]]);
        weights += full.weight[i];
      }
      set(scratch.gradient[v], sum / weights);
    }
  }
  for (const std::uint32_t v : full.beside) set(step.points[v], place(step.points[v]) + place(scratch.gradient[v]));
}

double refine_once(const HullProblem& problem, HullScratch& scratch) {
  const SurfaceAsset& asset = *problem.step.asset;
  const SparseFactor& factor = problem.hull.full.factor;
  const FullMesh mesh{problem.hull.full, asset.rest, HullRow(problem.step.points).first(asset.vertex_count)};
  find_shape(mesh, scratch);
  problem.kernels.fit_rotations({.matrices = scratch.vertex_shape, .rotations = scratch.vertex_rotations,
                                 .iterations = kRotationIterations});
  for (std::uint32_t v = 0; v < asset.vertex_count; ++v) {
    const glm::vec3 turned = rotation_of(scratch.vertex_rotations, v) * place(mesh.full.curvature[v]);
    set(scratch.bent[v], turned - place(scratch.bent[v]));
  }
  const double volume = volume_now(problem, scratch.gradient);
  double size = 0.0;  // of the gradient, so that the solve's columns are of one kind
  for (const SurfacePoint& g : scratch.gradient) size = std::max(size, dot(g, g));
  const float scale = size > 0.0 ? static_cast<float>(1.0 / std::sqrt(size)) : 0.0f;
  for (std::uint32_t i = 0; i < factor.size; ++i) {
    const std::uint32_t v = factor.order[i];
    const glm::vec3 f = force(mesh, scratch, v), g = scale * place(scratch.gradient[v]);
    scratch.columns_of_factor[i].value = {f.x, f.y, f.z, g.x, g.y, g.z, 0.0f, 0.0f};
  }
  problem.kernels.solve_factor({.factor = &factor, .x = scratch.columns_of_factor});

  // How the volume changes by the move, and by a move along the second solution.
  double by_move = 0.0, by_share = 0.0, most = 0.0;
  for (std::uint32_t i = 0; i < factor.size; ++i) {
    const SurfacePoint& g = scratch.gradient[factor.order[i]];
    const std::array<float, 8>& x = scratch.columns_of_factor[i].value;
    by_move += dot(g, {x[0], x[1], x[2], 0.0f});
    by_share += dot(g, {x[3], x[4], x[5], 0.0f});
  }
  const double lack = mesh.full.volume - volume - by_move;
  const float share = problem.keeps_volume && by_share > 0.0 ? static_cast<float>(lack / by_share) : 0.0f;
  for (std::uint32_t i = 0; i < factor.size; ++i) {
    const std::array<float, 8>& x = scratch.columns_of_factor[i].value;
    const SurfacePoint moved{x[0] + share * x[3], x[1] + share * x[4], x[2] + share * x[5], 0.0f};
    most = std::max(most, dot(moved, moved));
  }
  move(problem, scratch, 1.0f, share);
  return std::sqrt(most);
}

double restore_volume(const HullProblem& problem, HullScratch& scratch) {
  const SurfaceAsset& asset = *problem.step.asset;
  double volume = volume_now(problem, scratch.gradient);
  for (int i = 0; problem.keeps_volume && i < kVolumeSteps; ++i) {
    const double lack = problem.hull.full.volume - volume;
    if (std::abs(lack) <= kVolumeAccuracy * problem.hull.full.volume) break;
    double square = 0.0;
    for (std::uint32_t v = 0; v < asset.vertex_count; ++v) {
      if (problem.step.points[v].inverse_mass > 0.0f) square += dot(scratch.gradient[v], scratch.gradient[v]);
    }
    if (!(square > 0.0)) break;
    const auto share = static_cast<float>(lack / square);
    for (std::uint32_t v = 0; v < asset.vertex_count; ++v) {
      SurfacePoint& p = problem.step.points[v];
      if (p.inverse_mass > 0.0f) set(p, place(p) + share * place(scratch.gradient[v]));
    }
    volume = volume_now(problem, scratch.gradient);
  }
  return volume;
}

}  // namespace fascicle::muscle
