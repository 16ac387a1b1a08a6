// Strip surfaces: interpolates a vertex between the last two steps and looks up its row and item.
#include "frame.glsl"

layout(location = 0) in vec3 previous_position;
layout(location = 1) in vec4 previous_normal;
layout(location = 2) in vec3 current_position;
layout(location = 3) in vec4 current_normal;
layout(location = 4) in uvec4 instance_first;  // row, item, vertex, vertex info
layout(location = 5) in uint instance_interpolated;

struct Info { uint row; uint circle; float along; };
struct Row { float tendon; uint item; };
struct Item { uint belly; uint tendon; float activation; uint flags; };
layout(std430, binding = 0) readonly buffer Infos { Info infos[]; };
layout(std430, binding = 1) readonly buffer PreviousRows { Row previous_rows[]; };
layout(std430, binding = 2) readonly buffer CurrentRows { Row current_rows[]; };
layout(std430, binding = 3) readonly buffer Items { Item items[]; };

const uint kHidden = 1u, kHighlighted = 2u, kTeleported = 4u;

#if !defined(DEPTH_ONLY)
out vec3 position;
out vec3 normal;
out float tendon;
out vec3 circle_along;  // cosine and sine of the angle around the row; fraction along the item
flat out vec3 belly_colour;
flat out vec3 tendon_colour;
flat out float phase;
#endif

void main() {
  Info info = infos[uint(gl_VertexID) - instance_first.z + instance_first.w];
  Row row = current_rows[instance_first.x + info.row];
  uint item_index = instance_first.y + row.item;
  Item item = items[item_index];
  bool interpolated = instance_interpolated != 0u && (item.flags & kTeleported) == 0u;
  float alpha = interpolated ? frame.eye_alpha.w : 1.0;
  vec3 world = interpolated ? mix(previous_position, current_position, alpha) : current_position;

#if defined(DEPTH_ONLY)
  gl_Position = frame.light_matrix * vec4(world, 1.0);
#else
  vec3 old_normal = interpolated ? previous_normal.xyz : current_normal.xyz;
  normal = mix(old_normal, current_normal.xyz, alpha);
  float old_tendon = interpolated ? previous_rows[instance_first.x + info.row].tendon : row.tendon;
  tendon = mix(old_tendon, row.tendon, alpha);
  circle_along = vec3(unpackSnorm2x16(info.circle), info.along);
  position = world;
  belly_colour = unpack_srgb(item.belly).rgb;
  tendon_colour = unpack_srgb(item.tendon).rgb;
  float activation = clamp(item.activation, 0.0, 1.0);
  belly_colour = mix(belly_colour, min(belly_colour * 1.5 + vec3(0.05, 0.0, 0.0), 1.0), activation);
  if ((item.flags & kHighlighted) != 0u) {
    belly_colour = mix(belly_colour, vec3(0.95, 0.62, 0.08), 0.6);
    tendon_colour = mix(tendon_colour, vec3(1.0, 0.80, 0.30), 0.6);
  }
  phase = float(item_index % 64u) * 0.7;
#if defined(RING)
  world += 0.0004 * normal;  // lifts the outline off the surface
#endif
  gl_Position = frame.view_projection * vec4(world, 1.0);
#endif
  // Hidden items leave the clip volume.
  if ((item.flags & kHidden) != 0u) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
