// How well a muscle's rest surface agrees with the anatomical mesh that it was fitted to. Independent of the fit: it
// reads the built asset alone, and uses distances to the nearest surface points and winding numbers, no rays.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/mesh_distance.hpp"
#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {

// An anatomical mesh made ready to be compared with, any number of times, from any thread.
struct MeshOracle {
  TriangleMesh mesh;
  ClosestPoints surface;
  WindingField winding;
  double area = 0.0, volume = 0.0, diagonal = 0.0;  // m^2, m^3, m (of the bounds)
  std::uint32_t vertices = 0;                       // that triangles use

  explicit MeshOracle(TriangleMesh anatomical);
};

struct FitComparison {
  SurfaceDistance fit_to_mesh, mesh_to_fit;          // m
  double fit_volume = 0.0, mesh_volume = 0.0;        // m^3
  std::uint32_t fit_vertices = 0, mesh_vertices = 0;
  std::uint32_t sections = 0;                        // the two ends among them
  std::uint32_t sections_outside = 0;                // whose centres lie outside of the mesh, by winding number

  double rms() const;  // both ways, m
  double max() const;
};

// The muscle's rest surface as it is drawn, less the tendon sections C_t, which lie on it: vertex i of section k is
// k |C| + i, then the centres of the two caps. Outward.
TriangleMesh rest_surface(const MuscleAsset& asset, std::uint32_t muscle);

// Samples of each surface lie about `spacing` m apart; 0: so that there are 2,000 of each.
FitComparison compare_fit(const MuscleAsset& asset, std::uint32_t muscle, const MeshOracle& oracle,
                          double spacing = 0.0);

// The same for muscles that are the heads of one mesh; one answer a head. Each part of the mesh is compared with the
// head whose surface is nearest to it. Of a head's surface those parts count that bound the heads' union: not what lies
// inside another head. mesh_volume and mesh_vertices are the whole mesh's.
std::vector<FitComparison> compare_heads(const MuscleAsset& asset, std::span<const std::uint32_t> heads,
                                         const MeshOracle& oracle, double spacing = 0.0);

}  // namespace fascicle::muscle
