#include "modules/muscle/asset/hull/shape_energy.hpp"

#include <algorithm>
#include <array>

#include <Eigen/Geometry>

namespace fascicle::muscle {
namespace {

constexpr double kBendingLength = 1.0 / 32.0;  // of the muscle's size
constexpr double kLeastWeight = 1.0e-3;        // obtuse angles give negative ones, which would let edges grow
constexpr double kMostCotangent = 10.0;        // slivers
constexpr double kLeastMass = 0.1;             // of the mean one

using Triplets = std::vector<Eigen::Triplet<double>>;

SparseMatrix assemble(Eigen::Index rows, Eigen::Index columns, const Triplets& entries) {
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

double cotangent(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double area = a.cross(b).norm();
  return area > 0.0 ? std::clamp(a.dot(b) / area, 0.0, kMostCotangent) : kMostCotangent;
}

// Every edge once: those of a closed mesh have two triangles, which add up.
std::vector<ShapeEnergy::Edge> weigh_edges(const SurfaceAsset& surface, const Places& rest, Eigen::VectorXd& mass) {
  std::vector<ShapeEnergy::Edge> sides;
  for (std::size_t t = 0; t < surface.triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = surface.triangles[t + k], b = surface.triangles[t + (k + 1) % 3],
                          c = surface.triangles[t + (k + 2) % 3];
      const Eigen::Vector3d to_a = (rest.row(a) - rest.row(c)).transpose(), to_b = (rest.row(b) - rest.row(c)).transpose();
      sides.push_back({std::min(a, b), std::max(a, b), 0.5 * cotangent(to_a, to_b)});
      mass[c] += to_a.cross(to_b).norm() / 6.0;
    }
  }
  std::ranges::sort(sides, [](const auto& a, const auto& b) {
    return std::array{a.first, a.second} < std::array{b.first, b.second};
  });
  std::vector<ShapeEnergy::Edge> edges;
  for (const ShapeEnergy::Edge& side : sides) {
    if (!edges.empty() && edges.back().first == side.first && edges.back().second == side.second) {
      edges.back().weight += side.weight;
    } else {
      edges.push_back(side);
    }
  }
  for (ShapeEnergy::Edge& edge : edges) edge.weight = std::max(edge.weight, kLeastWeight);
  return edges;
}

}  // namespace

SparseMatrix ShapeEnergy::matrix() const {
  const SparseMatrix scaled = mass.cwiseInverse().asDiagonal() * laplacian;
  return laplacian + beta * SparseMatrix(laplacian * scaled);
}

SparseMatrix ShapeEnergy::loads(std::span<const std::uint32_t> cluster, std::uint32_t clusters) const {
  Triplets entries;
  for (const Edge& edge : edges) {
    const Eigen::RowVector3d half = 0.5 * edge.weight * (rest.row(edge.first) - rest.row(edge.second));
    for (const std::uint32_t owner : {cluster[edge.first], cluster[edge.second]}) {
      for (int k = 0; k < 3; ++k) {
        entries.emplace_back(edge.first, 3 * owner + static_cast<std::uint32_t>(k), half[k]);
        entries.emplace_back(edge.second, 3 * owner + static_cast<std::uint32_t>(k), -half[k]);
      }
    }
  }
  for (Eigen::Index v = 0; v < laplacian.outerSize(); ++v) {
    const std::uint32_t owner = cluster[static_cast<std::size_t>(v)];
    for (SparseMatrix::InnerIterator entry(laplacian, v); entry; ++entry) {
      for (int k = 0; k < 3; ++k) {
        entries.emplace_back(entry.row(), 3 * owner + static_cast<std::uint32_t>(k), beta * entry.value() * curvature(v, k));
      }
    }
  }
  return assemble(rest.rows(), 3 * static_cast<Eigen::Index>(clusters), entries);
}

ShapeEnergy build_shape_energy(const SurfaceAsset& surface, double bending) {
  const Eigen::Index count = surface.vertex_count;
  ShapeEnergy energy;
  energy.rest.resize(count, 3);
  for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
    const SurfacePoint& p = surface.rest[v];
    energy.rest.row(v) << static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z);
  }
  energy.mass = Eigen::VectorXd::Zero(count);
  energy.edges = weigh_edges(surface, energy.rest, energy.mass);
  energy.mass = energy.mass.cwiseMax(kLeastMass * energy.mass.mean());
  Triplets entries;
  for (const ShapeEnergy::Edge& edge : energy.edges) {
    entries.emplace_back(edge.first, edge.second, -edge.weight);
    entries.emplace_back(edge.second, edge.first, -edge.weight);
    entries.emplace_back(edge.first, edge.first, edge.weight);
    entries.emplace_back(edge.second, edge.second, edge.weight);
  }
  energy.laplacian = assemble(count, count, entries);
  energy.curvature = energy.mass.cwiseInverse().asDiagonal() * Places(energy.laplacian * energy.rest);
  const double length = kBendingLength * static_cast<double>(surface.size);
  energy.beta = bending * length * length;
  return energy;
}

}  // namespace fascicle::muscle
