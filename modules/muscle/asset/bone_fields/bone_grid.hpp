// A bone's level set as OpenVDB holds it: sparse, in metres, in the bone's frame, negative inside; what is built from
// meshes, stored in files, and flattened to the form that is asked at run time. OpenVDB's own types stay inside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/asset/collision/bone_field.hpp"

namespace fascicle::muscle {

struct BoneGridSettings {
  float voxel = 0.002f;                             // m
  std::size_t most_bytes = std::size_t{1} << 30;    // that a grid may take while it is built
};

class BoneGrid {
 public:
  struct State;

  explicit BoneGrid(std::shared_ptr<const State> state) : state_(std::move(state)) {}
  const State& state() const { return *state_; }
  std::size_t active_voxels() const;
  std::size_t bytes() const;

 private:
  std::shared_ptr<const State> state_;
};

// From one or several meshes in the bone's frame (m). They may overlap, have triangles turned the wrong way, and holes.
// `name` is what errors call the bone. Errors: no triangles, a voxel that is not positive, or so small that the grid
// would take more than it may. The same bits for any number of threads.
Result<BoneGrid> build_bone_grid(std::span<const TriangleMesh> meshes, const std::string& name,
                                 const BoneGridSettings& settings = {});

BoneField flatten(const BoneGrid& grid);

// Both at once.
Result<std::shared_ptr<const BoneField>> build_bone_field(std::span<const TriangleMesh> meshes,
                                                          const std::string& name,
                                                          const BoneGridSettings& settings = {});

}  // namespace fascicle::muscle
