#include "frame.glsl"

in vec4 line_colour;

layout(location = 0) out vec4 colour;

void main() {
  colour = line_colour;
#if defined(POINT)
  vec2 from_centre = 2.0 * gl_PointCoord - 1.0;
  float radius = length(from_centre);
  colour.a *= 1.0 - smoothstep(1.0 - fwidth(radius), 1.0, radius);
#endif
#if defined(THROUGH)
  colour.a *= frame.options.y;
#endif
  if (colour.a <= 0.0) discard;
}
