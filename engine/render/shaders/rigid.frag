#include "frame.glsl"
#include "lighting.glsl"

in vec3 position;
in vec3 normal;

layout(location = 0) out vec4 colour;

void main() {
  vec3 shaded = shade(frame.mesh_colour.rgb, normalize(normal), position, 24.0, 0.07);
  colour = vec4(paint_back_face(shaded), 1.0);
}
