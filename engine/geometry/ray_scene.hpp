// Lines through one triangle mesh, by Embree: where they enter it first and leave it last, and every crossing between.
//
// One line answers four rays of the method's page 2.1. Vertex i of a section with centre a and initial radius r > 0
// lies at c = a + r e. Its ray P goes from c along +e and takes the furthest back face; its ray N goes from c along -e
// and takes the closest front face; P is preferred. Let t measure the line a + t e, and call a crossing an exit where
// the surface's outward normal n has e . n > 0. A back face met along +e is an exit. A front face met along -e has
// (-e) . n < 0: it is an exit, too. So P takes the largest exit with t >= r and, where there is none, N takes the
// largest exit with t <= r: together, the exit with the largest t on the whole line, whatever r was. The new radius is
// that t with its sign: it is negative when and only when the hit was N's and lies beyond a, |p - c| > r. The opposite
// vertex looks along -e from the same centre, so its new radius is -t of the entry with the smallest t. Initial radii
// thus need not be chosen at all. (`ray_scene_test` holds this to the rules taken literally.)
//
// Embree visits each line once, 8 at a time (packets of 1, 4 and 16 and streams were slower), through a filter function
// that records and rejects. Its robust traversal lets no line slip between two triangles that share an edge; such a
// crossing may be seen twice, which extremes do not mind and which `cast_all` takes out. Through a vertex, to rounding,
// a line may still slip: lines that enter the mesh and leave it unequally often, or miss it beside lines that hit, are
// cast again, shifted by millionths of its size.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "engine/geometry/mesh_measures.hpp"

namespace fascicle {

struct Line {
  glm::vec3 origin{0.0f};                 // m, where t = 0
  glm::vec3 direction{1.0f, 0.0f, 0.0f};  // unit
};

// Along one line, over all t from minus to plus infinity.
struct LineExtremes {
  float first_entry = std::numeric_limits<float>::infinity();  // m; infinity: none
  float last_exit = -std::numeric_limits<float>::infinity();   // m; minus infinity: none
  std::uint32_t crossings = 0;  // at least as many as there are: those at shared edges may count twice
  // The line leaves before it enters, or enters after it leaves: some of the mesh is inside out. What counts then is
  // for others to say (modules/muscle/asset/fit/fit_surface.hpp).
  bool backwards = false;
};

struct LineCrossing {
  float t = 0.0f;              // m
  std::uint32_t triangle = 0;  // of the mesh
  bool exit = false;           // along the line, the mesh is left here
};

// Embree's device: the owner makes one and builds scenes with it, also from several threads at once. It starts no
// threads of its own.
class RayDevice {
 public:
  RayDevice();
  ~RayDevice();
  RayDevice(RayDevice&&) noexcept;
  RayDevice& operator=(RayDevice&&) noexcept;

 private:
  friend class RayScene;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The mesh, ready to be cast through; any number of threads may do so at once. It copies what it needs of the mesh and
// may outlive the device's owner. Vertices must be finite and triangles' indices in range.
class RayScene {
 public:
  RayScene(const RayDevice& device, const TriangleMesh& mesh);
  // The plain loop over all triangles in place of Embree (ray_reference.hpp), for tests and benchmarks.
  explicit RayScene(const TriangleMesh& mesh);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  // Of the mesh; zero for one without triangles.
  const Bounds& bounds() const;

  // One result a line. A mesh without triangles gives no hits. Lines of one call are cast in packets of 8, so
  // neighbours should resemble each other.
  void cast(std::span<const Line> lines, std::span<LineExtremes> extremes) const;

  // Every crossing of line i, by rising t, in crossings[starts[i]] .. crossings[starts[i + 1]]. Crossings of
  // neighbouring triangles at one place (a shared edge or vertex) that face the same way are given once.
  void cast_all(std::span<const Line> lines, std::vector<std::uint32_t>& starts,
                std::vector<LineCrossing>& crossings) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fascicle
