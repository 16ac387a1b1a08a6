// Lines and points, interpolated between the last two steps where the instance says so.
#include "frame.glsl"

layout(location = 0) in vec3 previous_position;
layout(location = 1) in vec3 current_position;
layout(location = 2) in vec4 vertex_colour;
layout(location = 3) in uint instance_flags;  // 1: interpolated
layout(location = 4) in float point_size;

out vec4 line_colour;

void main() {
  bool interpolated = (instance_flags & 1u) != 0u;
  vec3 world = interpolated ? mix(previous_position, current_position, frame.eye_alpha.w) : current_position;
  line_colour = vec4(pow(vertex_colour.rgb, vec3(2.2)), vertex_colour.a);
  gl_Position = frame.view_projection * vec4(world, 1.0);
  gl_PointSize = point_size * frame.options.w;
}
