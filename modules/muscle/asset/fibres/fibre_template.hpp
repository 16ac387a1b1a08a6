// Arrangements of fibres in the unit cylinder (4.4): x and y in the unit disc, z from the origin (0) to the insertion
// (1). Any number of fibres, each a cubic Bezier curve; a muscle's contours carry them into the muscle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "modules/muscle/asset/surface/surface_description.hpp"

namespace fascicle::muscle {

struct TemplateFibre {
  std::array<glm::dvec3, 4> control{};

  glm::dvec3 at(double t) const;  // t = 0: its end at the origin
};

// The disc's outermost share is left free, so that fibres are inside the muscle and not on its surface.
inline constexpr double kTemplateRadius = 0.96;

// `count` points spread evenly over the disc of kTemplateRadius.
std::vector<glm::dvec2> spread_over_disc(std::uint32_t count);

// Parallel: straight along z, spread evenly.
// Fan: straight from all over the disc at the origin to a quarter of it at the insertion.
// Pennate: straight from the side -x to the side +x, `slope` of x for each z (tan of the pennation times the muscle's
// length by half its width across x), spread evenly over every cross-section; those that would begin before the origin
// or end after the insertion are cut there. A slope of 0 is parallel.
std::vector<TemplateFibre> make_template(FibreArrangement arrangement, std::uint32_t count, double slope);

}  // namespace fascicle::muscle
