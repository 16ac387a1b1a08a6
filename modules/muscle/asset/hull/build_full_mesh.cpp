#include "modules/muscle/asset/hull/build_full_mesh.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>

#include "modules/muscle/kernels/hull/mesh_volume.hpp"
#include "modules/muscle/kernels/hull/vertex_curvature.hpp"

namespace fascicle::muscle {
namespace {

// Of the muscle's size: what is wider than this stays as the hull has made it, what is narrower is refined.
constexpr double kAnchorLength = 1.0 / 40.0;
constexpr std::uint32_t kBesideSteps = 6;  // edges from an attached vertex

void list_neighbours(const ShapeEnergy& energy, std::uint32_t vertices, HullFullMesh& full) {
  full.first.assign(vertices + 1, 0);
  for (const ShapeEnergy::Edge& edge : energy.edges) {
    ++full.first[edge.first + 1];
    ++full.first[edge.second + 1];
  }
  for (std::uint32_t v = 0; v < vertices; ++v) full.first[v + 1] += full.first[v];
  full.neighbour.resize(full.first.back());
  full.weight.resize(full.first.back());
  std::vector<std::uint32_t> next(full.first.begin(), full.first.end() - 1);
  for (const ShapeEnergy::Edge& edge : energy.edges) {
    full.neighbour[next[edge.first]] = edge.second;
    full.weight[next[edge.first]++] = static_cast<float>(edge.weight);
    full.neighbour[next[edge.second]] = edge.first;
    full.weight[next[edge.second]++] = static_cast<float>(edge.weight);
  }
}

std::vector<std::uint32_t> find_beside(const SurfaceAsset& surface, const HullFullMesh& full) {
  std::vector<std::uint8_t> seen(surface.vertex_count, 0);
  std::vector<std::uint32_t> front, beside;
  for (const AttachedVertex& attached : surface.attached) {
    seen[attached.vertex] = 1;
    front.push_back(attached.vertex);
  }
  for (std::uint32_t step = 0; step < kBesideSteps; ++step) {
    std::vector<std::uint32_t> next;
    for (const std::uint32_t v : front) {
      for (std::uint32_t i = full.first[v]; i < full.first[v + 1]; ++i) {
        if (seen[full.neighbour[i]] != 0) continue;
        seen[full.neighbour[i]] = 1;
        next.push_back(full.neighbour[i]);
      }
    }
    beside.insert(beside.end(), next.begin(), next.end());
    front = std::move(next);
  }
  std::ranges::sort(beside);
  return beside;
}

SparseFactor to_factor(const Eigen::SimplicialLLT<SparseMatrix>& solver, std::span<const std::uint32_t> free) {
  const SparseMatrix lower = solver.matrixL();
  SparseFactor factor;
  factor.size = static_cast<std::uint32_t>(lower.cols());
  factor.first.push_back(0);
  for (Eigen::Index column = 0; column < lower.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry(lower, column); entry; ++entry) {
      const bool diagonal = entry.row() == column;
      factor.row.push_back(static_cast<std::uint32_t>(entry.row()));
      factor.value.push_back(static_cast<float>(diagonal ? 1.0 / entry.value() : entry.value()));
    }
    factor.first.push_back(static_cast<std::uint32_t>(factor.row.size()));
  }
  factor.order.resize(factor.size);
  for (std::uint32_t i = 0; i < factor.size; ++i) {
    factor.order[static_cast<std::size_t>(solver.permutationP().indices()[i])] = free[i];
  }
  return factor;
}

}  // namespace

bool build_full_mesh(const SurfaceAsset& surface, const ShapeEnergy& energy, HullFullMesh& full) {
  list_neighbours(energy, surface.vertex_count, full);
  full.volume = measure_volume(surface.triangles, std::span(surface.rest).first(surface.vertex_count), {});
  full.beside = find_beside(surface, full);
  full.bending = static_cast<float>(energy.beta);
  const double length = kAnchorLength * static_cast<double>(surface.size), anchor = 1.0 / (length * length);
  full.anchor = static_cast<float>(anchor);
  for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
    const auto inverse_mass = static_cast<float>(1.0 / energy.mass[v]);
    const glm::vec3 curvature = vertex_curvature(full, surface.rest, v, inverse_mass);
    full.curvature.push_back({curvature.x, curvature.y, curvature.z, inverse_mass});
  }

  constexpr std::uint32_t kHeld = 0xffffffffu;
  std::vector<std::uint32_t> place(surface.vertex_count, 0), free;
  for (const AttachedVertex& attached : surface.attached) place[attached.vertex] = kHeld;
  for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
    if (place[v] == kHeld) continue;
    place[v] = static_cast<std::uint32_t>(free.size());
    free.push_back(v);
  }
  const SparseMatrix matrix = energy.matrix();
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index column = 0; column < matrix.outerSize(); ++column) {
    const std::uint32_t c = place[static_cast<std::size_t>(column)];
    if (c == kHeld) continue;
    entries.emplace_back(c, c, anchor * energy.mass[column]);
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry) {
      const std::uint32_t r = place[static_cast<std::size_t>(entry.row())];
      if (r != kHeld) entries.emplace_back(r, c, entry.value());
    }
  }
  SparseMatrix freed(static_cast<Eigen::Index>(free.size()), static_cast<Eigen::Index>(free.size()));
  freed.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLLT<SparseMatrix> solver(freed);
  if (solver.info() != Eigen::Success) return false;
  full.factor = to_factor(solver, free);
  return true;
}

}  // namespace fascicle::muscle
