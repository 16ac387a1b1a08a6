// How a bone's level set is made. The surface is mended first (bone_surface.hpp), so that it is closed and nothing of
// it lies inside. Then each voxel near it or inside gets its exact distance to the nearest triangle, and its sign from
// the winding number: inside is where the surface winds round more than a half. All of the inside is filled, because a
// solver that has let a point sink deep needs a way out. OpenVDB holds the voxels.
//
// OpenVDB can make level sets of meshes itself, and we tried: its sign asks for watertight meshes, and of its unsigned
// distances only those next to the surface are exact; further out it asks the triangles that neighbours found nearest,
// and was up to 1.4 voxels too far on a femur. Here a voxel's search starts from the point that was nearest to
// the voxel beside it, which is about as quick.
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

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/winding_number.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/asset/bone_fields/bone_surface.hpp"
#include "modules/muscle/asset/bone_fields/grid_state.hpp"

namespace fascicle::muscle {

void start_openvdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr int kSide = 8;  // voxels along a leaf
// Voxels from a leaf's middle voxel to its corners, and a bit.
constexpr float kLeafRadius = 7.0f;

class LeafFiller {
 public:
  LeafFiller(const BoneSurface& surface, float voxel)
      : voxel_(voxel), reach_(sample_reach(voxel)), winding_(surface.closed), nearest_(surface.outer) {}

  // Whether any voxel of the leaf is near enough to the surface, or inside.
  bool wanted(const openvdb::Coord& origin) const {
    const glm::vec3 middle = place(origin.offsetBy(kSide / 2));
    if (nearest_.within(middle, reach_ + kLeafRadius * voxel_).distance < kNowhere) return true;
    return winding_.inside(glm::dvec3(middle));  // all of it, or nothing
  }

  void fill(Leaf& leaf) const {
    Distances distances;
    measure(leaf, distances);
    const Insides inside = find_inside(leaf, distances);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
      if (!inside[i]) {
        if (distances[i] < reach_) leaf.setValueOn(i, distances[i]);
        else leaf.setValueOff(i, reach_);
        continue;
      }
      float depth = distances[i];
      if (!(depth < reach_)) depth = nearest_.at(place(leaf.offsetToGlobalCoord(i))).distance;
      leaf.setValueOn(i, -depth);
    }
  }

 private:
  using Distances = std::array<float, Leaf::SIZE>;  // m, unsigned; what is further away than reach_ has that
  using Insides = std::array<bool, Leaf::SIZE>;

  glm::vec3 place(const openvdb::Coord& at) const {
    return {static_cast<float>(at.x()) * voxel_, static_cast<float>(at.y()) * voxel_,
            static_cast<float>(at.z()) * voxel_};
  }

  // By blocks, because most voxels of a leaf may be out of reach, and in each from voxel to voxel: what was nearest to
  // the one before can't be far.
  void measure(const Leaf& leaf, Distances& distances) const {
    distances.fill(reach_);
    const openvdb::Coord origin = leaf.origin();
    for (int block = 0; block < 8; ++block) {
      const openvdb::Coord first((block & 4) != 0 ? 4 : 0, (block & 2) != 0 ? 4 : 0, (block & 1) != 0 ? 4 : 0);
      // From the block's middle voxel its furthest is sqrt(12) voxels away.
      ClosestPoint nearest = nearest_.within(place(origin + first.offsetBy(2)), reach_ + 3.5f * voxel_);
      for (int i = 0; i < 64 && nearest.distance < kNowhere; ++i) {
        // There and back, so that each voxel is beside the one before.
        const int x = i / 16, row = i / 4, y = x % 2 == 0 ? row % 4 : 3 - row % 4, z = row % 2 == 0 ? i % 4 : 3 - i % 4;
        const openvdb::Coord at = first.offsetBy(x, y, z);
        const glm::vec3 point = place(origin + at);
        const float limit = glm::distance(point, nearest.position) * 1.00001f + 1e-9f;
        const ClosestPoint found = nearest_.within(point, limit);
        nearest = found.distance < kNowhere ? found : nearest_.at(point);  // the latter where rounding is in the way
        distances[Leaf::coordToOffset(at)] = std::min(nearest.distance, reach_);
      }
    }
  }

