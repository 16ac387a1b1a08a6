// What the iterations in the hull's space need, reduced to the hull once: the shape's energy with its factorised
// matrix, attachments, the main direction, samples (HullAsset).
//
// Internal to asset/hull: it shows Eigen.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <glm/vec3.hpp>

#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/asset/hull/shape_energy.hpp"

namespace fascicle::muscle {

// A matrix as the kernels want it.
DenseRows to_dense_rows(const Eigen::MatrixXd& matrix);

// Fills in `weights`' users: samples, shape, attachments and direction of an asset that has settings, line and samples'
// vertices. `weights`: W, vertices x hull. False where the energy does not tell where the hull is.
bool reduce_to_hull(const SurfaceAsset& surface, const ShapeEnergy& energy, const Eigen::MatrixXd& weights,
                    HullAsset& asset);

}  // namespace fascicle::muscle
