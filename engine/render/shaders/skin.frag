// Skins: denser where seen at a grazing angle, as a shell of glass is, so that the outline reads at any opacity.
#include "frame.glsl"
#include "lighting.glsl"

in vec3 position;
in vec3 normal;

layout(location = 0) out vec4 colour;

void main() {
  vec3 unit = normalize(normal);
  vec3 to_eye = normalize(frame.eye_alpha.xyz - position);
  float facing = clamp(abs(dot(unit, to_eye)), 0.0, 1.0);
  float grazing = 1.0 - facing;
  float opacity = frame.skin_colour.w;
  vec3 shaded = shade(frame.skin_colour.rgb, unit, position, 20.0, 0.06);
  shaded += (1.0 - opacity) * 0.18 * grazing * grazing * vec3(0.9, 0.95, 1.0);
  colour = vec4(paint_back_face(shaded), shell_opacity(opacity, facing));
}
