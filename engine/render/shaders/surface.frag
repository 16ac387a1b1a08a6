// Surfaces: the colours and the light of strip surfaces' items, opaque or as a shell around what is inside.
#include "frame.glsl"
#include "lighting.glsl"

in vec3 position;
in vec3 normal;
in float tendon;
flat in float highlight;

layout(location = 0) out vec4 colour;

// As StripItem's defaults, sRGB.
const uint kBelly = 0xff282a98u, kTendon = 0xffc4dbe8u;

void main() {
  float share = frame.options.x > 0.5 ? smoothstep(0.15, 0.85, tendon) : 0.0;
  vec3 belly = mix(unpack_srgb(kBelly).rgb, vec3(0.95, 0.62, 0.08), 0.6 * highlight);
  vec3 albedo = mix(belly, unpack_srgb(kTendon).rgb, share);
  vec3 unit = normalize(normal);
  vec3 shaded = shade(albedo, unit, position, 34.0, mix(0.13, 0.20, share));
  float facing = clamp(abs(dot(unit, normalize(frame.eye_alpha.xyz - position))), 0.0, 1.0);
  colour = vec4(paint_back_face(shaded), shell_opacity(frame.mesh_colour.w, facing));
}
