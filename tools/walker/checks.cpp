#include "tools/walker/checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "tools/walker/muscle_meshes.hpp"

namespace fascicle::walker {
namespace {

constexpr float kLineEnds = 0.008f;  // m of a line at each end that may lie in its bone
constexpr float kCell = 0.002f;      // m, of the grid that counts overlaps

// Isoperimetric quotient of a rim, 4 pi A / P^2, and whether it is convex.
std::pair<double, bool> quotient(const TriangleMesh& mesh, std::size_t first, std::size_t sides) {
  glm::dvec3 area(0.0);
  double perimeter = 0.0;
  const auto at = [&](std::size_t j) { return glm::dvec3(mesh.positions[first + j % sides]); };
  for (std::size_t j = 0; j < sides; ++j) {
    area += glm::cross(at(j) - at(0), at(j + 1) - at(0));
    perimeter += glm::distance(at(j), at(j + 1));
  }
  bool convex = true;
  for (std::size_t j = 0; j < sides; ++j) {
    const glm::dvec3 turn = glm::cross(at(j + 1) - at(j), at(j + 2) - at(j + 1));
    const double size = glm::distance(at(j), at(j + 1)) * glm::distance(at(j + 1), at(j + 2));
    if (glm::dot(turn, glm::normalize(area)) < -0.05 * size) convex = false;
  }
  return {4.0 * glm::pi<double>() * 0.5 * glm::length(area) / (perimeter * perimeter), convex};
}

// Inside cells of a closed mesh: crossings of the columns along z, paired.
std::vector<glm::ivec3> cells_inside(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, std::vector<float>> columns;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[i]] / kCell, b = mesh.positions[mesh.indices[i + 1]] / kCell;
    const glm::vec3 c = mesh.positions[mesh.indices[i + 2]] / kCell;
    const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (std::abs(area) < 1e-12f) continue;
    const glm::vec3 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    for (int x = static_cast<int>(std::floor(low.x)); x <= static_cast<int>(std::ceil(high.x)); ++x) {
      for (int y = static_cast<int>(std::floor(low.y)); y <= static_cast<int>(std::ceil(high.y)); ++y) {
        const float px = static_cast<float>(x) + 0.4871f, py = static_cast<float>(y) + 0.5133f;  // off the vertices
        const float u = ((px - a.x) * (c.y - a.y) - (c.x - a.x) * (py - a.y)) / area;
        const float v = ((b.x - a.x) * (py - a.y) - (px - a.x) * (b.y - a.y)) / area;
        if (u < 0.0f || v < 0.0f || u + v > 1.0f) continue;
        columns[{x, y}].push_back(a.z + u * (b.z - a.z) + v * (c.z - a.z));
      }
    }
  }
  std::vector<glm::ivec3> cells;
  for (auto& [xy, crossings] : columns) {
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
      for (int z = static_cast<int>(std::ceil(crossings[i])); z <= static_cast<int>(std::floor(crossings[i + 1])); ++z)
        cells.emplace_back(xy.first, xy.second, z);
  }
  return cells;
}

}  // namespace

MeshFaults find_faults(const TriangleMesh& mesh) {
  MeshFaults faults;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    ++edges[{mesh.indices[i], mesh.indices[i % 3 == 2 ? i - 2 : i + 1]}];
  for (const auto& [edge, count] : edges) {
    if (count > 1) ++faults.crowded_edges;
    const auto other = edges.find({edge.second, edge.first});
    if (other == edges.end() || other->second != count) ++faults.open_edges;
  }
  faults.outward = mesh_volume(mesh) > 0.0;
  return faults;
}

bool inside(const TriangleMesh& mesh, const glm::vec3& p) {
  double solid_angle = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::dvec3 a = mesh.positions[mesh.indices[i]] - p, b = mesh.positions[mesh.indices[i + 1]] - p;
    const glm::dvec3 c = mesh.positions[mesh.indices[i + 2]] - p;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    solid_angle += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                    la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return solid_angle > 2.0 * glm::pi<double>();
}

