// A surface muscle's coarse hull as the solver wants it (4.5): the hull, the full mesh as weights of it, and everything
// that one iteration needs reduced to the hull beforehand. Immutable, shared. Lengths in metres, in the character's rest
// space.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/kernels/hull/hull_kernels.hpp"

namespace fascicle::muscle {

// A point of the muscle's line: it goes with a bone, or with one of the surface asset's carriers.
struct HullLinePoint {
  glm::vec3 rest{0.0f};
  std::int32_t bone = -1;     // index into the skeleton; -1: `carrier`
  std::uint32_t carrier = 0;  // index in SurfaceAsset::carriers
};

// The vertices of the full mesh that the iterations in the hull's space look at, with triangles of their own that have
// nearly the full mesh's volume. W_s: the samples' rows of W.
struct HullSamples {
  std::vector<std::uint32_t> vertices;   // of the full mesh, rising
  std::vector<std::uint32_t> triangles;  // of samples, three each
  std::vector<std::uint32_t> cluster;    // by sample
  double volume = 0.0;                   // m^3, at rest
  DenseRows weights;                     // W_s
  DenseRows gather;                      // W_s^T
  AlignedVector<float> rows, solutions;  // samples x hull, a row after the other: W_s, and A^-1 W_s^T
};

// The shape's energy reduced to displacements U of the hull (shape_energy.hpp):
//   E(U) = <U, A U> - 2 <U, load> - 2 sum over clusters of (<R, S> - tr S),   S = S_0 + (K^T U of the cluster)
// where R is the rotation nearest to S. Its half gradient is A U - K (R - 1) - load.
struct HullShape {
  std::uint32_t clusters = 0;            // a multiple of 16; those that make it so are empty
  std::vector<std::uint32_t> cluster;    // by vertex of the full mesh: the hull vertex that weighs most for it
  DenseRows stiffness, inverse;          // A, A^-1: hull x hull
  DenseRows spread, gather;              // K^T: 3 clusters x hull, a row for each column of S; K
  std::vector<MatrixPack> rest;          // S_0, by cluster
  std::vector<CarryWeights> carry;       // by cluster; empty: nothing carries it
};

// What an attachment that has moved by T adds to the load: its rows times those of (T - 1)^T.
struct HullAttachment {
  DenseRows load;  // hull x 4
};

// The main direction: differences between the centres of the muscle's parts along its line are to go with the line's.
struct HullDirection {
  std::vector<float> along;              // of the rest line's length, 0..1: the parts' centres
  std::vector<glm::vec3> rest;           // m, by difference: between the centres, at rest
  std::vector<glm::vec3> line;           // m, likewise: between the line's places there, at rest
  DenseRows load;                        // hull x differences
};

// The full mesh, for the last iterations: the same energy with a rotation a vertex, attached vertices held, and a weak
// pull to where the hull brought each vertex, so that what is decided in the large stays.
struct HullFullMesh {
  double volume = 0.0;                   // m^3, at rest as the solver measures it
  std::vector<std::uint32_t> first, neighbour;  // by vertex, and one more: its neighbours
  std::vector<float> weight;             // by neighbour: w_ij
  AlignedVector<SurfacePoint> curvature; // 1/m, at rest: (L V)_i / m_i; in place of a mass: 1 / m_i (1/m^2)
  float bending = 0.0f;                  // m^2
  float anchor = 0.0f;                   // 1/m^2: the pull is anchor m_i
  SparseFactor factor;                   // of the free vertices; `order` gives the vertex of each row
  std::vector<std::uint32_t> beside;     // free vertices that are near attached ones, rising
};

struct HullAsset {
  HullSettings settings;
  std::vector<SurfaceLevel> levels;      // finest first
  std::vector<glm::vec3> rest;           // the hull's vertices
  std::vector<std::uint32_t> triangles;  // of the hull
  std::vector<HullLinePoint> line;       // 2 or more
  DenseRows weights;                     // W: full mesh = W * hull
  HullSamples samples;
  HullShape shape;
  std::vector<HullAttachment> attachments;  // as SurfaceAsset's
  HullDirection direction;
  HullFullMesh full;
};

// `surface` was built from `description`; `hull` encloses its mesh (build_progressive_hull); `muscles` has the driver.
// Errors: a hull that is no closed mesh, does not belong to the muscle (the coordinates do not reproduce its mesh), or
// is too large; no action line; a line without a length; settings out of range; no attachment at all.
Result<std::shared_ptr<const HullAsset>> build_hull_asset(const SurfaceAsset& surface,
                                                          const SurfaceMuscleDescription& description,
                                                          const TriangleMesh& hull,
                                                          const MuscleAsset* muscles = nullptr);

}  // namespace fascicle::muscle
