// How a bone's level set is made. OpenVDB rasterises the triangles into exact unsigned distances in a band about them;
// its own choice of sign asks for watertight meshes, which most bone files are not, so the sign comes from the winding
// number: inside is where the surface winds round more than a half. Last the inside beyond the band is filled with the
// distance to the nearest triangle, because a solver that has let a point sink that deep needs a way out.
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <mutex>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/winding_number.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/asset/bone_fields/grid_state.hpp"

namespace fascicle::muscle {

void start_openvdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

// The surface of a bone: all of its meshes, mended.
struct Surface {
  TriangleMesh mesh;
  bool closed = true;
};

Surface join(std::span<const TriangleMesh> meshes) {
  Surface surface;
  for (const TriangleMesh& mesh : meshes) {
    const CleanMesh clean = clean_mesh(mesh);
    if (clean.mesh.indices.empty()) continue;
    surface.closed = surface.closed && clean.defects.closed();
    const auto first = static_cast<std::uint32_t>(surface.mesh.positions.size());
    surface.mesh.positions.insert(surface.mesh.positions.end(), clean.mesh.positions.begin(),
                                  clean.mesh.positions.end());
    for (const std::uint32_t index : clean.mesh.indices) surface.mesh.indices.push_back(first + index);
  }
  return surface;
}

// As OpenVDB asks for a mesh.
class IndexSpaceMesh {
 public:
  IndexSpaceMesh(const TriangleMesh& mesh, double voxel) : mesh_(mesh), scale_(1.0 / voxel) {}
  std::size_t polygonCount() const { return mesh_.indices.size() / 3; }
  std::size_t pointCount() const { return mesh_.positions.size(); }
  std::size_t vertexCount(std::size_t) const { return 3; }
  void getIndexSpacePoint(std::size_t polygon, std::size_t vertex, openvdb::Vec3d& position) const {
    const glm::dvec3 p = glm::dvec3(mesh_.positions[mesh_.indices[3 * polygon + vertex]]) * scale_;
    position = openvdb::Vec3d(p.x, p.y, p.z);
  }

 private:
  const TriangleMesh& mesh_;
  double scale_;
};

// Gives a leaf's voxels their sign, and those inside that OpenVDB's band does not reach their distance.
class SignLeaf {
 public:
  SignLeaf(const Surface& surface, float voxel)
      : closed_(surface.closed), voxel_(voxel), winding_(surface.mesh), nearest_(surface.mesh) {}

  bool inside(const openvdb::Coord& at) const { return winding_.inside(glm::dvec3(place(at))); }

  void run(Leaf& leaf) const {
    std::array<float, Leaf::SIZE> distances;  // the background where inactive
    std::array<bool, Leaf::SIZE> insides;
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
      distances[i] = leaf.getValue(i);
      // Between two voxels that together are further from the surface than from each other the surface does not pass; of
      // a mesh with holes the winding number decides where it would have been, so there each voxel is asked.
      const openvdb::Index before = i % 8 != 0 ? i - 1 : i % 64 != 0 ? i - 8 : i - 64;
      const bool same = closed_ && i != 0 && distances[i] + distances[before] > 1.001f * voxel_;
      insides[i] = same ? insides[before] : inside(leaf.offsetToGlobalCoord(i));
    }
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
      if (!insides[i]) {
        if (!leaf.isValueOn(i)) leaf.setValueOnly(i, sample_reach(voxel_));  // as it comes back from a file
        continue;
      }
      const bool known = leaf.isValueOn(i);
      leaf.setValueOn(i, -(known ? distances[i] : nearest_.at(place(leaf.offsetToGlobalCoord(i))).distance));
    }
  }

 private:
  glm::vec3 place(const openvdb::Coord& at) const {
    return {static_cast<float>(at.x()) * voxel_, static_cast<float>(at.y()) * voxel_,
            static_cast<float>(at.z()) * voxel_};
  }

  bool closed_;
  float voxel_;
  WindingField winding_;
  ClosestPoints nearest_;
};

// Adds the leaves that are missing in the box and lie inside.
void add_inner_leaves(openvdb::FloatTree& tree, const openvdb::CoordBBox& box, const SignLeaf& sign) {
  std::vector<openvdb::Coord> missing;
  openvdb::Coord at;
  const openvdb::Coord first = box.min() & ~7;
  for (at.x() = first.x(); at.x() <= box.max().x(); at.x() += 8) {
    for (at.y() = first.y(); at.y() <= box.max().y(); at.y() += 8) {
      for (at.z() = first.z(); at.z() <= box.max().z(); at.z() += 8) {
        if (tree.probeConstLeaf(at) == nullptr) missing.push_back(at);
      }
    }
  }
  std::vector<char> inside(missing.size());
  parallel::for_range(missing.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) inside[i] = sign.inside(missing[i].offsetBy(4)) ? 1 : 0;
  });
  for (std::size_t i = 0; i < missing.size(); ++i) {
    if (inside[i] != 0) tree.touchLeaf(missing[i]);
  }
}

