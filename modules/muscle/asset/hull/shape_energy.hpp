// The energy that keeps a muscle's shape (4.5), on its full mesh. With cotangent weights w_ij, the Laplacian L, masses
// m_i (a third of the area around a vertex) and places V, V_0 at rest:
//
//   sum over edges  w_ij/2 (|e - R_i e_0|^2 + |e - R_j e_0|^2)          edges keep their length, turned
//   + beta sum      m_i |d_i - R_i d_0i|^2,   d_i = (L V)_i / m_i       Laplacian coordinates keep theirs, turned
//
// beta has the unit of an area: bumps wider than its root are held by the edges, narrower ones by the Laplacian. The
// rotations R are those that make the energy least for given places. It is <V, E V> - 2 sum <R_c, S_c> and a constant,
// with E = L + beta L M^-1 L and S_c = V^T B_c a 3 x 3 matrix; vertices that share a rotation add up their S.
//
// Internal to asset/hull: it shows Eigen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Places = Eigen::Matrix<double, Eigen::Dynamic, 3>;

struct ShapeEnergy {
  struct Edge {
    std::uint32_t first = 0, second = 0;
    double weight = 0.0;
  };
  Places rest;                  // m
  std::vector<Edge> edges;
  Eigen::VectorXd mass;         // m^2
  SparseMatrix laplacian;       // L
  Places curvature;             // 1/m: d_0
  double beta = 0.0;            // m^2

  SparseMatrix matrix() const;  // E
  // B of vertices that share rotations: vertices x 3 clusters. `cluster`: by vertex.
  SparseMatrix loads(std::span<const std::uint32_t> cluster, std::uint32_t clusters) const;
};

// `bending`: times the square of a 32nd of the muscle's size it is beta.
ShapeEnergy build_shape_energy(const SurfaceAsset& surface, double bending);

}  // namespace fascicle::muscle
