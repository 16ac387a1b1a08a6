// The frames of a line's sections at rest (1.2), in double precision: what build_frames gives the same line, to a
// float's rounding. The fit casts in these planes, so that the fitted radii mean the same to the built muscle.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace fascicle::muscle {

struct SectionFrame {
  glm::dvec3 centre{0.0};                         // m, a_k
  glm::dvec3 tangent{0.0}, u{0.0}, v{0.0};        // unit, square to each other; v = tangent x u
};

// Normals of the first and the last section, where an attachment area gives them; unit.
using EndNormals = std::array<std::optional<glm::dvec3>, 2>;

// One frame a point, at least 2. `origin_bone`: the linear part of the origin bone's rest matrix, for u_0.
void rest_frames(std::span<const glm::dvec3> points, const glm::dmat3& origin_bone, const EndNormals& end_normals,
                 std::vector<SectionFrame>& frames);

}  // namespace fascicle::muscle
