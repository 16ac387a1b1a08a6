#include "engine/geometry/clean_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/drop_triangles.hpp"
#include "engine/geometry/orient_triangles.hpp"
#include "engine/geometry/self_intersections.hpp"
#include "engine/geometry/weld_vertices.hpp"

namespace fascicle {
namespace {

constexpr double kTolerance = 1e-6;  // of the bounding diagonal
constexpr std::uint32_t kLeftOut = std::numeric_limits<std::uint32_t>::max();

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

class Cleaner {
 public:
  explicit Cleaner(const TriangleMesh& mesh) : input_(mesh) { clean_.mesh.name = mesh.name; }

  CleanMesh clean() {
    take_finite_triangles();
    weld();
    drop_faulty_triangles();
    orient();
    drop_unused_vertices();
    const SelfIntersections found = find_self_intersections(clean_.mesh.positions, clean_.mesh.indices);
    clean_.defects.self_intersections = found.pairs;
    clean_.defects.more_self_intersections = found.more;
    return std::move(clean_);
  }

 private:
  // Positions that triangles use, and the triangles all of whose corners are finite.
  void take_finite_triangles() {
    std::vector<std::uint32_t> at(input_.positions.size(), kLeftOut);
    for (const std::uint32_t v : input_.indices) at[v] = 0;
    for (std::size_t v = 0; v < at.size(); ++v) {
      const bool finite = is_finite(input_.positions[v]), used = at[v] == 0;
      clean_.defects.non_finite_vertices += !finite;
      clean_.defects.unused_vertices += finite && !used;
      at[v] = kLeftOut;
      if (!finite || !used) continue;
      at[v] = static_cast<std::uint32_t>(clean_.mesh.positions.size());
      clean_.mesh.positions.push_back(input_.positions[v]);
    }
    clean_.mesh.indices.reserve(input_.indices.size());
    for (std::uint32_t i = 0; i + 2 < input_.indices.size(); i += 3) {
      const std::array<std::uint32_t, 3> corners = {at[input_.indices[i]], at[input_.indices[i + 1]],
                                                    at[input_.indices[i + 2]]};
      if (std::ranges::find(corners, kLeftOut) != corners.end()) continue;
      clean_.mesh.indices.insert(clean_.mesh.indices.end(), corners.begin(), corners.end());
      clean_.source_triangles.push_back(i / 3);
    }
  }

  void weld() {
    const std::vector<glm::vec3>& positions = clean_.mesh.positions;
    if (positions.empty()) return;
    glm::dvec3 lower(positions[0]), upper(positions[0]);
    for (const glm::vec3& p : positions) {
      lower = glm::min(lower, glm::dvec3(p));
      upper = glm::max(upper, glm::dvec3(p));
    }
    tolerance_ = kTolerance * glm::distance(lower, upper);
    const std::vector<std::uint32_t> stands_for = weld_vertices(positions, tolerance_);
    for (std::uint32_t v = 0; v < positions.size(); ++v) clean_.defects.welded_vertices += stands_for[v] != v;
    for (std::uint32_t& index : clean_.mesh.indices) index = stands_for[index];
  }

  void drop_faulty_triangles() {
    DroppedTriangles dropped =
        drop_triangles(clean_.mesh.positions, tolerance_, clean_.mesh.indices, clean_.source_triangles);
    clean_.defects.degenerate_triangles = dropped.degenerate;
    clean_.defects.duplicate_triangles = dropped.duplicate;
  }

  void orient() {
    MeshDefects& defects = clean_.defects;
    const TriangleSenses senses = orient_triangles(clean_.mesh.positions, clean_.mesh.indices);
    for (std::size_t t = 0; t < senses.turned.size(); ++t) {
      if (senses.turned[t] == 0) continue;
      std::swap(clean_.mesh.indices[3 * t + 1], clean_.mesh.indices[3 * t + 2]);
      ++defects.flipped_triangles;
    }
    if (2 * defects.flipped_triangles > senses.turned.size()) {
      defects.inverted = true;
      defects.flipped_triangles = senses.turned.size() - defects.flipped_triangles;
    }
    defects.components = senses.components;
    defects.open_edges = senses.open_edges;
    defects.holes = senses.holes;
    defects.crowded_edges = senses.crowded_edges;
    defects.twisted_edges = senses.twisted_edges;
  }

  // Those that welding and dropping left without triangles.
  void drop_unused_vertices() {
    std::vector<glm::vec3>& positions = clean_.mesh.positions;
    std::vector<std::uint32_t> at(positions.size(), kLeftOut);
    for (const std::uint32_t v : clean_.mesh.indices) at[v] = 0;
    std::uint32_t count = 0;
    for (std::size_t v = 0; v < positions.size(); ++v) {
      if (at[v] == kLeftOut) continue;
      at[v] = count;
      positions[count++] = positions[v];
    }
    positions.resize(count);
    for (std::uint32_t& index : clean_.mesh.indices) index = at[index];
  }

  const TriangleMesh& input_;
  double tolerance_ = 0.0;  // m
  CleanMesh clean_;
};

}  // namespace

bool MeshDefects::closed() const {
  return components > 0 && open_edges == 0 && crowded_edges == 0 && twisted_edges == 0;
}

bool MeshDefects::sound() const {
  return closed() && !inverted &&
         non_finite_vertices + duplicate_triangles + flipped_triangles + self_intersections == 0;
}

std::string MeshDefects::to_text() const {
  if (sound()) return {};
  std::string text;
  const auto add = [&](std::size_t count, const char* one, const char* several, const std::string& after = {},
                       const char* before = "") {
    if (count == 0) return;
    if (!text.empty()) text += ", ";
    text += fmt::format("{}{} {}{}", before, count, count == 1 ? one : several, after);
  };
  if (components == 0) text = "no triangle with an area";
  add(open_edges, "open edge", "open edges", fmt::format(" round {} hole{}", holes, holes == 1 ? "" : "s"));
  add(crowded_edges, "edge", "edges", " with more than two triangles");
  add(twisted_edges, "edge", "edges", " where the surface has only one side");
  add(self_intersections, "pair of triangles that crosses", "pairs of triangles that cross", " each other",
      more_self_intersections ? "at least " : "");
  if (inverted) text += text.empty() ? "inside out (turned round)" : ", inside out (turned round)";
  add(flipped_triangles, "flipped triangle", "flipped triangles", inverted ? " (kept)" : " (turned round)");
  add(non_finite_vertices, "vertex", "vertices", " without finite coordinates (left out)");
  add(degenerate_triangles, "triangle", "triangles", " without area (left out)");
  add(duplicate_triangles, "triangle", "triangles", " twice (left out)");
  add(welded_vertices, "vertex", "vertices", " at the place of another (welded)");
  return text;
}

CleanMesh clean_mesh(const TriangleMesh& mesh) { return Cleaner(mesh).clean(); }

}  // namespace fascicle
