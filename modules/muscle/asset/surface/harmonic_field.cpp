#include "modules/muscle/asset/surface/harmonic_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#define EIGEN_MPL2_ONLY
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "engine/geometry/finite.hpp"
#include "engine/geometry/mesh_edges.hpp"

namespace fascicle::muscle {
namespace {

constexpr double kMostCotangent = 1.0e3;   // of an angle of a milliradian: what has no area weighs no more than that
constexpr double kLeastShare = 1.0e-3;     // of the mean weight
constexpr std::uint32_t kFixed = std::numeric_limits<std::uint32_t>::max();

struct Edge {
  std::uint32_t a = 0, b = 0;
  double weight = 0.0;
};

Diagnostic error(std::string cause, std::string remedy) {
  return {"", 0, 0, "harmonic field", std::move(cause), std::move(remedy)};
}

// Of the angle at `tip`; zero where the triangle has no area and no direction.
double cotangent(const glm::dvec3& tip, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 u = a - tip, v = b - tip;
  const double along = glm::dot(u, v), across = glm::length(glm::cross(u, v));
  if (across * kMostCotangent > std::abs(along)) return along / across;
  return along > 0.0 ? kMostCotangent : along < 0.0 ? -kMostCotangent : 0.0;
}

// Every edge once, with half the sum of the opposite angles' cotangents, but never less than the least share.
std::vector<Edge> weigh_edges(std::span<const glm::vec3> positions, std::span<const std::uint32_t> triangles) {
  std::vector<std::uint32_t> corners;  // of triangles with three corners: others join nothing that their edge does not
  corners.reserve(triangles.size());
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const std::uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
    if (a != b && b != c && c != a) corners.insert(corners.end(), {a, b, c});
  }
  const MeshEdges edges = find_edges(corners, positions.size());
  std::vector<Edge> weighed(edges.count());
  double sum = 0.0;
  for (std::size_t e = 0; e < weighed.size(); ++e) {
    Edge& edge = weighed[e];
    for (const std::uint32_t side : edges.sides_of(e)) {
      const std::uint32_t end = next_side(side);
      edge.a = corners[side];
      edge.b = corners[end];
      edge.weight += 0.5 * cotangent(glm::dvec3(positions[corners[next_side(end)]]), glm::dvec3(positions[edge.a]),
                                     glm::dvec3(positions[edge.b]));
    }
    sum += std::max(edge.weight, 0.0);
  }
  const double mean = weighed.empty() ? 0.0 : sum / static_cast<double>(weighed.size());
  const double least = mean > 0.0 ? kLeastShare * mean : 1.0;
  for (Edge& edge : weighed) edge.weight = std::max(edge.weight, least);
  return weighed;
}

// A free vertex that the edges do not join to a fixed one; the vertices' number if there is none.
std::size_t find_stranded(std::size_t vertex_count, const std::vector<Edge>& edges,
                          std::span<const std::uint8_t> fixed) {
  std::vector<std::uint32_t> root(vertex_count);
  for (std::uint32_t v = 0; v < vertex_count; ++v) root[v] = v;
  const auto find = [&](std::uint32_t v) {
    for (; root[v] != v; v = root[v]) root[v] = root[root[v]];
    return v;
  };
  for (const Edge& edge : edges) {
    const std::uint32_t a = find(edge.a), b = find(edge.b);
    root[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::uint8_t> held(vertex_count, 0);
  for (std::uint32_t v = 0; v < vertex_count; ++v)
    if (fixed[v]) held[find(v)] = 1;
  for (std::uint32_t v = 0; v < vertex_count; ++v)
    if (!held[find(v)]) return v;
  return vertex_count;
}

Diagnostics check_input(std::span<const glm::vec3> positions, std::span<const std::uint32_t> triangles,
                        std::span<const std::uint8_t> fixed, std::span<const float> values) {
  const std::size_t count = positions.size();
  Diagnostics faults;
  const auto add = [&](std::string cause, std::string remedy) {
    faults.errors.push_back(error(std::move(cause), std::move(remedy)));
  };
  if (fixed.size() != count || values.empty() || count == 0 || values.size() % count != 0) {
    add(fmt::format("{} vertices, {} marks and {} values", count, fixed.size(), values.size()),
        "give every vertex a mark and every field a value per vertex");
    return faults;
  }
  if (triangles.size() % 3 != 0 || std::ranges::any_of(triangles, [&](std::uint32_t v) { return v >= count; })) {
    add(fmt::format("a triangle has a corner that is none of the {} vertices", count), "give three corners a triangle");
    return faults;
  }
  for (std::size_t v = 0; v < count; ++v) {
    if (is_finite(positions[v])) continue;
    add(fmt::format("vertex {} is at no finite place", v), "leave it out");
    break;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!fixed[i % count] || std::isfinite(values[i])) continue;
    add(fmt::format("the value given at vertex {} is not finite", i % count), "give a number");
    break;
  }
  if (std::ranges::none_of(fixed, [](std::uint8_t mark) { return mark != 0; }))
    add("the field is given at no vertex", "fix at least one vertex of every piece");
  return faults;
}

}  // namespace

Result<std::vector<float>> solve_harmonic(std::span<const glm::vec3> positions,
                                          std::span<const std::uint32_t> triangles,
                                          std::span<const std::uint8_t> fixed, std::span<const float> values) {
  if (Diagnostics faults = check_input(positions, triangles, fixed, values); !faults.ok()) return faults;
  const std::size_t count = positions.size();
  const std::vector<Edge> edges = weigh_edges(positions, triangles);
  if (const std::size_t v = find_stranded(count, edges, fixed); v < count)
    return error(fmt::format("no path of edges joins vertex {} to one where the field is given", v),
                 "leave out what hangs on nothing, or fix a vertex of it");

  std::vector<std::uint32_t> row(count, kFixed);
  std::uint32_t rows = 0;
  for (std::size_t v = 0; v < count; ++v)
    if (!fixed[v]) row[v] = rows++;
  std::vector<float> field(values.begin(), values.end());
  if (rows == 0) return field;

  const auto fields = static_cast<Eigen::Index>(values.size() / count);
  std::vector<double> diagonal(rows, 0.0);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(rows + edges.size());
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(rows, fields);
  for (const Edge& edge : edges) {
    for (const auto& [from, to] : std::array{std::pair{edge.a, edge.b}, std::pair{edge.b, edge.a}}) {
      if (row[from] == kFixed) continue;
      diagonal[row[from]] += edge.weight;
      if (row[to] == kFixed) {
        for (Eigen::Index k = 0; k < fields; ++k)
          right(row[from], k) += edge.weight * static_cast<double>(values[static_cast<std::size_t>(k) * count + to]);
      } else if (row[from] > row[to]) {
        entries.emplace_back(row[from], row[to], -edge.weight);  // the lower half is all that the solver reads
      }
    }
  }
  for (std::uint32_t r = 0; r < rows; ++r) entries.emplace_back(r, r, diagonal[r]);
  Eigen::SparseMatrix<double> laplacian(rows, rows);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(laplacian);
  if (solver.info() != Eigen::Success)
    return error("the Laplacian could not be factorised", "mend the mesh's triangles without area");
  const Eigen::MatrixXd solution = solver.solve(right);
  if (!solution.allFinite()) return error("the field is not finite", "mend the mesh's triangles without area");

  for (std::size_t k = 0; k < static_cast<std::size_t>(fields); ++k) {
    const std::span<float> one = std::span(field).subspan(k * count, count);
    float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();
    for (std::size_t v = 0; v < count; ++v) {
      if (!fixed[v]) continue;
      least = std::min(least, one[v]);
      most = std::max(most, one[v]);
    }
    for (std::size_t v = 0; v < count; ++v) {
      if (fixed[v]) continue;
      const double exact = solution(row[v], static_cast<Eigen::Index>(k));
      one[v] = std::clamp(static_cast<float>(exact), least, most);  // rounding alone passes the given values
    }
  }
  return field;
}

}  // namespace fascicle::muscle
