// Transversal constraints (3.1, thesis 4.1.1): a line between a tagged vertex of muscle x and one of muscle y that face
// each other. Its interior angle at x's tag lies between the line and the way to x's centre. Where it is acute, y's tag
// is past x's surface, by rho_x along that way; likewise at y.
//
//   angles acute     the thesis                  ours
//   both             rho_x + rho_y               their mean: for tags that face each other each is the overlap
//   one              that one's rho              half of it, so that the depth does not jump as an angle turns blunt
//   none             no collision                no collision
//
// Each angle tests a half-space only, so ours also asks that the tags face each other: beside the way to the centre
// they must be less than that radius apart, at both ends.
#pragma once

#include <glm/vec3.hpp>

namespace fascicle::muscle {

// One end of a transversal, in any space.
struct TransversalEnd {
  glm::vec3 tag{0.0f};     // m, kappa: the tagged vertex c_i
  glm::vec3 centre{0.0f};  // m, a_k of its section
};

// What one end sees of the other's tag.
struct TransversalAngle {
  bool acute = false;
  float depth = 0.0f;          // m, rho; 0 where not acute
  float lateral = 0.0f;        // m, from the tag's radius to the other tag, square to it
  float radius = 0.0f;         // m, |a_k - c_i|
  glm::vec3 inward{0.0f};      // unit, from the tag to the centre; zero where the radius is
};

struct TransversalDepth {
  TransversalAngle x, y;
  bool touches = false;  // an angle is acute
  float thesis = 0.0f;   // m, rho_x + rho_y
  float overlap = 0.0f;  // m, ours; 0 where the tags do not face each other
};

// A point of a bone in place of y's tag has no centre: give its own place as that. Its angle counts as blunt then, and
// x's depth alone is the overlap.
TransversalDepth measure_transversal(const TransversalEnd& x, const TransversalEnd& y);

// (4.4): sections whose depth is larger than the radius have swapped sides, or one has swallowed the other. Their
// centre goes onto the line from the tag through it, at the depth's distance from the tag as that is now. Returns what
// to move the centre by (m); zero up to a depth of the radius.
glm::vec3 transversal_displacement(const TransversalAngle& angle, float depth);

}  // namespace fascicle::muscle
