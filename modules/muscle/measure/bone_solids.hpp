// A character's bones as they are measured against: the original triangles of its bone meshes, mended, in their bones'
// frames. Made once and shared by all its muscles' levels of detail.
//
// Whether a point is inside is decided by the winding number, how deep it is by the closest point of the mesh. A grid
// of cells tells beforehand which points need not be asked.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/measure/solid_tree.hpp"

namespace fascicle::muscle {

class BoneSolid {
 public:
  explicit BoneSolid(const BoneMesh& mesh);
  ~BoneSolid();
  BoneSolid(BoneSolid&&) noexcept;

  std::int32_t bone() const { return bone_; }
  const Box& box() const { return box_; }  // m, in the bone's frame; nothing outside is inside the bone

  // How deep a point of the bone's frame is in the bone (m); any number up to `enough` where it is not deeper than
  // that.
  double depth_beyond(const glm::vec3& point, double enough) const;
  // The same without the grid, for tests.
  double exact_depth(const glm::vec3& point) const;

 private:
  struct Mesh;
  void fill_cells();
  float bound_in(const Box& box) const;

  std::int32_t bone_ = -1;
  Box box_;
  std::unique_ptr<const Mesh> mesh_;
  // By cell: 0 where it is outside of the bone; else no point of it is deeper than this, and negative where all of it
  // is inside.
  float cell_ = 0.0f;  // m, its side
  glm::ivec3 counts_{0};
  std::vector<float> cells_;
};

// Meshes without triangles are left out. Thread-safe once made.
using BoneSolids = std::vector<BoneSolid>;
std::shared_ptr<const BoneSolids> make_bone_solids(std::span<const BoneMesh> meshes);

}  // namespace fascicle::muscle
