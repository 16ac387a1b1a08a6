#include "modules/muscle/asset/hull/reduce_hull.hpp"

#include <algorithm>
#include <array>

#include <Eigen/Cholesky>
#include <glm/geometric.hpp>

#include "modules/muscle/asset/hull/direction_parts.hpp"
#include "modules/muscle/kernels/hull/line_place.hpp"

namespace fascicle::muscle {
namespace {

using Matrix = Eigen::MatrixXd;

// Beside cotangent weights of about 1: attached vertices are to stand where they belong as far as the hull can do it.
constexpr double kAttachmentWeight = 100.0;
constexpr double kRidge = 1.0e-9;  // of A's mean diagonal

// The full mesh's vertices by the hull vertex that has the most weight for them.
std::vector<std::uint32_t> cluster_vertices(const Matrix& weights) {
  std::vector<std::uint32_t> cluster(static_cast<std::size_t>(weights.rows()));
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    Eigen::Index best = 0;
    weights.row(v).maxCoeff(&best);
    cluster[static_cast<std::size_t>(v)] = static_cast<std::uint32_t>(best);
  }
  return cluster;
}

// Rows of a matrix by vertex.
Matrix rows_of(const Matrix& weights, std::span<const std::uint32_t> vertices) {
  Matrix rows(static_cast<Eigen::Index>(vertices.size()), weights.cols());
  for (std::size_t i = 0; i < vertices.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = weights.row(vertices[i]);
  return rows;
}

// S at rest by cluster, symmetric to the bit: a muscle at rest turns nothing.
std::vector<MatrixPack> pack_rest(const Matrix& loads, std::uint32_t clusters) {
  std::vector<MatrixPack> packs(clusters / kPanelRows);
  for (MatrixPack& pack : packs) pack = {};
  for (std::uint32_t c = 0; c < clusters; ++c) {
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = 0; column < 3; ++column) {
        const Eigen::Index first = 3 * static_cast<Eigen::Index>(c);
        const double mean = 0.5 * (loads(first + column, row) + loads(first + row, column));
        packs[c / kPanelRows].value[static_cast<std::size_t>(3 * row + column)][c % kPanelRows] = static_cast<float>(mean);
      }
    }
  }
  return packs;
}

// How much of each carrier a cluster goes with: the mean of its vertices, the four greatest.
std::vector<CarryWeights> carry_clusters(const SurfaceAsset& surface, std::span<const std::uint32_t> cluster,
                                         std::uint32_t clusters) {
  if (surface.carry.empty()) return {};
  Matrix sums = Matrix::Zero(clusters, static_cast<Eigen::Index>(surface.carriers.size()));
  for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
    for (std::size_t k = 0; k < 4; ++k) {
      sums(cluster[v], surface.carry[v].carrier[k]) += static_cast<double>(surface.carry[v].weight[k]);
    }
  }
  std::vector<CarryWeights> carry(clusters);
  for (std::uint32_t c = 0; c < clusters; ++c) {
    double total = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      Eigen::Index best = 0;
      const double share = sums.row(c).maxCoeff(&best);
      if (!(share > 0.0)) break;
      carry[c].carrier[k] = static_cast<std::uint16_t>(best);
      carry[c].weight[k] = static_cast<float>(share);
      total += share;
      sums(c, best) = 0.0;
    }
    for (float& weight : carry[c].weight) weight = total > 0.0 ? static_cast<float>(static_cast<double>(weight) / total) : 0.0f;
  }
  return carry;
}

void copy_rows(const Matrix& matrix, AlignedVector<float>& rows) {
  rows.resize(static_cast<std::size_t>(matrix.size()));
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) {
      rows[static_cast<std::size_t>(r * matrix.cols() + c)] = static_cast<float>(matrix(r, c));
    }
  }
}

}  // namespace

DenseRows to_dense_rows(const Matrix& matrix) {
  DenseRows rows = make_dense_rows(static_cast<std::uint32_t>(matrix.rows()), static_cast<std::uint32_t>(matrix.cols()));
  for (std::uint32_t c = 0; c < rows.columns; ++c) {
    for (std::uint32_t r = 0; r < rows.rows; ++r) rows.values[rows.index(r, c)] = static_cast<float>(matrix(r, c));
  }
  return rows;
}

