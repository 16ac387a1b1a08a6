#include "engine/render/camera.hpp"

#include <algorithm>
#include <cmath>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "engine/render/input.hpp"

namespace fascicle {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kMaxPitch = 89.0f * kPi / 180.0f;
constexpr float kMinDistance = 0.02f;   // m
constexpr float kMaxDistance = 200.0f;  // m
constexpr float kZoomPerNotch = 0.12f;  // of the distance's logarithm
constexpr float kZoomPerDrag = 3.0f;    // the same, for a drag over the viewport's height

glm::vec3 direction_to_eye(const OrbitCamera& camera) {
  const float level = std::cos(camera.pitch);
  return {std::sin(camera.yaw) * level, std::sin(camera.pitch), std::cos(camera.yaw) * level};
}

}  // namespace

bool InputState::was_pressed(Key key) const {
  return std::find(pressed.begin(), pressed.end(), key) != pressed.end();
}

glm::vec3 OrbitCamera::eye() const { return target + distance * direction_to_eye(*this); }

glm::mat4 OrbitCamera::view() const { return glm::lookAtRH(eye(), target, glm::vec3(0.0f, 1.0f, 0.0f)); }

glm::mat4 OrbitCamera::projection(float aspect) const {
  const float near_plane = std::max(0.02f * distance, 0.004f);
  return glm::perspectiveRH_NO(fov, aspect, near_plane, distance + std::max(40.0f, 4.0f * distance));
}

void apply_input(const InputState& input, const glm::vec2& viewport, OrbitCamera& camera) {
  if (!(viewport.x > 0.0f) || !(viewport.y > 0.0f)) return;
  const glm::vec2 drag = input.mouse_delta / viewport.y;
  const bool left = input.held(MouseButton::left);
  if (input.held(MouseButton::middle) || (left && input.shift)) {
    const glm::vec3 forward = -direction_to_eye(camera);
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0.0f, 1.0f, 0.0f)));
    const glm::vec3 up = glm::cross(right, forward);
    const float height = 2.0f * camera.distance * std::tan(0.5f * camera.fov);  // of the view at the target, m
    camera.target += height * (-drag.x * right + drag.y * up);
  } else if (left) {
    camera.yaw = std::remainder(camera.yaw - drag.x * kPi, 2.0f * kPi);
    camera.pitch += drag.y * kPi;
  }
  float zoom = -kZoomPerNotch * input.scroll.y;
  if (input.held(MouseButton::right)) zoom += kZoomPerDrag * drag.y;
  camera.distance = std::clamp(camera.distance * std::exp(zoom), kMinDistance, kMaxDistance);
  camera.pitch = std::clamp(camera.pitch, -kMaxPitch, kMaxPitch);
}

void frame_box(const glm::vec3& low, const glm::vec3& high, float aspect, OrbitCamera& camera) {
  constexpr float kMargin = 1.1f;
  const float radius = 0.5f * glm::length(high - low);
  const float half_angle = std::atan(std::tan(0.5f * camera.fov) * std::min(aspect, 1.0f));
  camera.target = 0.5f * (low + high);
  camera.distance = std::clamp(kMargin * radius / std::sin(half_angle), kMinDistance, kMaxDistance);
}

}  // namespace fascicle
