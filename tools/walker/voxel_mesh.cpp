#include "tools/walker/voxel_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <openvdb/openvdb.h>
#include <openvdb/tools/Composite.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/LevelSetFilter.h>
#include <openvdb/tools/LevelSetUtil.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>

namespace fascicle::walker {
namespace {

constexpr int kBlock = 8;      // voxels along an OpenVDB leaf
constexpr float kBand = 3.0f;  // voxels kept on each side of the surface

void initialise_openvdb() {
  static const bool done = (openvdb::initialize(), true);
  (void)done;
}

double signed_volume(const TriangleMesh& mesh) {
  double six = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::dvec3 a = mesh.positions[mesh.indices[i]];
    const glm::dvec3 b = mesh.positions[mesh.indices[i + 1]];
    const glm::dvec3 c = mesh.positions[mesh.indices[i + 2]];
    six += glm::dot(a, glm::cross(b, c));
  }
  return six / 6.0;
}

TriangleMesh mesh_grid(const openvdb::FloatGrid& grid, float adaptivity) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(grid, points, triangles, quads, 0.0, adaptivity);
  TriangleMesh mesh;
  mesh.positions.reserve(points.size());
  for (const openvdb::Vec3s& p : points) mesh.positions.emplace_back(p.x(), p.y(), p.z());
  const auto add = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a == b || b == c || c == a) return;
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
  };
  for (const openvdb::Vec3I& t : triangles) add(t[0], t[1], t[2]);
  for (const openvdb::Vec4I& q : quads) {
    // The shorter diagonal keeps the triangles closer to the quad's surface.
    const float d02 = glm::distance(mesh.positions[q[0]], mesh.positions[q[2]]);
    const float d13 = glm::distance(mesh.positions[q[1]], mesh.positions[q[3]]);
    if (d02 <= d13) {
      add(q[0], q[1], q[2]);
      add(q[0], q[2], q[3]);
    } else {
      add(q[0], q[1], q[3]);
      add(q[1], q[2], q[3]);
    }
  }
  if (signed_volume(mesh) < 0.0) {
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  }
  return mesh;
}

openvdb::FloatGrid::Ptr sample_field(const Field& field, const Box& box, float voxel) {
  initialise_openvdb();
  auto grid = openvdb::FloatGrid::create(kBand * voxel);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  auto accessor = grid->getAccessor();
  const glm::ivec3 low(glm::floor(box.low / (voxel * kBlock)));
  const glm::ivec3 high(glm::ceil(box.high / (voxel * kBlock)));
  // A block whose centre lies this far from the surface cannot meet it. Twice the half diagonal, because smooth unions
  // and ellipsoids are distances only near their surface.
  const float skip = 2.0f * 0.5f * std::sqrt(3.0f) * kBlock * voxel + kBand * voxel;
  for (int bz = low.z; bz < high.z; ++bz) {
    for (int by = low.y; by < high.y; ++by) {
      for (int bx = low.x; bx < high.x; ++bx) {
        const glm::vec3 centre = (glm::vec3(bx, by, bz) + 0.5f) * (voxel * kBlock);
        if (std::abs(field(centre)) > skip) continue;
        for (int i = 0; i < kBlock * kBlock * kBlock; ++i) {
          const openvdb::Coord at(bx * kBlock + i % kBlock, by * kBlock + i / kBlock % kBlock,
                                  bz * kBlock + i / (kBlock * kBlock));
          const float d = field(glm::vec3(at.x(), at.y(), at.z()) * voxel);
          if (std::abs(d) < kBand * voxel)
            accessor.setValue(at, d);
          else if (d < 0.0f)
            accessor.setValueOff(at, -kBand * voxel);
        }
      }
    }
  }
  openvdb::tools::signedFloodFill(grid->tree());
  return grid;
}

}  // namespace

TriangleMesh mesh_field(const Field& field, const Box& box, float voxel, float adaptivity) {
  return mesh_grid(*sample_field(field, box, voxel), adaptivity);
}

TriangleMesh wrap_meshes(std::span<const TriangleMesh> parts, const WrapSettings& settings) {
  initialise_openvdb();
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  for (const TriangleMesh& part : parts) {
    const auto first = static_cast<openvdb::Index32>(points.size());
    for (const glm::vec3& p : part.positions) points.emplace_back(p.x, p.y, p.z);
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3)
      triangles.emplace_back(first + part.indices[i], first + part.indices[i + 1], first + part.indices[i + 2]);
  }
  const auto transform = openvdb::math::Transform::createLinearTransform(settings.voxel);
  auto grid = openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*transform, points, triangles, 4.0f);
  openvdb::tools::LevelSetFilter<openvdb::FloatGrid> filter(*grid);
  filter.setGrainSize(0);  // serial: the same bytes on every machine
  filter.offset(-settings.dilate);
  for (int i = 0; i < settings.smooth_passes; ++i) filter.gaussian(1);
  filter.offset(settings.erode);
  for (int i = 0; i < settings.smooth_passes; ++i) filter.gaussian(1);

  const auto accessor = grid->getConstAccessor();
  const openvdb::tools::GridSampler<openvdb::FloatGrid::ConstAccessor, openvdb::tools::BoxSampler> sampler(
      accessor, grid->transform());
  const float cut = settings.cut_height, floor = settings.floor_height;
  const auto field = [&sampler, cut, floor](const glm::vec3& p) {
    return std::max({sampler.wsSample(openvdb::Vec3d(p.x, p.y, p.z)), p.y - cut, floor - p.y});
  };
  const openvdb::CoordBBox bounds = grid->evalActiveVoxelBoundingBox();
  const openvdb::Vec3d low = grid->indexToWorld(bounds.min());
  const openvdb::Vec3d high = grid->indexToWorld(bounds.max());
  const Box box{glm::vec3(low.x(), low.y(), low.z()), glm::vec3(high.x(), high.y(), high.z())};
  return mesh_field(field, box, settings.mesh_voxel, 0.0f);
}

}  // namespace fascicle::walker
