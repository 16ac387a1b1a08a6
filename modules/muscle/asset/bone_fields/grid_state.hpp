// What a BoneGrid holds. Only this folder's sources include it: it brings OpenVDB's headers.
#pragma once

#include <glm/vec3.hpp>
#include <openvdb/openvdb.h>

#include "modules/muscle/asset/bone_fields/bone_grid.hpp"

namespace fascicle::muscle {

struct BoneGrid::State {
  // Index space is the bone's frame in voxels. Active: all voxels nearer to the surface than the background, and all
  // inside. The background, `sample_reach`, is less than any distance that it stands for.
  openvdb::FloatGrid::ConstPtr grid;
  float voxel = 0.0f, band = 0.0f;     // m
  glm::vec3 lower{0.0f}, upper{0.0f};  // m: the surface's box
};

// m
inline float band_of(float voxel) { return std::max(0.010f, 4.0f * voxel); }
// m: cells that begin within the band end at less.
inline float sample_reach(float voxel) { return band_of(voxel) + 2.0f * voxel; }

// Registers what OpenVDB needs registered; cheap after the first time.
void start_openvdb();

}  // namespace fascicle::muscle
