#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/geometry/mesh_edges.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "modules/muscle/asset/hull/build_full_mesh.hpp"
#include "modules/muscle/asset/hull/choose_samples.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/asset/hull/mean_value_coordinates.hpp"
#include "modules/muscle/asset/hull/progressive_hull.hpp"
#include "modules/muscle/asset/hull/reduce_hull.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/asset/surface/check_surface.hpp"

namespace fascicle::muscle {
namespace {

constexpr double kReproduced = 1.0e-5;  // of the muscle's size: how near the coordinates must bring the full mesh

// A matrix of hull vertices squared is factorised and multiplied by: more would be slower than the full mesh.
constexpr std::size_t kMostHullVertices = 1000;

bool is_closed(const TriangleMesh& hull) {
  if (hull.indices.empty() || hull.indices.size() % 3 != 0) return false;
  for (const std::uint32_t v : hull.indices) {
    if (v >= hull.positions.size()) return false;
  }
  const MeshEdges edges = find_edges(hull.indices, hull.positions.size());
  for (std::size_t e = 0; e < edges.count(); ++e) {
    if (edges.sides_of(e).size() != 2) return false;
  }
  return true;
}

std::int32_t find_driver(const SurfaceMuscleDescription& description, const MuscleAsset* muscles) {
  return muscles == nullptr ? -1 : find_muscle(*muscles, description.driver);
}

void check(const SurfaceMuscleDescription& description, const TriangleMesh& hull, const MuscleAsset* muscles,
           Diagnostics& found) {
  const auto fault = [&](const char* field, std::string cause, std::string remedy) {
    found.errors.push_back(fault_of(description, field, std::move(cause), std::move(remedy)));
  };
  const HullSettings& settings = description.hull;
  const auto is_weight = [](float value) { return std::isfinite(value) && value >= 0.0f; };
  if (!is_weight(settings.bending) || !is_weight(settings.direction)) {
    fault("hull", "a weight is negative or no number", "give weights of 0 or more");
  }
  if (!(settings.tolerance > 0.0f) || settings.iterations == 0) {
    fault("hull", "its iterations have no end", "give a tolerance above 0 and one iteration or more");
  }
  if (hull.positions.size() > kMostHullVertices) {
    fault("hull", fmt::format("the hull has {} vertices", hull.positions.size()),
          fmt::format("ask for {} or fewer", kMostHullVertices));
  } else if (hull.positions.size() < kFewestHullVertices || !is_closed(hull)) {
    fault("hull", "the hull is no closed mesh", "leave out the stored one: it is made anew");
  }
  if (description.attachments.empty() ||
      std::ranges::all_of(description.attachments, [](const auto& one) { return one.vertices.empty(); })) {
    fault("attachments", "the muscle is attached to no bone, so no pose says where it is",
          "attach it, or let it be solved by \"dynamic\" alone");
  }
  if (description.action_line.empty() && !description.driver.empty() && find_driver(description, muscles) < 0) {
    fault("driver", fmt::format("the muscles at hand have no '{}' whose line it could follow", description.driver),
          "hand over the driver's musculature, or give \"action_line\"");
  }
  if (description.action_line.empty() && description.driver.empty()) {
    fault("action_line", "a coarse hull needs the muscle's action line",
          "give \"action_line\" two points or more with their bones, or a \"driver\"");
  } else if (description.action_line.size() == 1) {
    fault("action_line", "the action line has one point", "give it two or more");
  }
}

std::vector<HullLinePoint> find_line(const SurfaceAsset& surface, const SurfaceMuscleDescription& description,
                                     const MuscleAsset* muscles) {
  std::vector<HullLinePoint> line;
  for (const ActionLinePoint& point : description.action_line) {
    line.push_back({.rest = point.position, .bone = point.bone, .carrier = 0});
  }
  if (!line.empty() || muscles == nullptr) return line;
  const auto driver = static_cast<std::uint32_t>(find_muscle(*muscles, surface.driver));
  for (std::uint32_t c = 0; c < surface.carriers.size(); ++c) {
    line.push_back({.rest = rest_point(*muscles, driver, c), .bone = -1, .carrier = c});
  }
  return line;
}

float length_of(std::span<const HullLinePoint> line) {
  float length = 0.0f;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) length += glm::distance(line[i].rest, line[i + 1].rest);
  return length;
}

// W; empty where it does not bring the full mesh's vertices to where they are.
Eigen::MatrixXd find_weights(const SurfaceAsset& surface, const TriangleMesh& hull, const Places& rest) {
  std::vector<glm::vec3> points;
  for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
    points.emplace_back(surface.rest[v].x, surface.rest[v].y, surface.rest[v].z);
  }
  std::vector<float> rows(points.size() * hull.positions.size());
  find_mean_value_coordinates(hull, points, rows);
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::MatrixXd weights = Eigen::Map<const Rows>(rows.data(), static_cast<Eigen::Index>(points.size()),
                                                   static_cast<Eigen::Index>(hull.positions.size())).cast<double>();
  Places places(static_cast<Eigen::Index>(hull.positions.size()), 3);
  for (std::size_t v = 0; v < hull.positions.size(); ++v) {
    const glm::dvec3 p(hull.positions[v]);
    places.row(static_cast<Eigen::Index>(v)) << p.x, p.y, p.z;
  }
  const double error = (weights * places - rest).rowwise().norm().maxCoeff();
  if (!(error <= kReproduced * static_cast<double>(surface.size))) weights.resize(0, 0);
  return weights;
}

}  // namespace

Result<std::shared_ptr<const HullAsset>> build_hull_asset(const SurfaceAsset& surface,
                                                          const SurfaceMuscleDescription& description,
                                                          const TriangleMesh& hull, const MuscleAsset* muscles) {
  Diagnostics found;
  check(description, hull, muscles, found);
  if (!found.ok()) return found;
  auto asset = std::make_shared<HullAsset>();
  asset->settings = description.hull;
  asset->levels = description.levels;
  asset->rest = hull.positions;
  asset->triangles = hull.indices;
  asset->line = find_line(surface, description, muscles);
  const auto fault = [&](const char* field, std::string cause, std::string remedy) {
    found.errors.push_back(fault_of(description, field, std::move(cause), std::move(remedy)));
    return found;
  };
  if (!(length_of(asset->line) > 0.0f)) {
    return fault("action_line", "the action line has no length", "let its points be apart");
  }
  const ShapeEnergy energy = build_shape_energy(surface, static_cast<double>(description.hull.bending));
  const Eigen::MatrixXd weights = find_weights(surface, hull, energy.rest);
  if (weights.size() == 0) {
    return fault("hull", "the hull does not reproduce the muscle's mesh", "leave out the stored one: it is made anew");
  }
  asset->weights = to_dense_rows(weights);
  asset->samples = choose_samples(surface);
  if (!reduce_to_hull(surface, energy, weights, *asset)) {
    return fault("hull", "the hull's shape is not determined: its matrix has no factor",
                 "ask for fewer vertices, or attach more of the muscle");
  }
  if (!build_full_mesh(surface, energy, asset->full)) {
    return fault("mesh", "the mesh's shape is not determined: its matrix has no factor",
                 "clean the mesh of slivers, or attach more of the muscle");
  }
  return std::shared_ptr<const HullAsset>(std::move(asset));
}

}  // namespace fascicle::muscle