bool reduce_to_hull(const SurfaceAsset& surface, const ShapeEnergy& energy, const Matrix& weights, HullAsset& asset) {
  const auto hull = static_cast<std::uint32_t>(weights.cols());
  const std::vector<std::uint32_t> cluster = cluster_vertices(weights);
  HullShape& shape = asset.shape;
  shape.clusters = (hull + kPanelRows - 1) / kPanelRows * kPanelRows;
  shape.carry = carry_clusters(surface, cluster, shape.clusters);
  shape.cluster = cluster;

  // A: the shape, then what holds the hull where it belongs. W^T L M^-1 L W as a square, so half of it does.
  const Matrix applied = energy.laplacian * weights;
  const Matrix scaled = (energy.beta * energy.mass.cwiseInverse()).cwiseSqrt().asDiagonal() * applied;
  Matrix a = weights.transpose() * applied;
  a.selfadjointView<Eigen::Lower>().rankUpdate(scaled.transpose());
  a.triangularView<Eigen::StrictlyUpper>() = a.transpose();

  for (std::size_t i = 0; i < surface.attachments.size(); ++i) {
    std::vector<std::uint32_t> vertices;
    for (const AttachedVertex& attached : surface.attached) {
      if (attached.attachment == i) vertices.push_back(attached.vertex);
    }
    const Matrix rows = rows_of(weights, vertices);
    Matrix places = Matrix::Ones(rows.rows(), 4);
    places.leftCols<3>() = rows_of(energy.rest, vertices);
    a += kAttachmentWeight * rows.transpose() * rows;
    asset.attachments.push_back({to_dense_rows(kAttachmentWeight * rows.transpose() * places)});
  }

  const DirectionParts parts = find_direction_parts(surface, asset.line);
  if (parts.differences.rows() > 0) {
    const Matrix rows = parts.differences * weights;
    const double weight = static_cast<double>(asset.settings.direction) * static_cast<double>(parts.along.size());
    a += weight * rows.transpose() * rows;
    asset.direction.load = to_dense_rows(weight * rows.transpose());
    asset.direction.along = parts.along;
    const Places rest = parts.differences * energy.rest;
    std::vector<glm::vec3> line;
    for (const HullLinePoint& point : asset.line) line.push_back(point.rest);
    for (Eigen::Index i = 0; i < rest.rows(); ++i) {
      const auto part = static_cast<std::size_t>(i);
      asset.direction.line.push_back(place_along(line, parts.along[part + 1]) - place_along(line, parts.along[part]));
      asset.direction.rest.emplace_back(static_cast<float>(rest(i, 0)), static_cast<float>(rest(i, 1)),
                                        static_cast<float>(rest(i, 2)));
    }
  }

  a.diagonal().array() += kRidge * a.diagonal().mean();
  const Eigen::LLT<Matrix> factor(a);
  if (factor.info() != Eigen::Success) return false;
  const Matrix inverse = factor.solve(Matrix::Identity(hull, hull));
  if (!inverse.allFinite()) return false;
  shape.stiffness = to_dense_rows(a);
  shape.inverse = to_dense_rows(0.5 * (inverse + inverse.transpose()));

  const SparseMatrix loads = energy.loads(cluster, shape.clusters);
  const Matrix spread = loads.transpose() * weights;
  shape.spread = to_dense_rows(spread);
  shape.gather = to_dense_rows(spread.transpose());
  shape.rest = pack_rest(loads.transpose() * energy.rest, shape.clusters);

  HullSamples& samples = asset.samples;
  const Matrix sampled = rows_of(weights, samples.vertices);
  samples.weights = to_dense_rows(sampled);
  samples.gather = to_dense_rows(sampled.transpose());
  copy_rows(sampled, samples.rows);
  copy_rows(sampled * inverse, samples.solutions);
  for (const std::uint32_t vertex : samples.vertices) samples.cluster.push_back(cluster[vertex]);
  return true;
}

}  // namespace fascicle::muscle
