// An orbit camera: it looks at a target from a distance along yaw and pitch. World axes: y up, metres.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace fascicle {

struct InputState;

struct OrbitCamera {
  glm::vec3 target{0.0f, 0.7f, 0.0f};  // m
  float distance = 2.6f;               // m
  float yaw = 0.6f;                    // rad; 0 looks from +z towards -z, positive moves the eye towards +x
  float pitch = 0.1f;                  // rad; positive looks down
  float fov = 0.7f;                    // rad, vertical

  glm::vec3 eye() const;
  glm::mat4 view() const;
  // Depth -1..1; near and far planes follow the distance.
  glm::mat4 projection(float aspect) const;
};

// Left drag orbits, middle drag (or shift and left drag) pans, right drag or the wheel zooms. `viewport` in pixels.
// Values stay finite and in range: distance 0.02..200 m, pitch within 89 degrees.
void apply_input(const InputState& input, const glm::vec2& viewport, OrbitCamera& camera);

// Moves target and distance so that the box is in view from the same direction.
void frame_box(const glm::vec3& low, const glm::vec3& high, float aspect, OrbitCamera& camera);

}  // namespace fascicle
