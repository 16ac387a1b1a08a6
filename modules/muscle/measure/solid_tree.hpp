// A closed triangle surface that may move, for two questions: does it wind round a point, and how far inside is that?
// The tree is built once; `move` keeps its shape and takes over new places of the vertices, so that a muscle's surface
// costs no new tree each frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "engine/geometry/triangle_tree.hpp"

namespace fascicle::muscle {

struct Box {
  glm::vec3 lower{0.0f}, upper{0.0f};  // m

  void add(const glm::vec3& point);
  void add(const Box& box);
  bool contains(const glm::vec3& point) const;
  bool meets(const Box& other) const;
};
// A box that contains nothing, to be added to.
Box empty_box();

class SolidTree {
 public:
  // Indices must be in range; triangles that are not finite are left out for good.
  explicit SolidTree(const TriangleMesh& mesh);

  // New places of all vertices, finite.
  void move(std::span<const glm::vec3> positions);

  Box box() const;

  // How often the surface winds round the point: its signed crossings with the ray along +z. For a closed surface that
  // is the winding number, however it overlaps itself; on the surface itself it is the number on one of its sides. No
  // ray slips between two triangles that share an edge.
  int windings(const glm::vec3& point) const;

  // The distance to the nearest triangle (m), or any number up to `enough` where it is not more than that.
  double distance_beyond(const glm::vec3& point, double enough) const;

 private:
  TriangleTree tree_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace fascicle::muscle
