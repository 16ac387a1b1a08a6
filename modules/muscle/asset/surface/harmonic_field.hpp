// Harmonic fields on a closed triangle mesh (4.4): the smooth functions that are given at some vertices and have no
// extrema elsewhere. Used for the fibres' isocontours and for how far a bone's motion carries a muscle's vertices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/result.hpp"

namespace fascicle::muscle {

// Solves L f = 0 at all vertices that are not fixed, L the Laplacian with cotangent weights, none below a small
// positive share of the mean so that every value lies between the given ones (a maximum principle even on bad
// triangles). `fixed[v]` nonzero: f is given at v by `values`. `values` holds one or more fields of a value per vertex,
// one after the other; the answer likewise, with the free ones filled in. One factorisation serves all fields.
// Errors: no vertex is fixed, a free vertex that no path of edges joins to a fixed one, values that are not finite.
Result<std::vector<float>> solve_harmonic(std::span<const glm::vec3> positions,
                                          std::span<const std::uint32_t> triangles,
                                          std::span<const std::uint8_t> fixed, std::span<const float> values);

}  // namespace fascicle::muscle
