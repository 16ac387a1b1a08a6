// The ground: one square around what the camera looks at, in the plane y = 0.
#include "frame.glsl"

out vec3 position;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  position = vec3(frame.target.x, 0.0, frame.target.z) + frame.background.w * vec3(corner.x, 0.0, corner.y);
  gl_Position = frame.view_projection * vec4(position, 1.0);
}