std::string report_meshes(const std::vector<MuscleSpec>& muscles, const std::vector<TriangleMesh>& meshes,
                          const std::vector<std::size_t>& sides, const std::vector<BoneShape>& shapes) {
  std::string text =
      fmt::format("{:30} {:>8} {:>7} {:>7} {:>6} {:>6} {:>6} {:>8} {:>9} {}\n", "muscle (right)", "vertices", "cm3",
                  "wanted", "q 1/4", "q 1/2", "q 3/4", "mm bone", "line in", "faults");
  std::vector<double> quotients;
  std::size_t total = 0, concave = 0, points_out = 0, points = 0;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const TriangleMesh& mesh = meshes[m];
    total += mesh.positions.size();
    const std::size_t rims = (mesh.positions.size() - 2) / sides[m];
    double q[3];
    for (int i = 0; i < 3; ++i) {
      const auto [value, convex] =
          quotient(mesh, (rims - 1) * static_cast<std::size_t>(i + 1) / 4 * sides[m], sides[m]);
      q[i] = value;
      quotients.push_back(value);
      concave += convex ? 0 : 1;
    }
    float depth = 0.0f;
    for (const glm::vec3& p : mesh.positions) depth = std::max(depth, -rest_distance(shapes, p));
    const std::vector<glm::vec3> path = rest_path(muscles[m]);
    std::size_t in = 0, of = 0;
    for (std::size_t i = 0; i < 2 * path.size() - 1; ++i) {
      const glm::vec3 p = i % 2 == 0 ? path[i / 2] : 0.5f * (path[i / 2] + path[i / 2 + 1]);
      ++of;
      in += inside(mesh, p) ? 1 : 0;
    }
    points += of;
    points_out += of - in;
    const MeshFaults faults = find_faults(mesh);
    text += fmt::format("{:30} {:>8} {:>7.1f} {:>7.1f} {:>6.2f} {:>6.2f} {:>6.2f} {:>8.1f} {:>6}/{:<2} {}{}{}\n",
                        muscles[m].name, mesh.positions.size(), 1e6 * mesh_volume(mesh), 1e6f * muscles[m].volume(),
                        q[0], q[1], q[2], 1e3f * depth, in, of, faults.open_edges > 0 ? "open " : "",
                        faults.crowded_edges > 0 ? "crowded " : "", faults.outward ? "" : "inward");
  }
  std::sort(quotients.begin(), quotients.end());
  double mean = 0.0;
  std::size_t above = 0;
  for (const double q : quotients) {
    mean += q / static_cast<double>(quotients.size());
    above += q > 0.5 ? 1 : 0;
  }
  text += fmt::format(
      "both sides: {} vertices; q of {} slices: mean {:.3f}, median {:.3f}, {:.0f} % above 0.5, range {:.2f}..{:.2f}; "
      "{} concave; line points outside their mesh: {} of {}\n",
      2 * total, quotients.size(), mean, quotients[quotients.size() / 2],
      100.0 * static_cast<double>(above) / static_cast<double>(quotients.size()), quotients.front(), quotients.back(),
      concave, points_out, points);
  return text;
}

std::string report_overlaps(const std::vector<TriangleMesh>& meshes) {
  std::map<std::tuple<int, int, int>, std::size_t> owner;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> shared;
  std::size_t filled = 0, twice = 0;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    for (const glm::ivec3& cell : cells_inside(meshes[m])) {
      ++filled;
      const auto [it, fresh] = owner.try_emplace({cell.x, cell.y, cell.z}, m);
      if (fresh || it->second == m) continue;
      ++twice;
      ++shared[{it->second, m}];
    }
  }
  std::string text = fmt::format("overlap between muscles: {:.2f} % of {:.0f} cm3\n",
                                 100.0 * static_cast<double>(twice) / static_cast<double>(filled),
                                 static_cast<double>(filled) * kCell * kCell * kCell * 1e6);
  for (const auto& [pair, count] : shared)
    if (count > 12)
      text += fmt::format("  {:.2f} cm3 {} / {}\n", static_cast<double>(count) * kCell * kCell * kCell * 1e6,
                          meshes[pair.first].name, meshes[pair.second].name);
  return text;
}