  // The surface is closed, so it does not pass between two voxels that together are further from it than from each
  // other. Voxels are taken from far to near, and only those are asked that no neighbour can answer for.
  Insides find_inside(const Leaf& leaf, const Distances& distances) const {
    std::array<std::uint16_t, Leaf::SIZE> order;
    for (std::uint16_t i = 0; i < Leaf::SIZE; ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::uint16_t a, std::uint16_t b) {
      return distances[a] != distances[b] ? distances[a] > distances[b] : a < b;
    });
    Insides inside{}, known{};
    for (const std::uint16_t i : order) {
      const int answer = neighbour_that_knows(i, distances, known);
      inside[i] = answer >= 0 ? inside[static_cast<std::size_t>(answer)]
                              : winding_.inside(glm::dvec3(place(leaf.offsetToGlobalCoord(i))));
      known[i] = true;
    }
    return inside;
  }

  int neighbour_that_knows(int i, const Distances& distances, const Insides& known) const {
    static constexpr std::array<float, 4> kApart{0.0f, 1.001f, 1.416f, 1.734f};  // voxels, by how many axes differ
    const int x = i / (kSide * kSide), y = i / kSide % kSide, z = i % kSide;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          if (((x + dx) | (y + dy) | (z + dz)) & ~(kSide - 1)) continue;  // in another leaf; i itself is not known
          const int other = ((x + dx) * kSide + y + dy) * kSide + z + dz;
          const auto at = static_cast<std::size_t>(other);
          const float apart = kApart[static_cast<std::size_t>(dx * dx + dy * dy + dz * dz)] * voxel_;
          if (known[at] && distances[at] + distances[static_cast<std::size_t>(i)] > apart) return other;
        }
      }
    }
    return -1;
  }

  float voxel_, reach_;  // m
  WindingField winding_;
  ClosestPoints nearest_;
};

// The origins of all leaves that hold something.
std::vector<openvdb::Coord> find_leaves(const LeafFiller& filler, float voxel, const glm::vec3& lower,
                                        const glm::vec3& upper) {
  const float reach = sample_reach(voxel);
  openvdb::CoordBBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min()[axis] = static_cast<int>(std::floor((lower[axis] - reach) / voxel)) & ~(kSide - 1);
    box.max()[axis] = static_cast<int>(std::ceil((upper[axis] + reach) / voxel));
  }
  std::vector<openvdb::Coord> leaves;
  openvdb::Coord at;
  for (at.x() = box.min().x(); at.x() <= box.max().x(); at.x() += kSide) {
    for (at.y() = box.min().y(); at.y() <= box.max().y(); at.y() += kSide) {
      for (at.z() = box.min().z(); at.z() <= box.max().z(); at.z() += kSide) leaves.push_back(at);
    }
  }
  std::vector<char> wanted(leaves.size());
  parallel::for_range(leaves.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) wanted[i] = filler.wanted(leaves[i]) ? 1 : 0;
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (wanted[i] != 0) leaves[kept++] = leaves[i];
  }
  leaves.resize(kept);
  return leaves;
}

openvdb::FloatGrid::Ptr make_level_set(const BoneSurface& surface, float voxel, const glm::vec3& lower,
                                       const glm::vec3& upper) {
  start_openvdb();
  const LeafFiller filler(surface, voxel);
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(sample_reach(voxel));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(static_cast<double>(voxel)));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  std::vector<Leaf*> leaves;
  for (const openvdb::Coord& origin : find_leaves(filler, voxel, lower, upper)) {
    leaves.push_back(grid->tree().touchLeaf(origin));
  }
  parallel::for_range(leaves.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) filler.fill(*leaves[i]);
  });
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
  const BoneSurface surface = make_bone_surface(meshes, voxel);
  if (surface.closed.indices.empty()) {
    return fault(name, "the bone's mesh has no triangles with an area", "give it a mesh with triangles, or none");
  }
  glm::vec3 lower = surface.closed.positions[surface.closed.indices[0]], upper = lower;
  for (const std::uint32_t index : surface.closed.indices) {
    lower = glm::min(lower, surface.closed.positions[index]);
    upper = glm::max(upper, surface.closed.positions[index]);
  }
  const glm::dvec3 size = glm::dvec3(upper) - glm::dvec3(lower);
  const double bytes = estimate_bytes(surface.closed, double{voxel}, size);
  if (!(bytes <= static_cast<double>(settings.most_bytes))) {
    return fault(name,
                 fmt::format("a field of {:.4g} m voxels for a bone of {:.3g} x {:.3g} x {:.3g} m would take about "
                             "{:.3g} GB, more than the {:.3g} GB that it may",
                             voxel, size.x, size.y, size.z, bytes / 1e9,
                             static_cast<double>(settings.most_bytes) / 1e9),
                 "make the voxel larger, or mend the mesh's unit");
  }
  try {
    auto state = std::make_shared<BoneGrid::State>();
    state->voxel = voxel;
    state->band = band_of(voxel);
    state->lower = lower;
    state->upper = upper;
    openvdb::FloatGrid::Ptr grid = make_level_set(surface, voxel, lower, upper);
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
