// Mean value coordinates of points beside a closed triangle mesh (Ju, Schaefer and Warren 2005): weights of the mesh's
// vertices that sum to 1 and reproduce the point, and with it every affine motion. They are defined everywhere: on
// faces, edges and vertices they become those of the face, edge or vertex. Beside concave parts some are negative.
//
// They are found in double precision. A row whose sum misses 1, or its point, by more than 1e-12 (of the hull's size)
// is corrected by the change that is least in the sum of squares; the hull of a closed mesh hardly ever needs it, one
// with holes does. So only rounding to float is left: half a last digit a weight, about 1e-7 of the size a point.
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle::muscle {

// Row-major, points x hull vertices: weights[i * n + j] is point i's of vertex j. In parallel; the same bits for any
// number of threads. Every vertex weighs the same for a hull without an area, or one with places that are not finite,
// and for points that have no coordinates: not finite ones, or where those of a mesh that is not closed cancel.
// Triangles that name a vertex twice, or one that is not there, do not count.
void find_mean_value_coordinates(const TriangleMesh& hull, std::span<const glm::vec3> points, std::span<float> weights);

}  // namespace fascicle::muscle
