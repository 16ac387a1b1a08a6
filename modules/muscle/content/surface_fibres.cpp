#include "modules/muscle/content/surface_fibres.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <glm/mat4x4.hpp>

#include "engine/content/vtk_reader.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/content/surface_limits.hpp"

namespace fascicle::muscle {

namespace {

using Line = std::vector<glm::vec3>;

std::vector<Line> join_lines(const PolylineSet& set) {
  std::vector<Line> lines;
  std::uint32_t last = std::numeric_limits<std::uint32_t>::max();
  for (std::size_t l = 0; l < set.ends.size(); ++l) {
    const std::span<const std::uint32_t> points = set.line(l);
    if (points.empty()) continue;
    const bool goes_on = !lines.empty() && points.front() == last;
    if (!goes_on) lines.emplace_back();
    for (const std::uint32_t point : points.subspan(goes_on ? 1 : 0)) lines.back().push_back(set.positions[point]);
    last = points.back();
  }
  std::erase_if(lines, [](const Line& line) { return line.size() < 2; });
  return lines;
}

std::vector<Line> read_lines(const FibresEntry& entry, const std::filesystem::path& base, ContentSources& sources,
                             Diagnostics& diagnostics) {
  if (!entry.file.given() && entry.points.size() < 2) return {};  // told where it was read
  if (!entry.file.given()) return {entry.points};
  const auto path = sources.resolve(entry.file.text, base, entry.file.node, diagnostics);
  if (!path) return {};
  Result<PolylineSet> set = read_polylines(*path);
  std::vector<Line> lines;
  if (set) lines = join_lines(*set);
  const bool read = set.ok();
  diagnostics.append(std::move(set.diagnostics()));
  if (read && lines.empty()) {
    entry.file.node.error(diagnostics, fmt::format("'{}' has no line of two points", entry.file.text),
                          "name a .vtk file of LINES");
  }
  return lines;
}

// How far lines stay away from a closed mesh.
class Nearness {
 public:
  explicit Nearness(const TriangleMesh& mesh) : mesh_(mesh), surface_(mesh) {}

  // m; 0 inside.
  double distance(const Line& line) {
    double least = std::numeric_limits<double>::infinity();
    for (const glm::vec3& point : line) least = std::min(least, static_cast<double>(surface_.at(point).distance));
    if (least <= static_cast<double>(kFibreReach)) return least;
    if (!inside_) inside_ = std::make_unique<WindingField>(mesh_);
    return inside_->inside(glm::dvec3(line.front())) ? 0.0 : least;  // so far from the surface, all of it is
  }

 private:
  const TriangleMesh& mesh_;
  ClosestPoints surface_;
  std::unique_ptr<WindingField> inside_;  // few fibres need it
};

void check_touch(const FibresEntry& entry, std::span<const Line> lines, Nearness& nearness, Diagnostics& diagnostics) {
  std::size_t apart = 0, first = 0;
  double its_distance = 0.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double distance = nearness.distance(lines[i]);
    if (distance <= static_cast<double>(kFibreReach)) continue;
    if (apart++ == 0) {
      first = i;
      its_distance = distance;
    }
  }
  if (apart == 0) return;
  entry.node.error(diagnostics,
                   fmt::format("{} of {} fibre{} do{} not touch the muscle: fibre {} is {:.4g} mm away from it", apart,
                               lines.size(), lines.size() == 1 ? "" : "s", apart == 1 ? "es" : "", first,
                               1000.0 * its_distance),
                   "fibres lie on the mesh or in it: correct their \"unit\" and place (left out, they are the mesh's)");
}

}  // namespace

std::vector<FibreLine> load_fibres(std::span<const FibresEntry> entries, const SurfaceMuscleEntry& muscle,
                                   const CharacterFile& file, const std::filesystem::path& base,
                                   const TriangleMesh& rest, ContentSources& sources, Diagnostics& diagnostics) {
  std::vector<FibreLine> fibres;
  if (entries.empty()) return fibres;
  Nearness nearness(rest);
  for (const FibresEntry& entry : entries) {
    std::vector<Line> lines = read_lines(entry, base, sources, diagnostics);
    Trs placement = entry.transform;
    placement.scale *= muscle.mesh.name.given() && !entry.own_unit ? file.muscle_mesh_unit : entry.unit;
    const glm::mat4 matrix = to_matrix(placement);
    for (Line& line : lines) {
      for (glm::vec3& point : line) point = glm::vec3(matrix * glm::vec4(point, 1.0f));
    }
    check_touch(entry, lines, nearness, diagnostics);
    for (Line& line : lines) fibres.push_back({std::move(line), entry.head});
  }
  return fibres;
}

}  // namespace fascicle::muscle
