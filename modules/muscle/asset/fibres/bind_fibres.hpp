// Binds points inside a closed mesh to its vertices, so that they stay inside while it deforms: see fibre_bundle.hpp.
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/kernels/surface/place_fibres.hpp"

namespace fascicle::muscle {

// One binding a point; at rest it gives the point back to rounding. A point that is not inside, or sees no surface
// across it, is bound to the triangle next to it alone.
AlignedVector<FibreBinding> bind_fibres(const TriangleMesh& mesh, std::span<const glm::dvec3> points);

}  // namespace fascicle::muscle
