// What all shaders of a frame share; mirrors the block in shaders/frame.glsl.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace fascicle {

struct DrawView;

struct FrameUniforms {
  glm::mat4 view_projection{1.0f};
  glm::mat4 light_matrix{1.0f};
  glm::vec4 eye_alpha{0.0f};
  glm::vec4 key_direction{0.0f};
  glm::vec4 fill_direction{0.0f};
  glm::vec4 background{0.0f};
  glm::vec4 mesh_colour{0.0f};
  glm::vec4 skin_colour{0.0f};
  glm::vec4 target{0.0f};
  glm::vec4 options{0.0f};
};
static_assert(sizeof(FrameUniforms) == 256);

// `aspect`: width over height. `shadow_size`: pixels a side of the shadow map, 0 for none.
FrameUniforms make_frame_uniforms(const DrawView& view, float aspect, int shadow_size);

}  // namespace fascicle
