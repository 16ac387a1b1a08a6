#include "modules/muscle/asset/fibres/spanned_disc.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/mesh_edges.hpp"
#include "modules/muscle/asset/surface/harmonic_field.hpp"

namespace fascicle::muscle {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr double kEdgeShare = 0.02;    // of the edges' squares in the triangulation's cost: short chords if areas tie
constexpr int kRefinements = 2;        // every one makes four triangles of each
constexpr int kMostPasses = 40;        // of turning edges; a few do
constexpr double kTurnFrom = 1.0e-6;   // a sum of cotangents below minus this is an edge to turn
constexpr double kRim = 0.9999;        // the mapped border is a polygon just inside of the circle
constexpr double kOnEdge = -1.0e-9;    // a barycentric coordinate that still counts as inside

double cost_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 u = b - a, v = c - a, w = c - b;
  return 0.5 * glm::length(glm::cross(u, v)) + kEdgeShare * (glm::dot(u, u) + glm::dot(v, v) + glm::dot(w, w));
}

struct RefinedLoop {
  std::vector<glm::dvec3> places;
  std::vector<double> turn;             // by vertex: share of the loop's length; negative: not on the border
  std::vector<Triangle> triangles;
};

std::vector<std::uint32_t> flat(const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) corners.insert(corners.end(), t.begin(), t.end());
  return corners;
}

void refine(RefinedLoop& surface) {
  const std::vector<std::uint32_t> corners = flat(surface.triangles);
  const MeshEdges edges = find_edges(corners, surface.places.size());
  std::vector<std::uint32_t> middle(corners.size());  // by side
  for (std::size_t e = 0; e < edges.count(); ++e) {
    const std::span<const std::uint32_t> sides = edges.sides_of(e);
    const std::uint32_t a = corners[sides[0]], b = corners[next_side(sides[0])];
    for (const std::uint32_t side : sides) middle[side] = static_cast<std::uint32_t>(surface.places.size());
    surface.places.push_back(0.5 * (surface.places[a] + surface.places[b]));
    double turn = -1.0;
    if (sides.size() == 1) {
      turn = 0.5 * (surface.turn[a] + surface.turn[b]);
      if (std::abs(surface.turn[a] - surface.turn[b]) > 0.5) turn += turn < 0.5 ? 0.5 : -0.5;  // across the start
    }
    surface.turn.push_back(turn);
  }
  std::vector<Triangle> finer;
  finer.reserve(4 * surface.triangles.size());
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.triangles[t];
    const std::uint32_t ab = middle[3 * t], bc = middle[3 * t + 1], ca = middle[3 * t + 2];
    finer.insert(finer.end(), {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}});
  }
  surface.triangles = std::move(finer);
}

double cotangent(const glm::dvec3& tip, const glm::dvec3& a, const glm::dvec3& b) {
  const double across = glm::length(glm::cross(a - tip, b - tip));
  return across > 0.0 ? glm::dot(a - tip, b - tip) / across : 0.0;
}

// Turns edges whose opposite angles sum to more than pi until none is left (Lawson): the slivers that a triangulation
// without inner points has would bend the map by a tenth of its radius.
void turn_edges(RefinedLoop& surface) {
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const std::vector<std::uint32_t> corners = flat(surface.triangles);
    const MeshEdges edges = find_edges(corners, surface.places.size());
    std::vector<bool> turned(surface.triangles.size(), false);
    bool any = false;
    for (std::size_t e = 0; e < edges.count(); ++e) {
      const std::span<const std::uint32_t> sides = edges.sides_of(e);
      if (sides.size() != 2 || turned[sides[0] / 3] || turned[sides[1] / 3]) continue;
      const std::uint32_t a = corners[sides[0]], b = corners[next_side(sides[0])];
      const std::uint32_t c = corners[next_side(next_side(sides[0]))], d = corners[next_side(next_side(sides[1]))];
      const std::vector<glm::dvec3>& p = surface.places;
      if (c == d || !(cotangent(p[c], p[a], p[b]) + cotangent(p[d], p[a], p[b]) < -kTurnFrom)) continue;
      surface.triangles[sides[0] / 3] = {a, d, c};
      surface.triangles[sides[1] / 3] = {d, b, c};
      turned[sides[0] / 3] = turned[sides[1] / 3] = any = true;
    }
    if (!any) return;
  }
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

}  // namespace

std::vector<Triangle> triangulate_loop(std::span<const glm::dvec3> loop) {
  const std::size_t n = loop.size();
  if (n < 3) return {};
  // The cheapest way to fill the part of the loop from i to j, closed by the chord from j to i.
  std::vector<double> cost(n * n, 0.0);
  std::vector<std::uint32_t> apex(n * n, 0);
  for (std::size_t width = 2; width < n; ++width) {
    for (std::size_t i = 0; i + width < n; ++i) {
      const std::size_t j = i + width;
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t k = i + 1; k < j; ++k) {
        const double sum = cost[i * n + k] + cost[k * n + j] + cost_of(loop[i], loop[k], loop[j]);
        if (sum < best) {
          best = sum;
          apex[i * n + j] = static_cast<std::uint32_t>(k);
        }
      }
      cost[i * n + j] = best;
    }
  }
  std::vector<Triangle> triangles;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0, static_cast<std::uint32_t>(n - 1)}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i < 2) continue;
    const std::uint32_t k = std::clamp(apex[i * n + j], i + 1, j - 1);
    triangles.push_back({i, k, j});
    open.emplace_back(i, k);
    open.emplace_back(k, j);
  }
  return triangles;
}