std::string report_lines(const std::vector<MuscleSpec>& muscles, const std::vector<BoneShape>& shapes,
                         const Gait& gait) {
  std::string text = fmt::format("{:30} {:>8} {:>8}   worst place\n", "line (right)", "mm rest", "mm walk");
  std::size_t counted = 0, extra = 0;
  std::vector<Pose> poses{rest_pose()};
  for (std::size_t i = 0; i + 1 < gait.poses.size(); i += 3) poses.push_back(gait.poses[i]);
  for (const MuscleSpec& muscle : muscles) {
    for (std::size_t i = 1; i + 1 < muscle.path.size(); ++i)
      ++(muscle.path[i].kind == PointKind::kPublished ? counted : extra);
    float depth_rest = 0.0f, depth_walk = 0.0f, worst = 0.0f;
    std::string place;
    for (std::size_t pose = 0; pose < poses.size(); ++pose) {
      const Placed placed = place_bones(poses[pose]);
      std::vector<glm::vec3> line;
      for (const PathPoint& p : muscle.path) {
        const auto bone = static_cast<std::size_t>(find_bone(p.bone));
        line.push_back(placed.place[bone] + placed.rotation[bone] * p.position);
      }
      float total = 0.0f, gone = 0.0f;
      for (std::size_t i = 1; i < line.size(); ++i) total += glm::distance(line[i - 1], line[i]);
      for (std::size_t i = 1; i < line.size(); ++i) {
        const float length = glm::distance(line[i - 1], line[i]);
        for (float along = 0.0f; along < length; along += 0.002f) {
          if (gone + along < kLineEnds || total - gone - along < kLineEnds) continue;
          const glm::vec3 p = glm::mix(line[i - 1], line[i], along / length);
          for (const BoneShape& shape : shapes) {
            const auto bone = static_cast<std::size_t>(shape.bone);
            const glm::vec3 local = glm::inverse(placed.rotation[bone]) * (p - placed.place[bone]);
            const float depth = -shape.distance(local);
            float& deepest = pose == 0 ? depth_rest : depth_walk;
            deepest = std::max(deepest, depth);
            if (depth <= worst) continue;
            worst = depth;
            const glm::vec3 out =
                shape.solid.outward(shape.symmetric ? glm::vec3(-std::abs(local.x), local.y, local.z) : local);
            place = fmt::format(
                "segment {} at {:.0f} mm in {} ({:.1f} {:.1f} {:.1f}) out ({:.2f} {:.2f} {:.2f}) OpenSim mm", i,
                1e3f * along, bones()[bone].name, 1e3f * local.z, 1e3f * local.y, -1e3f * local.x, out.z, out.y,
                -out.x);
          }
        }
        gone += length;
      }
    }
    text += fmt::format("{:30} {:>8.1f} {:>8.1f}   {}\n", muscle.name, 1e3f * depth_rest, 1e3f * depth_walk, place);
  }
  text += fmt::format("via points a side: {} counted, {} more\n", counted, extra);
  return text;
}

float lowest_foot(const Pose& pose, const std::vector<TriangleMesh>& bone_meshes) {
  const Placed placed = place_bones(pose);
  float lowest = 1e9f;
  for (const TriangleMesh& mesh : bone_meshes) {
    if (mesh.name.rfind("foot", 0) != 0 && mesh.name.rfind("toes", 0) != 0) continue;
    const auto bone = static_cast<std::size_t>(find_bone(mesh.name));
    for (const glm::vec3& p : mesh.positions)
      lowest = std::min(lowest, (placed.place[bone] + placed.rotation[bone] * p).y);
  }
  return lowest;
}

}  // namespace fascicle::walker
