#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "modules/muscle/asset/bone_fields/grid_state.hpp"

namespace fascicle::muscle {

namespace {

using Accessor = openvdb::FloatGrid::ConstAccessor;

// Whether the brick holds something that is asked for exactly.
bool copy_brick(Accessor& voxels, const openvdb::Coord& first, float exact, float* samples) {
  bool wanted = false;
  openvdb::Coord at;
  for (at.x() = first.x(); at.x() < first.x() + kBrickSamples; ++at.x()) {
    for (at.y() = first.y(); at.y() < first.y() + kBrickSamples; ++at.y()) {
      for (at.z() = first.z(); at.z() < first.z() + kBrickSamples; ++at.z()) {
        const float value = voxels.getValue(at);
        wanted = wanted || value < exact;
        *samples++ = value;
      }
    }
  }
  return wanted;
}

// Whether any of the leaves that a brick reaches into is there.
bool any_leaf(Accessor& voxels, const openvdb::Coord& first) {
  for (int corner = 0; corner < 8; ++corner) {
    const openvdb::Coord at = first.offsetBy((corner & 4) != 0 ? kBrickCells : 0, (corner & 2) != 0 ? kBrickCells : 0,
                                             (corner & 1) != 0 ? kBrickCells : 0);
    if (voxels.probeConstLeaf(at) != nullptr) return true;
  }
  return false;
}

}  // namespace

BoneField flatten(const BoneGrid& bone) {
  const BoneGrid::State& state = bone.state();
  const float reach = sample_reach(state.voxel);
  BoneSamples field;
  field.voxel = state.voxel;
  field.band = state.band;
  field.lower = state.lower;
  field.upper = state.upper;
  openvdb::Coord first;
  for (int axis = 0; axis < 3; ++axis) {
    const float begin = std::floor((state.lower[axis] - reach) / state.voxel);
    const float end = std::ceil((state.upper[axis] + reach) / state.voxel);
    first[axis] = static_cast<int>(begin);
    field.count[axis] = static_cast<int>(std::ceil((end - begin) / kBrickCells));
    field.origin[axis] = begin * state.voxel;
  }
  Accessor voxels = state.grid->getConstAccessor();
  std::array<float, kSamplesPerBrick> samples;
  std::uint32_t number = 0;
  for (int i = 0; i < field.count.x; ++i) {
    for (int j = 0; j < field.count.y; ++j) {
      for (int k = 0; k < field.count.z; ++k, ++number) {
        const openvdb::Coord corner = first.offsetBy(i * kBrickCells, j * kBrickCells, k * kBrickCells);
        if (!any_leaf(voxels, corner)) continue;
        if (!copy_brick(voxels, corner, state.band + state.voxel, samples.data())) continue;
        field.bricks.push_back(number);
        field.samples.insert(field.samples.end(), samples.begin(), samples.end());
      }
    }
  }
  return BoneField(std::move(field));
}

}  // namespace fascicle::muscle
