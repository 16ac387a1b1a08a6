#include "tools/fascicle_cook/hull_report.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/mesh_distance.hpp"
#include "engine/geometry/mesh_edges.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/self_intersections.hpp"
#include "engine/geometry/winding_number.hpp"

namespace fascicle::cook {
namespace {

constexpr double kEnclosed = 1.0e-6;  // of the size
constexpr double kSamples = 300.0;    // along the mesh's diagonal

bool is_closed(const TriangleMesh& mesh) {
  const MeshEdges edges = find_edges(mesh.indices, mesh.positions.size());
  for (std::size_t e = 0; e < edges.count(); ++e) {
    const auto sides = edges.sides_of(e);
    if (sides.size() != 2 || mesh.indices[sides[0]] == mesh.indices[sides[1]]) return false;
  }
  return edges.count() > 0;
}

double find_outside(const TriangleMesh& fine, const TriangleMesh& hull) {
  const ClosestPoints surface(hull);
  const WindingField windings(hull);
  double furthest = 0.0;
  for (const glm::vec3& position : fine.positions) {
    const double distance = static_cast<double>(surface.at(position).distance);
    if (distance > furthest && !windings.inside(glm::dvec3(position))) furthest = distance;
  }
  return furthest;
}

}  // namespace

bool MeasuredHull::sound() const { return closed && outside <= kEnclosed * size; }

Result<MeasuredHull> measure_hull(const std::string& muscle, const TriangleMesh& fine, const muscle::HullTarget& target) {
  MeasuredHull measured;
  measured.muscle = muscle;
  measured.fine = &fine;
  measured.target = target;
  const auto start = std::chrono::steady_clock::now();
  auto hull = muscle::build_progressive_hull(fine, target);
  measured.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  const auto place = [&](Diagnostic& one) { one.cause = fmt::format("{}: {}", muscle, one.cause); };
  std::ranges::for_each(hull.diagnostics().errors, place);
  std::ranges::for_each(hull.diagnostics().warnings, place);
  if (!hull) return hull.diagnostics();
  Diagnostics diagnostics = std::move(hull.diagnostics());
  measured.hull = std::move(*hull);
  const TriangleMesh& mesh = measured.hull.mesh;
  measured.size = static_cast<double>(mesh_bounds(fine).diagonal());
  measured.outside = find_outside(fine, mesh);
  const SurfaceDistance away = measure_distance(mesh, ClosestPoints(fine), measured.size / kSamples);
  measured.furthest = away.max;
  measured.mean = away.mean;
  measured.closed = is_closed(mesh);
  measured.crossings = find_self_intersections(mesh.positions, mesh.indices).pairs;
  measured.fine_crossings = find_self_intersections(fine.positions, fine.indices).pairs;
  return Result<MeasuredHull>(std::move(measured), std::move(diagnostics));
}

std::string to_table(std::span<const MeasuredHull> hulls) {
  std::size_t width = 6;
  for (const MeasuredHull& one : hulls) width = std::max(width, one.muscle.size());
  std::string text = fmt::format("{:{}}  {:>8} {:>9} {:>10} {:>11} {:>9} {:>11} {:>8} {:>9} {:>6}\n", "muscle", width,
                                 "vertices", "triangles", "overhead %", "outside mm", "of size", "furthest mm", "mean mm",
                                 "crossings", "ms");
  for (const MeasuredHull& one : hulls) {
    const TriangleMesh& mesh = one.hull.mesh;
    fmt::format_to(std::back_inserter(text), "{:{}}  {:>8} {:>9} {:>10.2f} {:>11.2g} {:>9.1e} {:>11.2f} {:>8.3f} {:>9} {:>6.0f}{}{}\n",
                   one.muscle, width, mesh.positions.size(), mesh.indices.size() / 3, 100.0 * one.hull.overhead(),
                   1000.0 * one.outside, one.outside / one.size, 1000.0 * one.furthest, 1000.0 * one.mean, one.crossings,
                   one.milliseconds, one.closed ? "" : "  NOT CLOSED",
                   one.closed && !one.sound() ? "  NOT ENCLOSING" : "");
    if (one.crossings > 0) {
      fmt::format_to(std::back_inserter(text), "{:{}}  ({} pairs of triangles pass through each other; {} of the mesh's)\n",
                     "", width, one.crossings, one.fine_crossings);
    }
  }
  return text;
}

std::string to_obj(const MeasuredHull& hull) {
  std::string text = fmt::format("# {}: coarse hull, m\n", hull.muscle);
  const auto to = std::back_inserter(text);
  const TriangleMesh& mesh = hull.hull.mesh;
  for (const glm::vec3& p : mesh.positions) fmt::format_to(to, "v {} {} {}\n", p.x, p.y, p.z);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    fmt::format_to(to, "f {} {} {}\n", mesh.indices[i] + 1, mesh.indices[i + 1] + 1, mesh.indices[i + 2] + 1);
  }
  return text;
}

}  // namespace fascicle::cook
