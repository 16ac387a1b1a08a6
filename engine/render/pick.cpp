#include "engine/render/pick.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace fascicle {
namespace {

constexpr float kClickPixels = 5.0f;  // a hand's tremble

}  // namespace

Ray ray_through(const OrbitCamera& camera, const glm::vec2& pixel, const glm::vec2& viewport) {
  const bool any = viewport.x > 0.0f && viewport.y > 0.0f;
  const glm::vec2 at = any ? 2.0f * pixel / viewport - 1.0f : glm::vec2(0.0f);
  const float aspect = any ? viewport.x / viewport.y : 1.0f;
  const float slope = std::tan(0.5f * camera.fov);
  const glm::vec3 in_view = glm::normalize(glm::vec3(at.x * slope * aspect, -at.y * slope, -1.0f));
  return {camera.eye(), glm::transpose(glm::mat3(camera.view())) * in_view};
}

std::optional<float> hit_triangle(const Ray& ray, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 along = b - a, across = c - a;
  const glm::vec3 p = glm::cross(ray.direction, across);
  const float determinant = glm::dot(along, p);
  if (determinant == 0.0f) return std::nullopt;
  const glm::vec3 from = ray.origin - a;
  const float u = glm::dot(from, p) / determinant;
  if (!(u >= 0.0f && u <= 1.0f)) return std::nullopt;
  const glm::vec3 q = glm::cross(from, along);
  const float v = glm::dot(ray.direction, q) / determinant;
  if (!(v >= 0.0f && u + v <= 1.0f)) return std::nullopt;
  const float t = glm::dot(across, q) / determinant;
  if (!(t > 0.0f) || !std::isfinite(t)) return std::nullopt;
  return t;
}

std::optional<float> hit_mesh(const Ray& ray, const TriangleMesh& mesh, const glm::mat4& to_world) {
  // In the mesh's space the direction keeps its length's change, so that t stays that of the world.
  const glm::mat4 to_mesh = glm::inverse(to_world);
  const Ray local{glm::vec3(to_mesh * glm::vec4(ray.origin, 1.0f)), glm::mat3(to_mesh) * ray.direction};
  std::optional<float> nearest;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto t = hit_triangle(local, mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]],
                                mesh.positions[mesh.indices[i + 2]]);
    if (t && (!nearest || *t < *nearest)) nearest = t;
  }
  return nearest;
}

std::optional<glm::vec2> ClickTracker::update(const InputState& input, bool blocked) {
  const bool held = input.held(MouseButton::left);
  const bool ended = held_ && !held && counts_;
  if (held && !held_) {
    start_ = input.mouse;
    counts_ = !blocked && !input.shift;  // with shift the camera pans
  }
  const glm::vec2 way = input.mouse - start_;
  if (glm::dot(way, way) > kClickPixels * kClickPixels) counts_ = false;
  held_ = held;
  if (!ended || !counts_) return std::nullopt;
  return input.mouse;
}

}  // namespace fascicle
