#include "tools/walker/shapes.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle::walker {
namespace {

struct Bounds {
  glm::vec3 low, high;
};

Bounds bounds_of(const Knot& a) { return {a.position - a.radius, a.position + a.radius}; }
Bounds merge(const Bounds& a, const Bounds& b) { return {glm::min(a.low, b.low), glm::max(a.high, b.high)}; }

Bounds bounds_of(const RoundCone& cone) { return merge(bounds_of(cone.a), bounds_of(cone.b)); }
Bounds bounds_of(const ThickTriangle& piece) {
  return merge(merge(bounds_of(piece.a), bounds_of(piece.b)), bounds_of(piece.c));
}
Bounds bounds_of(const Ellipsoid& ellipsoid) {
  return {ellipsoid.centre - ellipsoid.radii, ellipsoid.centre + ellipsoid.radii};
}
Bounds bounds_of(const Tube& tube) {
  Bounds bounds = bounds_of(tube.knots.front());
  for (const Knot& knot : tube.knots) bounds = merge(bounds, bounds_of(knot));
  return bounds;
}
Bounds bounds_of(const Sheet& sheet) {
  Bounds bounds = bounds_of(sheet.pieces.front());
  for (const ThickTriangle& piece : sheet.pieces) bounds = merge(bounds, bounds_of(piece));
  return bounds;
}

}  // namespace

float distance_to(const RoundCone& cone, const glm::vec3& p) {
  const glm::vec3 axis = cone.b.position - cone.a.position;
  const float t = std::clamp(glm::dot(p - cone.a.position, axis) / std::max(glm::dot(axis, axis), 1e-12f), 0.0f, 1.0f);
  return glm::distance(p, cone.a.position + t * axis) - (cone.a.radius + t * (cone.b.radius - cone.a.radius));
}

float distance_to(const Tube& tube, const glm::vec3& p) {
  float d = 1e9f;
  for (std::size_t i = 0; i + 1 < tube.knots.size(); ++i)
    d = std::min(d, distance_to(RoundCone{tube.knots[i], tube.knots[i + 1]}, p));
  return d;
}

float distance_to(const Sheet& sheet, const glm::vec3& p) {
  float d = 1e9f;
  for (const ThickTriangle& piece : sheet.pieces) d = std::min(d, distance_to(piece, p));
  return d;
}

float distance_to(const Ellipsoid& ellipsoid, const glm::vec3& p) {
  const glm::vec3 q = p - ellipsoid.centre;
  const float k0 = glm::length(q / ellipsoid.radii);
  const float k1 = glm::length(q / (ellipsoid.radii * ellipsoid.radii));
  if (k1 < 1e-9f) return -std::min({ellipsoid.radii.x, ellipsoid.radii.y, ellipsoid.radii.z});
  return k0 * (k0 - 1.0f) / k1;
}

// Nearest point of a triangle by Voronoi regions (Ericson, Real-Time Collision Detection, 5.1.5).
float distance_to(const ThickTriangle& triangle, const glm::vec3& p) {
  const glm::vec3 a = triangle.a.position, b = triangle.b.position, c = triangle.c.position;
  const glm::vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap), d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  const float va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  float v = 0.0f, w = 0.0f;
  if (d1 <= 0.0f && d2 <= 0.0f) {
  } else if (d3 >= 0.0f && d4 <= d3) {
    v = 1.0f;
  } else if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) {
    v = d1 / (d1 - d3);
  } else if (d6 >= 0.0f && d5 <= d6) {
    w = 1.0f;
  } else if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) {
    w = d2 / (d2 - d6);
  } else if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) {
    w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    v = 1.0f - w;
  } else {
    v = vb / (va + vb + vc);
    w = vc / (va + vb + vc);
  }
  const float radius = triangle.a.radius * (1.0f - v - w) + triangle.b.radius * v + triangle.c.radius * w;
  return glm::distance(p, a + v * ab + w * ac) - radius;
}

float smooth_min(float a, float b, float k) {
  const float h = std::max(k - std::abs(a - b), 0.0f) / k;
  return std::min(a, b) - h * h * k * 0.25f;
}

void Solid::insert(std::vector<Bounded>& list, const Primitive& primitive) {
  const Bounds bounds = std::visit([](const auto& shape) { return bounds_of(shape); }, primitive);
  list.push_back({primitive, 0.5f * (bounds.low + bounds.high), 0.5f * glm::distance(bounds.low, bounds.high)});
  if (&list == &removed_) return;
  low_ = glm::min(low_, bounds.low);
  high_ = glm::max(high_, bounds.high);
}

float Solid::join(const std::vector<Bounded>& list, const glm::vec3& p, float blend) {
  float d = 1e9f;
  for (const Bounded& item : list) {
    if (glm::distance(p, item.centre) - item.radius > d + blend) continue;  // too far to matter
    d = smooth_min(d, std::visit([&p](const auto& shape) { return distance_to(shape, p); }, item.primitive), blend);
  }
  return d;
}

float Solid::distance(const glm::vec3& p) const {
  float d = join(added_, p, blend_);
  if (!removed_.empty()) d = -smooth_min(-d, join(removed_, p, blend_), 0.5f * blend_);
  if (!kept_.empty()) d = smooth_min(d, join(kept_, p, blend_), blend_);
  return d;
}

glm::vec3 Solid::outward(const glm::vec3& p) const {
  constexpr float kStep = 0.0005f;
  glm::vec3 gradient(0.0f);
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 offset(0.0f);
    offset[axis] = kStep;
    gradient[axis] = distance(p + offset) - distance(p - offset);
  }
  const float length = glm::length(gradient);
  return length > 1e-9f ? gradient / length : glm::vec3(0.0f, 1.0f, 0.0f);
}

}  // namespace fascicle::walker
