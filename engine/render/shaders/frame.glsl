// What every shader of a frame shares. Mirrors FrameUniforms in frame_uniforms.hpp.
layout(std140, binding = 0) uniform Frame {
  mat4 view_projection;   // world to clip
  mat4 light_matrix;      // world to the shadow map's clip space
  vec4 eye_alpha;         // camera position (m); w: interpolation between the last two steps
  vec4 key_direction;     // unit, towards the light; w: 1 where there is a shadow map
  vec4 fill_direction;    // unit, towards the light that goes with the camera
  vec4 background;        // linear colour; w: radius (m) at which the ground has faded out
  vec4 mesh_colour;       // linear; w: opacity of surfaces
  vec4 skin_colour;       // linear; w: opacity
  vec4 target;            // what the camera looks at (m); w: 1 when back faces are painted
  vec4 options;           // x: tendons told apart; y: opacity of hidden lines; z: shadow map texel; w: scale of points
} frame;

// sRGB colour packed in four bytes, R lowest, to linear.
vec4 unpack_srgb(uint packed_colour) {
  vec4 c = unpackUnorm4x8(packed_colour);
  return vec4(pow(c.rgb, vec3(2.2)), c.a);
}
