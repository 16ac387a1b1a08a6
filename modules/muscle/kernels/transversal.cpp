#include "modules/muscle/kernels/transversal.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

TransversalAngle measure_angle(const TransversalEnd& end, const glm::vec3& other_tag) {
  TransversalAngle angle;
  const glm::vec3 radial = end.centre - end.tag, across = other_tag - end.tag;
  angle.radius = glm::length(radial);
  if (!(angle.radius > 0.0f)) return angle;
  angle.inward = radial / angle.radius;
  const float along = glm::dot(across, angle.inward);
  angle.lateral = glm::length(across - along * angle.inward);
  angle.acute = along > 0.0f;
  angle.depth = angle.acute ? along : 0.0f;
  return angle;
}

bool faces(const TransversalAngle& angle) { return angle.radius == 0.0f || angle.lateral < angle.radius; }

}  // namespace

TransversalDepth measure_transversal(const TransversalEnd& x, const TransversalEnd& y) {
  TransversalDepth result{.x = measure_angle(x, y.tag), .y = measure_angle(y, x.tag)};
  result.touches = result.x.acute || result.y.acute;
  result.thesis = result.x.depth + result.y.depth;
  const bool both = result.x.radius > 0.0f && result.y.radius > 0.0f;
  if (faces(result.x) && faces(result.y)) result.overlap = both ? 0.5f * result.thesis : result.thesis;
  return result;
}

glm::vec3 transversal_displacement(const TransversalAngle& angle, float depth) {
  if (!(depth > angle.radius) || !std::isfinite(depth)) return glm::vec3(0.0f);
  return (depth - angle.radius) * angle.inward;
}

}  // namespace fascicle::muscle
