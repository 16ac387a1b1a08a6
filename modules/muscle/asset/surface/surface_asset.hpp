// A surface muscle as the solver wants it: immutable, shared by all characters that have it. Lengths in metres, in the
// character's rest space.
//
// Its vertices are sorted by place, so `file_vertex` tells which vertex of the description's mesh each one is. Every
// edge of a closed mesh has two triangles: edge and dihedral angle are one *hinge* of four vertices, and one colouring
// serves both. No colour touches a vertex twice, so a colour's hinges may be solved side by side; they come in packs
// of 16, the widest lane, whose spare lanes move padding points that belong to no triangle.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/result.hpp"
#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/surface/surface_description.hpp"
#include "modules/muscle/asset/surface/vertex_rings.hpp"

namespace fascicle::muscle {

struct MuscleAsset;
struct SurfaceTree;

struct alignas(16) SurfacePoint {
  float x = 0.0f, y = 0.0f, z = 0.0f;  // m
  float inverse_mass = 0.0f;           // 1/kg; 0: attached, or padding
};
static_assert(sizeof(SurfacePoint) == 16);

inline constexpr std::size_t kHingeLanes = 16;
inline constexpr std::size_t kPaddingPoints = 4 * kHingeLanes;

// 16 hinges side by side. Vertices: p_1 and p_2 of the edge, p_3 left of it and p_4 right of it as seen from outside.
// With e = p_2 - p_1, N_1 = e x (p_3 - p_1), N_2 = (p_4 - p_1) x e, the angle is
// theta = atan2((N_1 x N_2) . e / |e|, N_1 . N_2): flat 0, a ridge negative or positive as the normals turn about e.
struct alignas(64) HingePack {
  std::array<std::array<std::int32_t, kHingeLanes>, 4> vertex;
  std::array<float, kHingeLanes> length;              // m, at rest
  std::array<float, kHingeLanes> stretch_compliance;  // m/N, alpha / k
  std::array<float, kHingeLanes> angle;               // rad, at rest
  std::array<float, kHingeLanes> bend_compliance;     // rad/(N m)
};

struct Hinge {
  std::array<std::uint32_t, 4> vertex{};
  float length = 0.0f;      // m
  float angle = 0.0f;       // rad
  float anisotropy = 1.0f;  // k
};

// What moves a vertex before the constraints refine it: up to four carriers with weights that sum to 1. A carrier is a
// bone or a section of the driving musculotendon unit.
struct CarryWeights {
  std::array<std::uint16_t, 4> carrier{};
  std::array<float, 4> weight{};
};

struct SurfaceCarrier {
  std::int32_t bone = -1;  // index into the skeleton; -1: `section`
  float section = 0.0f;    // of the driver's line, whatever its level of detail: attachment i is at i, the middle of
                           // the sections between it and the next at i + 0.5
};

struct AttachedVertex {
  std::uint32_t vertex = 0;
  std::uint32_t attachment = 0;  // index in SurfaceAsset::attachments
};

struct SurfaceAttachmentAsset {
  std::int32_t bone = -1;
  bool origin = true;
  std::uint32_t count = 0;  // vertices
};

struct SurfaceAsset {
  std::string name;
  SurfaceSettings settings;
  std::uint32_t vertex_count = 0;
  AlignedVector<SurfacePoint> rest;             // vertex_count and kPaddingPoints more
  std::vector<std::uint32_t> triangles;         // three a triangle, anticlockwise from outside
  std::vector<std::uint32_t> file_vertex;       // by vertex: its number in the description's mesh
  std::vector<Hinge> hinges;                    // one an edge: those that can move first, in the packs' order
  AlignedVector<HingePack> packs;
  std::vector<std::uint32_t> first_pack;        // by colour, and one more: their number
  VertexRings rings;                            // of the triangles, for the volume
  double volume = 0.0;                          // m^3
  double kernel_volume = 0.0;                   // m^3, six volumes, as the kernels measure it at rest
  float mean_edge = 0.0f;                       // m
  float size = 0.0f;                            // m, the diagonal of its box
  std::vector<SurfaceAttachmentAsset> attachments;
  std::vector<AttachedVertex> attached;         // by vertex, rising
  std::vector<SurfaceCarrier> carriers;
  std::vector<CarryWeights> carry;              // by vertex; empty: nothing carries it
  std::int32_t frame_bone = 0;
  std::vector<std::int32_t> bones;              // that it collides with
  std::uint32_t bone_count = 0;                 // matrices that the character must have
  std::vector<FibreLine> fibres;                // as described
  std::string driver;
  std::shared_ptr<const SurfaceTree> tree;      // for contacts with itself and with other muscles

  std::size_t triangle_count() const { return triangles.size() / 3; }
};

// Errors name the description's place: an empty or open mesh, an edge with more than two triangles or used twice in one
// direction, more than one piece, a mesh that is inside out, triangles or numbers that are none, indices out of range,
// a vertex attached twice, settings out of range, a driver that `muscles` (null: none) has not. Sound triangles that the
// constraints cannot be solved on (slivers) are no error. `bone_count`: matrices of the skeleton.
Result<std::shared_ptr<const SurfaceAsset>> build_surface_asset(const SurfaceMuscleDescription& description,
                                                                std::uint32_t bone_count,
                                                                const MuscleAsset* muscles = nullptr);

}  // namespace fascicle::muscle
