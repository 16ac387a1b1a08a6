// Landmark-based solids as signed distance functions: round cones along a polyline, ellipsoids and thick sheets, joined
// smoothly. Every bone of the walker is a list of these. Distances are exact outside one primitive and bounds
// near joins, which is enough for meshing and for pushing muscles off bones.
#pragma once

#include <variant>
#include <vector>

#include <glm/vec3.hpp>

namespace fascicle::walker {

// A landmark and the bone's radius there (m).
struct Knot {
  glm::vec3 position{0.0f};
  float radius = 0.0f;
};

struct RoundCone {
  Knot a, b;
};

// Round cones end to end: a shaft. One solid, so that its joints don't swell as a smooth union's would.
struct Tube {
  std::vector<Knot> knots;
};

struct Ellipsoid {
  glm::vec3 centre{0.0f};
  glm::vec3 radii{0.01f};
};

// A triangle thickened by a radius that varies between its corners: a piece of a bent sheet.
struct ThickTriangle {
  Knot a, b, c;
};

// A bent sheet of thick triangles.
struct Sheet {
  std::vector<ThickTriangle> pieces;
};

using Primitive = std::variant<RoundCone, Tube, Ellipsoid, ThickTriangle, Sheet>;

float distance_to(const RoundCone& cone, const glm::vec3& p);
float distance_to(const Tube& tube, const glm::vec3& p);
float distance_to(const Ellipsoid& ellipsoid, const glm::vec3& p);
float distance_to(const ThickTriangle& triangle, const glm::vec3& p);
float distance_to(const Sheet& sheet, const glm::vec3& p);

// min(a, b) rounded over the length k (m).
float smooth_min(float a, float b, float k);

// Smooth union of `added`, less the smooth union of `removed`, plus `kept`, which nothing removes.
class Solid {
 public:
  // `blend`: radius (m) of the fillets between primitives.
  explicit Solid(float blend) : blend_(blend) {}

  void add(const Primitive& primitive) { insert(added_, primitive); }
  void add_tube(const std::vector<Knot>& knots) { add(Tube{knots}); }
  void remove(const Primitive& primitive) { insert(removed_, primitive); }
  void keep(const Primitive& primitive) { insert(kept_, primitive); }

  // Signed distance (m), negative inside.
  float distance(const glm::vec3& p) const;
  // Unit direction of growing distance.
  glm::vec3 outward(const glm::vec3& p) const;
  glm::vec3 low() const { return low_; }
  glm::vec3 high() const { return high_; }

 private:
  struct Bounded {
    Primitive primitive;
    glm::vec3 centre{0.0f};
    float radius = 0.0f;  // m, of a sphere around the primitive
  };
  void insert(std::vector<Bounded>& list, const Primitive& primitive);
  static float join(const std::vector<Bounded>& list, const glm::vec3& p, float blend);

  float blend_;
  std::vector<Bounded> added_, removed_, kept_;
  glm::vec3 low_{1e9f}, high_{-1e9f};
};

}  // namespace fascicle::walker