std::optional<SpannedDisc> SpannedDisc::span(std::span<const glm::dvec3> loop) {
  if (loop.size() < 3) return std::nullopt;
  RefinedLoop surface;
  surface.places.assign(loop.begin(), loop.end());
  surface.triangles = triangulate_loop(loop);
  for (std::size_t i = 0; i < loop.size(); ++i)
    surface.turn.push_back(static_cast<double>(i) / static_cast<double>(loop.size()));
  for (int i = 0; i < kRefinements; ++i) refine(surface);
  turn_edges(surface);

  const std::size_t count = surface.places.size();
  std::vector<glm::vec3> positions(count);
  std::vector<std::uint8_t> fixed(count, 0);
  std::vector<float> values(2 * count, 0.0f);
  for (std::size_t v = 0; v < count; ++v) {
    positions[v] = glm::vec3(surface.places[v] - surface.places[0]);
    if (surface.turn[v] < 0.0) continue;
    const double angle = 2.0 * std::numbers::pi * surface.turn[v];
    fixed[v] = 1;
    values[v] = static_cast<float>(std::cos(angle));
    values[count + v] = static_cast<float>(std::sin(angle));
  }
  const Result<std::vector<float>> field = solve_harmonic(positions, flat(surface.triangles), fixed, values);
  if (!field) return std::nullopt;
  SpannedDisc disc;
  disc.places_ = std::move(surface.places);
  disc.triangles_ = std::move(surface.triangles);
  disc.disc_.resize(count);
  for (std::size_t v = 0; v < count; ++v) disc.disc_[v] = glm::dvec2((*field)[v], (*field)[count + v]);
  disc.fill_cells();
  return disc;
}

void SpannedDisc::fill_cells() {
  const auto cell = [](double x) { return std::clamp(static_cast<int>((x + 1.0) * 0.5 * kCells), 0, kCells - 1); };
  const auto each_cell = [&](std::size_t t, const auto& f) {
    const auto [a, b, c] = triangles_[t];
    const glm::dvec2 lower = glm::min(disc_[a], glm::min(disc_[b], disc_[c]));
    const glm::dvec2 upper = glm::max(disc_[a], glm::max(disc_[b], disc_[c]));
    for (int y = cell(lower.y); y <= cell(upper.y); ++y)
      for (int x = cell(lower.x); x <= cell(upper.x); ++x) f(static_cast<std::size_t>(y * kCells + x));
  };
  first_in_cell_.assign(static_cast<std::size_t>(kCells * kCells) + 1, 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t) each_cell(t, [&](std::size_t i) { ++first_in_cell_[i + 1]; });
  for (std::size_t i = 1; i < first_in_cell_.size(); ++i) first_in_cell_[i] += first_in_cell_[i - 1];
  std::vector<std::uint32_t> next = first_in_cell_;
  in_cell_.resize(first_in_cell_.back());
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    each_cell(t, [&](std::size_t i) { in_cell_[next[i]++] = static_cast<std::uint32_t>(t); });
}

glm::dvec3 SpannedDisc::at(const glm::dvec2& point) const {
  const double radius = glm::length(point);
  const glm::dvec2 p = radius > kRim ? point * (kRim / radius) : point;
  const auto cell = [](double x) { return std::clamp(static_cast<int>((x + 1.0) * 0.5 * kCells), 0, kCells - 1); };
  const auto i = static_cast<std::size_t>(cell(p.y) * kCells + cell(p.x));
  // Of the triangles about the point the one that it is deepest in; rounding may leave it in none.
  glm::dvec3 best(1.0, 0.0, 0.0);
  double depth = -std::numeric_limits<double>::infinity();
  std::uint32_t found = 0;
  for (std::uint32_t k = first_in_cell_[i]; k < first_in_cell_[i + 1]; ++k) {
    const auto [a, b, c] = triangles_[in_cell_[k]];
    const glm::dvec2 u = disc_[b] - disc_[a], v = disc_[c] - disc_[a];
    const double area = cross(u, v);
    if (area == 0.0) continue;
    const double s = cross(p - disc_[a], v) / area, t = cross(u, p - disc_[a]) / area;
    const double least = std::min({1.0 - s - t, s, t});
    if (!(least > depth)) continue;
    depth = least;
    best = {1.0 - s - t, s, t};
    found = in_cell_[k];
    if (depth >= kOnEdge) break;
  }
  best = glm::max(best, glm::dvec3(0.0));
  best /= best.x + best.y + best.z;
  const auto [a, b, c] = triangles_[found];
  return best.x * places_[a] + best.y * places_[b] + best.z * places_[c];
}

}  // namespace fascicle::muscle
