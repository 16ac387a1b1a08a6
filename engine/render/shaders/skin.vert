// Skins and surfaces: vertices that the simulation deforms, interpolated between the last two steps. The depth pass and
// the colour pass must agree to the last bit.
#include "frame.glsl"

layout(location = 0) in vec3 previous_position;
layout(location = 1) in vec4 previous_normal;
layout(location = 2) in vec3 current_position;
layout(location = 3) in vec4 current_normal;
layout(location = 4) in uint instance_flags;

const uint kInterpolated = 1u, kHighlighted = 2u;

invariant gl_Position;
out vec3 position;
out vec3 normal;
out float tendon;  // the surfaces' only: 1 on vertices that are tendon
flat out float highlight;

void main() {
  bool interpolated = (instance_flags & kInterpolated) != 0u;
  position = interpolated ? mix(previous_position, current_position, frame.eye_alpha.w) : current_position;
  normal = interpolated ? mix(previous_normal.xyz, current_normal.xyz, frame.eye_alpha.w) : current_normal.xyz;
  tendon = current_normal.w;
  highlight = (instance_flags & kHighlighted) != 0u ? 1.0 : 0.0;
#if defined(DEPTH_ONLY)
  gl_Position = frame.light_matrix * vec4(position, 1.0);
#else
  gl_Position = frame.view_projection * vec4(position, 1.0);
#endif
}
