#include "modules/muscle/asset/fit/rest_frames.hpp"

#include <cmath>

#include <glm/geometric.hpp>

#include "modules/muscle/asset/rest_reference.hpp"

namespace fascicle::muscle {
namespace {

// As in kernels/build_frames.hpp, where they are explained.
constexpr double kShortestStepSquared = 1.0e-10;  // m^2
constexpr double kSquareChord = 0.01;
constexpr double kSameTangent = 1.0e-8;

glm::dvec3 mirrored(const glm::dvec3& a, const glm::dvec3& mirror, double squared) {
  return a - (2.0 / squared * glm::dot(mirror, a)) * mirror;
}

// `r`, square to `t`, carried along `step` to the tangent `next_t`.
glm::dvec3 carry(const glm::dvec3& r, const glm::dvec3& t, const glm::dvec3& step, const glm::dvec3& next_t) {
  const double squared = glm::dot(step, step), along = glm::dot(step, t);
  const bool usable = squared > kShortestStepSquared && along * along > kSquareChord * squared;
  const glm::dvec3 mirror = usable ? step : t;
  const double mirror_squared = usable ? squared : 1.0;
  const glm::dvec3 reflected = mirrored(r, mirror, mirror_squared);
  const glm::dvec3 second = next_t - mirrored(t, mirror, mirror_squared);
  const double second_squared = glm::dot(second, second);
  return second_squared > kSameTangent ? mirrored(reflected, second, second_squared) : reflected;
}

}  // namespace

void rest_frames(std::span<const glm::dvec3> points, const glm::dmat3& origin_bone, const EndNormals& end_normals,
                 std::vector<SectionFrame>& frames) {
  frames.resize(points.size());
  const std::size_t last = points.size() - 1;
  const glm::dvec3 first_step = points[1] - points[0];
  glm::dvec3 t = glm::dot(first_step, first_step) > 0.0 ? glm::normalize(first_step) : glm::dvec3(1.0, 0.0, 0.0);
  if (end_normals[0]) t = *end_normals[0];
  glm::dvec3 r = rest_reference(origin_bone, t);
  for (std::size_t k = 0; k <= last; ++k) {
    const glm::dvec3& before = points[k > 0 ? k - 1 : 0];
    const glm::dvec3 chord = points[k < last ? k + 1 : k] - before;
    const double squared = glm::dot(chord, chord);
    glm::dvec3 next_t = squared > kShortestStepSquared ? chord / std::sqrt(squared) : t;
    if (k == 0 && end_normals[0]) next_t = *end_normals[0];
    if (k == last && end_normals[1]) next_t = *end_normals[1];
    r = carry(r, t, points[k] - before, next_t);
    t = next_t;
    const glm::dvec3 u = glm::normalize(r - glm::dot(r, t) * t);
    frames[k] = {points[k], t, u, glm::cross(t, u)};
  }
}

}  // namespace fascicle::muscle
