#include "modules/muscle/measure/bone_solids.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/winding_number.hpp"
#include "engine/parallel/for_range.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kSmallestCell = 0.004f;  // m
constexpr float kMostCells = 5.0e5f;     // larger ones where they would be more than about this many
constexpr int kBlock = 4;                // cells along a block's side: most blocks are decided as one

TriangleMesh in_bone_frame(const BoneMesh& mesh) {
  TriangleMesh moved;
  moved.indices = mesh.mesh->indices;
  moved.positions.reserve(mesh.mesh->positions.size());
  for (const glm::vec3& p : mesh.mesh->positions) moved.positions.emplace_back(mesh.transform * glm::vec4(p, 1.0f));
  return moved;
}

}  // namespace

struct BoneSolid::Mesh {
  explicit Mesh(const CleanMesh& clean)
      : tree(clean.mesh), winding(clean.mesh), closed(clean.defects.closed()) {}

  // Winding number above a half. A closed mesh is wound round as often as a ray crosses it, which is far quicker to
  // count; the solid angles' sum is for meshes with holes and doubtful edges.
  bool inside(const glm::vec3& point) const {
    return closed ? tree.windings(point) > 0 : winding.inside(glm::dvec3(point));
  }

  SolidTree tree;
  WindingField winding;
  bool closed;
};

BoneSolid::~BoneSolid() = default;
BoneSolid::BoneSolid(BoneSolid&&) noexcept = default;

BoneSolid::BoneSolid(const BoneMesh& mesh) : bone_(mesh.bone) {
  mesh_ = std::make_unique<const Mesh>(clean_mesh(in_bone_frame(mesh)));
  box_ = mesh_->tree.box();
  fill_cells();
}

// What a cell of that box holds.
float BoneSolid::bound_in(const Box& box) const {
  const glm::vec3 middle = 0.5f * (box.lower + box.upper);
  const float reach = 1.001f * glm::distance(middle, box.upper);
  const auto distance = static_cast<float>(mesh_->tree.distance_beyond(middle, 0.0));
  // The surface of a closed mesh alone parts inside from outside. Elsewhere the winding number is a harmonic function
  // away from the triangles: by Harnack's inequality it stays below a half within half the way to them where it is
  // below 1/12 in the middle, and above a half likewise.
  if (mesh_->closed) {
    if (distance > reach) return mesh_->inside(middle) ? -(distance + reach) : 0.0f;
  } else if (distance > 2.0f * reach) {
    const double winding = mesh_->winding.at(glm::dvec3(middle));
    if (winding < 0.07) return 0.0f;
    if (winding > 0.93) return -(distance + reach);
  }
  return distance + reach;
}

void BoneSolid::fill_cells() {
  const glm::vec3 size = box_.upper - box_.lower;
  cell_ = std::max(kSmallestCell, std::cbrt(size.x * size.y * size.z / kMostCells));
  counts_ = glm::max(glm::ivec3(glm::ceil(size / cell_)), 1);
  const glm::ivec3 blocks = (counts_ + kBlock - 1) / kBlock;
  cells_.assign(static_cast<std::size_t>(counts_.x) * static_cast<std::size_t>(counts_.y) *
                    static_cast<std::size_t>(counts_.z),
                0.0f);
  const auto box_of = [&](const glm::ivec3& cell, int length) {
    const glm::vec3 lower = box_.lower + cell_ * glm::vec3(cell);
    return Box{lower, lower + cell_ * static_cast<float>(length)};
  };
  const auto fill_block = [&](const glm::ivec3& block) {
    const glm::ivec3 first = kBlock * block, end = glm::min(first + kBlock, counts_);
    const float whole = bound_in(box_of(first, kBlock));
    for (int z = first.z; z < end.z; ++z) {
      for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) {
          const auto cell = static_cast<std::size_t>((z * counts_.y + y) * counts_.x + x);
          cells_[cell] = whole <= 0.0f ? whole : bound_in(box_of({x, y, z}, 1));
        }
      }
    }
  };
  parallel::for_range(static_cast<std::size_t>(blocks.z), 1, [&](std::size_t begin, std::size_t end) {
    for (auto z = static_cast<int>(begin); z < static_cast<int>(end); ++z) {
      for (int y = 0; y < blocks.y; ++y) {
        for (int x = 0; x < blocks.x; ++x) fill_block({x, y, z});
      }
    }
  });
}

double BoneSolid::depth_beyond(const glm::vec3& point, double enough) const {
  if (!box_.contains(point)) return 0.0;
  const glm::ivec3 cell = glm::clamp(glm::ivec3((point - box_.lower) / cell_), glm::ivec3(0), counts_ - 1);
  const float bound = cells_[static_cast<std::size_t>((cell.z * counts_.y + cell.y) * counts_.x + cell.x)];
  if (bound == 0.0f || static_cast<double>(std::abs(bound)) <= enough) return 0.0;
  const double distance = mesh_->tree.distance_beyond(point, enough);
  if (distance <= enough) return 0.0;
  return bound < 0.0f || mesh_->inside(point) ? distance : 0.0;
}

double BoneSolid::exact_depth(const glm::vec3& point) const {
  return mesh_->winding.inside(glm::dvec3(point)) ? mesh_->tree.distance_beyond(point, 0.0) : 0.0;
}

std::shared_ptr<const BoneSolids> make_bone_solids(std::span<const BoneMesh> meshes) {
  auto solids = std::make_shared<BoneSolids>();
  for (const BoneMesh& mesh : meshes) {
    if (mesh.bone < 0 || mesh.mesh == nullptr || mesh.mesh->indices.empty()) continue;
    BoneSolid solid(mesh);
    if (solid.box().lower.x <= solid.box().upper.x) solids->push_back(std::move(solid));
  }
  return solids;
}

}  // namespace fascicle::muscle
