#include "engine/render/draw_types.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <glm/geometric.hpp>

namespace fascicle {
namespace {

constexpr float kNormalScale = 511.0f;  // 10 bits, two's complement, symmetric: -511..511

std::uint32_t pack_component(float value) {
  const int whole = static_cast<int>(std::lround(std::clamp(value, -1.0f, 1.0f) * kNormalScale));
  return static_cast<std::uint32_t>(whole) & 0x3ffu;
}

float unpack_component(std::uint32_t bits) {
  const int whole = static_cast<int>(bits & 0x3ffu);
  const int value = whole >= 512 ? whole - 1024 : whole;
  return std::max(static_cast<float>(value) / kNormalScale, -1.0f);
}

}  // namespace

std::uint32_t pack_normal(const glm::vec3& normal) {
  const float length = glm::length(normal);
  if (!(length > 0.0f) || !std::isfinite(length)) return pack_component(1.0f) << 10;
  const glm::vec3 unit = normal / length;
  return pack_component(unit.x) | pack_component(unit.y) << 10 | pack_component(unit.z) << 20;
}

glm::vec3 unpack_normal(std::uint32_t packed) {
  return {unpack_component(packed), unpack_component(packed >> 10), unpack_component(packed >> 20)};
}

void pack_vertices(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                   std::span<DrawVertex> vertices) {
  assert(positions.size() == vertices.size());
  assert(normals.empty() || normals.size() == vertices.size());
  const glm::vec3 up(0.0f, 1.0f, 0.0f);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i] = {positions[i], pack_normal(normals.empty() ? up : normals[i])};
  }
}

std::uint32_t pack_colour(const glm::vec4& srgb) {
  std::uint32_t packed = 0;
  for (int i = 0; i < 4; ++i) {
    const float value = std::clamp(srgb[i], 0.0f, 1.0f) * 255.0f;
    packed |= static_cast<std::uint32_t>(std::lround(value)) << (8 * i);
  }
  return packed;
}

}  // namespace fascicle
