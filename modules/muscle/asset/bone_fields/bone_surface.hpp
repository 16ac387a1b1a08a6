// A bone's meshes as one closed surface. Bone files come open, inside out in places, and in parts that overlap.
#pragma once

#include <span>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle::muscle {

struct BoneSurface {
  // For winding numbers. Every edge has as many triangles one way as the other: holes are capped by a fan about the
  // middle of their rim, so the winding number is whole everywhere and changes at triangles only.
  TriangleMesh closed;
  // For distances: the part of it that has the outside on one side. Where shells overlap or lie in each other the
  // walls between them are no surface of the bone, and nothing should be pushed to them.
  TriangleMesh outer;
};

// `voxel` (m): triangles that are partly buried are cut into pieces of about its size.
BoneSurface make_bone_surface(std::span<const TriangleMesh> meshes, float voxel);

}  // namespace fascicle::muscle
