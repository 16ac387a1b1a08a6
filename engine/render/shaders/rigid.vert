// Rigid meshes: one matrix an instance, interpolated between the last two steps.
#include "frame.glsl"

layout(location = 0) in vec3 mesh_position;
layout(location = 1) in vec4 mesh_normal;
layout(location = 2) in uvec2 instance;  // matrix index; 1 where it is interpolated

layout(std430, binding = 0) readonly buffer PreviousMatrices { mat4 previous_matrices[]; };
layout(std430, binding = 1) readonly buffer CurrentMatrices { mat4 current_matrices[]; };

#if !defined(DEPTH_ONLY)
out vec3 position;
out vec3 normal;
#endif

void main() {
  mat4 matrix = current_matrices[instance.x];
  if (instance.y != 0u) {
    float alpha = frame.eye_alpha.w;
    matrix = previous_matrices[instance.x] * (1.0 - alpha) + matrix * alpha;
  }
  vec4 world = matrix * vec4(mesh_position, 1.0);
#if defined(DEPTH_ONLY)
  gl_Position = frame.light_matrix * world;
#else
  // Cofactors turn normals rightly under uneven scale and mirroring.
  mat3 m = mat3(matrix);
  mat3 cofactors = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
  normal = cofactors * mesh_normal.xyz;
  position = world.xyz;
  gl_Position = frame.view_projection * world;
#endif
}
