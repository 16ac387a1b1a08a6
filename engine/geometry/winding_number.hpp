// How often a surface winds round a point: 1 inside a closed mesh, 0 outside, 2 where two shells overlap, and a
// fraction in and near meshes with holes, so that "more than a half" decides what is inside of any mesh (Jacobson,
// Kavan & Sorkine-Hornung 2013). It needs consistently oriented triangles, and nothing else.
#pragma once

#include <memory>

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

// The exact sum of the triangles' solid angles (Van Oosterom & Strackee 1983) over 4 pi: linear in their number, so the
// reference. Triangles with a corner that is not finite do not count; 0 for a point that is not finite.
double winding_number(const TriangleMesh& mesh, const glm::dvec3& point);

// The same from a tree, in the time of its depth: triangles far away count as their nodes' expansions to the second
// order (Barill et al. 2018), those nearby exactly. Thread-safe.
class WindingField {
 public:
  explicit WindingField(const TriangleMesh& mesh);
  ~WindingField();
  WindingField(WindingField&&) noexcept;
  WindingField& operator=(WindingField&&) noexcept;

  // Within 5e-3 of the exact sum; usually within 5e-4.
  double at(const glm::dvec3& point) const;
  // Winding number above a half, as the exact sum decides it: where the field is too close to say, this sums.
  bool inside(const glm::dvec3& point) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace fascicle