openvdb::FloatGrid::Ptr rasterise(const Surface& surface, float voxel, const glm::vec3& lower, const glm::vec3& upper) {
  start_openvdb();
  const auto transform = openvdb::math::Transform::createLinearTransform(static_cast<double>(voxel));
  const float reach = sample_reach(voxel);
  const IndexSpaceMesh mesh(surface.mesh, static_cast<double>(voxel));
  openvdb::FloatGrid::Ptr grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
      mesh, *transform, reach / voxel, reach / voxel, openvdb::tools::UNSIGNED_DISTANCE_FIELD);
  const SignLeaf sign(surface, voxel);
  openvdb::CoordBBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min()[axis] = static_cast<int>(std::floor(lower[axis] / voxel));
    box.max()[axis] = static_cast<int>(std::ceil(upper[axis] / voxel));
  }
  add_inner_leaves(grid->tree(), box, sign);
  std::vector<Leaf*> leaves;
  grid->tree().getNodes(leaves);
  parallel::for_range(leaves.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sign.run(*leaves[i]);
  });
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  return grid;
}

// About what building takes, in bytes: the band about the surface and what is inside, with an index for each voxel.
double estimate_bytes(const TriangleMesh& mesh, double voxel, const glm::dvec3& size) {
  double area = 0.0;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const glm::dvec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                     c = mesh.positions[mesh.indices[t + 2]];
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  const double reach = 2.0 * static_cast<double>(sample_reach(static_cast<float>(voxel))) + 16.0 * voxel;
  const glm::dvec3 outer = size + reach;
  const double box = outer.x * outer.y * outer.z;
  const double inside = size.x * size.y * size.z;
  return (8.0 * std::min(box, area * reach) + 4.0 * inside + 0.05 * box) / (voxel * voxel * voxel);
}

Diagnostic fault(const std::string& name, std::string cause, std::string remedy) {
  return {name, 0, 0, {}, std::move(cause), std::move(remedy)};
}

}  // namespace

Result<BoneGrid> build_bone_grid(std::span<const TriangleMesh> meshes, const std::string& name,
                                 const BoneGridSettings& settings) {
  const float voxel = settings.voxel;
  if (!(voxel > 0.0f) || !std::isfinite(voxel)) {
    return fault(name, fmt::format("the voxel of a bone's field is {} m", voxel), "give a size above 0, such as 0.002");
  }
  const Surface surface = join(meshes);
  if (surface.mesh.indices.empty()) {
    return fault(name, "the bone's mesh has no triangles with an area", "give it a mesh with triangles, or none");
  }
  glm::vec3 lower = surface.mesh.positions[surface.mesh.indices[0]], upper = lower;
  for (const std::uint32_t index : surface.mesh.indices) {
    lower = glm::min(lower, surface.mesh.positions[index]);
    upper = glm::max(upper, surface.mesh.positions[index]);
  }
  const double bytes = estimate_bytes(surface.mesh, static_cast<double>(voxel), glm::dvec3(upper) - glm::dvec3(lower));
  if (!(bytes <= static_cast<double>(settings.most_bytes))) {
    return fault(name,
                 fmt::format("a field of {:.4g} m voxels for a bone of {:.3g} x {:.3g} x {:.3g} m would take about {:.3g} "
                             "GB, more than the {:.3g} GB that it may",
                             voxel, upper.x - lower.x, upper.y - lower.y, upper.z - lower.z, bytes / 1e9,
                             static_cast<double>(settings.most_bytes) / 1e9),
                 "make the voxel larger, or mend the mesh's unit");
  }
  try {
    auto state = std::make_shared<BoneGrid::State>();
    state->voxel = voxel;
    state->band = band_of(voxel);
    state->lower = lower;
    state->upper = upper;
    openvdb::FloatGrid::Ptr grid = rasterise(surface, voxel, lower, upper);
    grid->setName(name);
    state->grid = std::move(grid);
    return BoneGrid(std::move(state));
  } catch (const std::exception& failure) {  // OpenVDB's own errors, or no memory
    return fault(name, fmt::format("the bone's field cannot be built: {}", failure.what()),
                 "mend the mesh, or make the voxel larger");
  }
}

Result<std::shared_ptr<const BoneField>> build_bone_field(std::span<const TriangleMesh> meshes,
                                                          const std::string& name,
                                                          const BoneGridSettings& settings) {
  Result<BoneGrid> grid = build_bone_grid(meshes, name, settings);
  if (!grid) return std::move(grid.diagnostics());
  return std::shared_ptr<const BoneField>(std::make_shared<BoneField>(flatten(*grid)));
}

std::size_t BoneGrid::active_voxels() const { return state_->grid->activeVoxelCount(); }
std::size_t BoneGrid::bytes() const { return state_->grid->memUsage(); }

}  // namespace fascicle::muscle
