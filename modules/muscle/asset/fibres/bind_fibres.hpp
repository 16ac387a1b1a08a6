// Binds points inside a closed mesh to its vertices, so that they stay inside while it deforms.
//
// Through a point runs a chord from a vertex v on the further side to a place h of the triangle on the nearer one. A
// point of a straight chord would leave the muscle where its faces slide over each other round a bend: so the chord is
// a parabola that leaves h in the triangle's own frame, always inwards, and ends at v,
//   p = s^2 h + 2 s u (h + m) + u^2 v,   s = 1 - u,
// m half of v - h at rest, its part along the triangle going with the triangle's corners and its part across it with
// the normal. At rest that is the chord. It is linear in the vertices but for the normal: four weights and a rise. Of
// all chords the one is taken that is shortest and meets both faces squarely.
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
