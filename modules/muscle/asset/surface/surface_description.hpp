// What a surface muscle is before it is built: a closed mesh that deforms as a whole, its attachments to bones, the
// fibres on it and how stiff it is. Fields of a content file, or what a program fills in by hand; `build_surface_asset`
// turns a description into the immutable, solver-ready SurfaceAsset.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle::muscle {

// Vertices that follow one bone with infinite mass, at the places that they have at rest.
struct SurfaceAttachment {
  std::int32_t bone = -1;                // index into the skeleton
  bool origin = true;                    // else: insertion. Only fibres ask.
  std::vector<std::uint32_t> vertices;   // of the description's mesh; each in one attachment at most
};

// Fibres given on the muscle's surface or near it, for anisotropy and for the surface-fibre method (4.4).
struct FibreLine {
  std::vector<glm::vec3> points;         // m, rest space; 2 or more, from the origin to the insertion where known
  std::uint32_t head = 0;
};

// The fibres inside a muscle (4.4), that asset/fibres/ makes when it is asked to.
enum class FibreMethod {
  kIsocontour,  // from origin and insertion alone, by a template carried along a harmonic field; one head
  kSurface,     // from the fibres given on the surface (SurfaceMuscleDescription::fibres), any number of heads
};
enum class FibreArrangement { kParallel, kPennate, kFan };  // the isocontour method's templates
struct FibreBundleSettings {
  FibreMethod method = FibreMethod::kIsocontour;
  FibreArrangement arrangement = FibreArrangement::kParallel;
  std::uint32_t count = 1000;            // fibres, 1..100000
  std::uint32_t points = 10;             // of each, 2..1000
  float pennation = 0.35f;               // rad, between fibres and the muscle's line; kPennate alone asks
};

// Compliances are those of XPBD: what a constraint of the muscle's mass gives way, whatever the substeps. Zero is rigid.
struct SurfaceSettings {
  std::uint32_t substeps = 5;            // a step
  float density = 1060.0f;               // kg/m^3
  float stretch_compliance = 0.15f;      // m/N, of an edge across the fibres
  float along_fibres = 0.2f;             // 0..1: the least k = 1 - |u . v| (4.1); an edge's compliance is alpha / k
  float bend_compliance = 1.0e5f;        // rad/(N m), of a dihedral angle
  float volume_compliance = 0.0f;        // m^3/Pa
  float anchor_compliance = 1500.0f;     // m/N, of what holds a vertex where its carriers bring it: fascia, neighbours.
                                         // 0: nothing does
  float damping = 2.0f;                  // 1/s: velocities beside the bones' fade by exp(-damping t)
  float viscosity = 60.0f;               // 1/s: velocities' differences along edges fade
  float contact_distance = 0.0012f;      // m from bones at which vertices are kept
  float friction = 0.0f;                 // Coulomb's coefficient against bones
  bool collide_with_bones = true;
  bool collide_with_itself = false;
  bool collide_with_muscles = true;      // other surface muscles of the character
};

// How a muscle's shape is found.
enum class SurfaceSolver {
  kDynamic,     // position based dynamics, step after step (4.1)
  kCoarseHull,  // from the pose alone, by a coarse hull and Gauss-Newton (4.5)
};

// One level of detail: how a muscle is solved while it is at least so large in the picture.
struct SurfaceLevel {
  SurfaceSolver solver = SurfaceSolver::kDynamic;
  float above_pixels = 0.0f;             // pixels, the muscle's size in the picture; the last level: 0
  std::uint32_t refinements = 2;         // of the coarse hull's result, in place of HullSettings'
};

// The coarse-hull solver's (4.5). Weights are beside the shape's own, which is 1.
struct HullSettings {
  std::uint32_t vertices = 300;          // of the hull, at most
  float error = 0.0f;                    // m: how far the hull may be from the mesh; 0: as far as it must
  std::uint32_t iterations = 10;         // Gauss-Newton's, at most
  float tolerance = 1.0e-4f;             // of the muscle's size: an iteration that moves less is the last
  std::uint32_t refinements = 2;         // iterations on the full mesh; 0: none
  float bending = 1.0f;                  // weight of the Laplacian coordinates beside that of the edges
  float direction = 1.0f;                // weight of the main direction
};

// A point of the muscle's line, from its origin to its insertion.
struct ActionLinePoint {
  std::int32_t bone = -1;                // index into the skeleton: the point goes with it
  glm::vec3 position{0.0f};              // m, in the character's rest space
};

struct SurfaceMuscleDescription {
  std::string name;
  TriangleMesh mesh;                     // m, in the character's rest space: closed, orientable, one piece
  std::vector<SurfaceAttachment> attachments;  // may be empty: a free body
  std::int32_t frame_bone = 0;           // the simulation's frame: the muscle moves with it at no cost
  std::vector<std::int32_t> bones;       // that it collides with; those without a field are passed over
  std::vector<FibreLine> fibres;
  std::optional<FibreBundleSettings> fibre_bundle;  // inner fibres; none: the muscle has none
  std::string driver;                    // name of the musculotendon unit that carries it; empty: its bones do
  SurfaceSettings settings;
  std::vector<SurfaceLevel> levels{{}};  // finest first; never empty
  HullSettings hull;
  std::vector<ActionLinePoint> action_line;  // the coarse hull's main direction; empty: the driver's line
  Diagnostic where;                      // file, line, column and path to quote in errors; empty: made in code
};

}  // namespace fascicle::muscle
