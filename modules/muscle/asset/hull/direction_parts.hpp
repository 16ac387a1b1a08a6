// The main direction (4.5): the muscle is cut into parts along its action line, and the differences between the centres
// of neighbouring parts go as the line's do. Differences, not places, so that the line says where the muscle points and
// how it is stretched along itself, and not how far from the line it lies.
//
// Internal to asset/hull: it shows Eigen.
#pragma once

#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "modules/muscle/asset/hull/hull_asset.hpp"

namespace fascicle::muscle {

struct DirectionParts {
  std::vector<float> along;                                          // 0..1 of the rest line's length: parts' centres
  Eigen::SparseMatrix<double, Eigen::RowMajor> differences{0, 0};    // one fewer than parts, x vertices
};

DirectionParts find_direction_parts(const SurfaceAsset& surface, std::span<const HullLinePoint> line);

}  // namespace fascicle::muscle
