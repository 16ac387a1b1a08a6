// An indexed triangle mesh as readers return it: plain arrays, no topology.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace fascicle {

struct TriangleMesh {
  std::string name;
  std::vector<glm::vec3> positions;    // metres, in the frame that the owner states
  std::vector<glm::vec3> normals;      // unit, one a vertex; empty where the file has none
  std::vector<std::uint32_t> indices;  // three a triangle, anticlockwise seen from outside
};

}  // namespace fascicle
