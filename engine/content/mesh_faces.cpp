#include "engine/content/mesh_faces.hpp"

namespace fascicle {
namespace {

void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::vector<std::uint32_t>& indices) {
  if (a == b || b == c || c == a) return;
  for (const std::uint32_t corner : {a, b, c}) indices.push_back(corner);
}

}  // namespace

void add_polygon(std::span<const std::uint32_t> corners, std::vector<std::uint32_t>& indices) {
  for (std::size_t k = 2; k < corners.size(); ++k) add_triangle(corners[0], corners[k - 1], corners[k], indices);
}

void add_strip(std::span<const std::uint32_t> corners, std::vector<std::uint32_t>& indices) {
  for (std::size_t k = 2; k < corners.size(); ++k) {
    const bool odd = k % 2 == 1;
    add_triangle(corners[odd ? k - 1 : k - 2], corners[odd ? k - 2 : k - 1], corners[k], indices);
  }
}

}  // namespace fascicle
