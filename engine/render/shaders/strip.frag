// Strip surfaces: red belly with fibre streaks along the item, pale tendon where the tendon coordinate is negative.
#include "frame.glsl"
#include "lighting.glsl"

in vec3 position;
in vec3 normal;
in float tendon;
in vec3 circle_along;
flat in vec3 belly_colour;
flat in vec3 tendon_colour;
flat in float phase;

layout(location = 0) out vec4 colour;

#if defined(RING)
void main() { colour = vec4(tendon < 0.0 ? vec3(0.10, 0.16, 0.24) : vec3(0.02, 0.03, 0.05), 1.0); }
#else
const float kBorder = 0.002;    // m, half the width of the change from belly to tendon
const float kFibreTurns = 22.0;  // streaks around a row
const float kTwoPi = 6.2831853;

void main() {
  float width = max(kBorder, fwidth(tendon));
  float belly = frame.options.x > 0.5 ? smoothstep(-width, width, tendon) : 1.0;

  // Streaks: waves around the row that wander slowly along it; faded before they would alias.
  float angle = atan(circle_along.y, circle_along.x);
  vec2 around = circle_along.xy;
  float angle_step = length(fwidth(around)) / max(length(around), 1e-3);  // rad a pixel
  float along = circle_along.z * kTwoPi;
  float wander = 0.8 * sin(along * 1.5 + phase) + 0.5 * sin(2.0 * angle + phase);
  float coarse = sin(kFibreTurns * angle + 3.0 * wander + phase);
  float fine = sin(3.0 * kFibreTurns * angle + 7.0 * wander);
  float coarse_seen = 1.0 - smoothstep(0.6, 1.8, angle_step * kFibreTurns);
  float fine_seen = 1.0 - smoothstep(0.6, 1.8, angle_step * 3.0 * kFibreTurns);
  float streak = 0.10 * coarse * coarse_seen + 0.07 * fine * fine_seen;
  streak *= smoothstep(0.0, 0.4, length(around));  // none at a cap's centre, where the angle has no meaning

  vec3 albedo = mix(tendon_colour * (1.0 + 0.5 * streak), belly_colour * (1.0 + 1.6 * streak), belly);
  float shine = mix(0.20, 0.13, belly);
  colour = vec4(paint_back_face(shade(albedo, normalize(normal), position, 34.0, shine)), 1.0);
}
#endif
