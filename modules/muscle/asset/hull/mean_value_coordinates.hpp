// Mean value coordinates of points beside a closed triangle mesh (Ju, Schaefer and Warren 2005): weights of the mesh's
// vertices that sum to 1 and reproduce the point, and with it every affine motion. They are defined everywhere: on
// faces, edges and vertices they become those of the face, edge or vertex. Beside concave parts some are negative.
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle::muscle {

// Row-major, points x hull vertices: weights[i * n + j] is point i's of vertex j. In parallel; the same bits for any
// number of threads. A hull without an area gives every vertex the same weight.
void find_mean_value_coordinates(const TriangleMesh& hull, std::span<const glm::vec3> points, std::span<float> weights);

}  // namespace fascicle::muscle
