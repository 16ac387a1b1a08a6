// Where the vertices of a muscle's sections start to be counted: the direction u_0 at rest, shared by the builder and
// the fit, which must see the same frames.
#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace fascicle::muscle {

// A direction square to the unit vector `tangent`: the z axis of the origin's bone (the linear part of its rest
// matrix) or, for lines that run along it, its y axis. The bone's axes and not the world's, so that a muscle does not
// change when the whole character is turned.
inline glm::dvec3 rest_reference(const glm::dmat3& origin_bone, const glm::dvec3& tangent) {
  const glm::dvec3 z = glm::normalize(origin_bone[2]);
  const glm::dvec3 axis = std::abs(glm::dot(z, tangent)) < 0.9 ? z : glm::normalize(origin_bone[1]);
  return glm::normalize(axis - glm::dot(axis, tangent) * tangent);
}

}  // namespace fascicle::muscle
