// The muscle of the examples: a prism of 10 cm, its ends' vertices apart.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace readme {

struct Prism {
  fascicle::TriangleMesh mesh;
  std::vector<std::uint32_t> lower, upper;

  Prism() {
    constexpr std::uint32_t kSides = 4, kLayers = 5;
    for (std::uint32_t layer = 0; layer <= kLayers; ++layer) {
      for (const glm::vec2 corner : {glm::vec2(1, 1), glm::vec2(-1, 1), glm::vec2(-1, -1), glm::vec2(1, -1)}) {
        mesh.positions.emplace_back(0.01f * corner.x, 0.01f * corner.y, 0.02f * static_cast<float>(layer));
      }
    }
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    };
    for (std::uint32_t layer = 0; layer < kLayers; ++layer) {
      for (std::uint32_t i = 0; i < kSides; ++i) {
        const std::uint32_t a = kSides * layer + i, b = kSides * layer + (i + 1) % kSides;
        quad(a, b, b + kSides, a + kSides);
      }
    }
    const std::uint32_t top = kSides * kLayers;
    quad(3, 2, 1, 0);
    quad(top, top + 1, top + 2, top + 3);
    lower = {0, 1, 2, 3};
    upper = {top, top + 1, top + 2, top + 3};
  }
};

}  // namespace readme
