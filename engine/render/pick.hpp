// What the user points at: the ray behind a pixel, what it meets, and when a press of the button is a click.
#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "engine/render/camera.hpp"
#include "engine/render/input.hpp"

namespace fascicle {

struct Ray {
  glm::vec3 origin{0.0f};                  // m, world
  glm::vec3 direction{0.0f, 0.0f, -1.0f};  // unit
};

// Through a pixel of a picture of `viewport` pixels; both counted from the top left. A viewport without pixels gives
// the ray through the middle.
Ray ray_through(const OrbitCamera& camera, const glm::vec2& pixel, const glm::vec2& viewport);

// How far along the ray (m, > 0) a triangle is, from either side; nothing where it is missed or has no area.
std::optional<float> hit_triangle(const Ray& ray, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

// How far along the ray (m) the nearest triangle of a mesh is, which `to_world` places; it may scale.
std::optional<float> hit_mesh(const Ray& ray, const TriangleMesh& mesh, const glm::mat4& to_world);

// A press of the left button that ends near where it began is a click; with more way it was a drag.
class ClickTracker {
 public:
  // Once a frame. `blocked`: the pointer is somebody else's (the overlay's). Where a click has just ended.
  std::optional<glm::vec2> update(const InputState& input, bool blocked);

 private:
  bool held_ = false, counts_ = false;
  glm::vec2 start_{0.0f};
};

}  // namespace fascicle
