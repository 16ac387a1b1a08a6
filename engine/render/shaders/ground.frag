// The ground: a grid of 0.1 m and 1 m, the shadow of what stands on it, fading into the background.
#include "frame.glsl"

in vec3 position;

layout(location = 0) out vec4 colour;
layout(binding = 0) uniform sampler2DShadow shadow_map;

float grid(vec2 at, float spacing, float half_width) {
  vec2 cell = at / spacing;
  vec2 pixel = fwidth(cell);
  vec2 distance_to_line = abs(fract(cell - 0.5) - 0.5);
  vec2 line = 1.0 - smoothstep(half_width * pixel, (half_width + 1.0) * pixel, distance_to_line);
  vec2 seen = 1.0 - smoothstep(0.15, 0.5, pixel);  // gone before it would alias
  line *= seen;
  return max(line.x, line.y);
}

float lit() {
  if (frame.key_direction.w < 0.5) return 1.0;
  vec3 at = (frame.light_matrix * vec4(position, 1.0)).xyz * 0.5 + 0.5;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
  vec3 aside = vec3(0.8, 0.4, 0.0) * frame.options.z;  // two taps, each of four texels
  return 0.5 * (texture(shadow_map, at + aside) + texture(shadow_map, at - aside));
}

void main() {
  float from_target = distance(position.xz, frame.target.xz) / frame.background.w;
  float seen = 1.0 - smoothstep(0.25, 1.0, from_target);
  vec3 floor_colour = frame.background.rgb * 1.35 + 0.01;
  float line = max(0.25 * grid(position.xz, 0.1, 0.2), grid(position.xz, 1.0, 0.6));
  vec3 shaded = mix(floor_colour, floor_colour * 1.9 + 0.02, line);
  shaded *= mix(0.42, 1.0, lit());
  colour = vec4(mix(frame.background.rgb, shaded, seen), 1.0);
}
