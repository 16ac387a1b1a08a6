#include "engine/render/frame_uniforms.hpp"

#include <algorithm>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "engine/render/renderer.hpp"

namespace fascicle {
namespace {

const glm::vec3 kKeyDirection = glm::normalize(glm::vec3(0.45f, 0.80f, 0.50f));  // world, towards the light

// An orthographic view along the key light, wide enough for what the camera looks at.
glm::mat4 make_light_matrix(const OrbitCamera& camera) {
  const float half_width = std::clamp(0.8f * camera.distance, 1.2f, 16.0f);  // m
  const float depth = 4.0f * half_width;
  const glm::vec3 centre(camera.target.x, 0.3f, camera.target.z);
  const glm::mat4 view =
      glm::lookAtRH(centre + 0.5f * depth * kKeyDirection, centre, glm::vec3(0.0f, 1.0f, 0.0f));
  return glm::orthoRH_NO(-half_width, half_width, -half_width, half_width, 0.0f, depth) * view;
}

}  // namespace

FrameUniforms make_frame_uniforms(const DrawView& view, float aspect, int shadow_size) {
  const OrbitCamera& camera = view.camera;
  const glm::mat4 to_camera = camera.view();
  FrameUniforms frame;
  frame.view_projection = camera.projection(aspect) * to_camera;
  frame.light_matrix = make_light_matrix(camera);
  frame.eye_alpha = glm::vec4(camera.eye(), std::clamp(view.alpha, 0.0f, 1.0f));
  frame.key_direction = glm::vec4(kKeyDirection, shadow_size > 0 ? 1.0f : 0.0f);
  // From the camera's upper left, so that forms turn dark towards their outlines.
  const glm::vec3 fill = glm::transpose(glm::mat3(to_camera)) * glm::normalize(glm::vec3(-0.35f, 0.25f, 0.9f));
  frame.fill_direction = glm::vec4(fill, 0.0f);
  frame.background = glm::vec4(view.background, std::max(12.0f, 5.0f * camera.distance));
  frame.mesh_colour = glm::vec4(view.mesh_colour, 1.0f);
  frame.skin_colour = glm::vec4(view.skin_colour, std::clamp(view.skin_opacity, 0.0f, 1.0f));
  frame.target = glm::vec4(camera.target, view.back_faces ? 1.0f : 0.0f);
  frame.options = glm::vec4(view.tendons ? 1.0f : 0.0f, std::clamp(view.lines_through, 0.0f, 1.0f),
                            shadow_size > 0 ? 1.0f / static_cast<float>(shadow_size) : 0.0f, view.point_scale);
  return frame;
}

}  // namespace fascicle
