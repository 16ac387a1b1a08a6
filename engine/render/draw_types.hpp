// The plain data that a game hands to the renderer: vertices, rows, items, colours and handles. No GL in here, so that
// systems which fill these arrays need no context.
//
// A "strip surface" is a tube drawn as rows of vertices joined by triangle strips and closed by fans. Each row knows a
// signed coordinate (tendon) and the item that it belongs to; each item has a colour, an activation and flags.
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace fascicle {

// Restarts a strip or fan inside an index buffer.
inline constexpr std::uint32_t kPrimitiveRestart = 0xffffffffu;

// 16 bytes: a position (m, world space) and a unit normal packed as GL_INT_2_10_10_10_REV. On a surface kTendonVertex
// in the normal's spare bits gives the vertex the tendons' colour.
struct DrawVertex {
  glm::vec3 position{0.0f};
  std::uint32_t normal = 0;
};
static_assert(sizeof(DrawVertex) == 16);
inline constexpr std::uint32_t kTendonVertex = 1u << 30;

// Unit vector to and from GL_INT_2_10_10_10_REV (signed normalised, 9 bits and sign each; w is 0). A zero or
// non-finite vector packs to +y.
std::uint32_t pack_normal(const glm::vec3& normal);
glm::vec3 unpack_normal(std::uint32_t packed);

// Packs `positions` and `normals` (same length) into `vertices`; where `normals` is empty all normals are +y.
void pack_vertices(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                   std::span<DrawVertex> vertices);

// Per row of a strip surface, written each step.
struct StripRow {
  float tendon_coordinate = 1.0f;  // m along the surface to the nearest tendon border: negative is tendon
  std::uint32_t item = 0;          // index into the instance's items
};
static_assert(sizeof(StripRow) == 8);

enum StripItemFlags : std::uint32_t {
  kItemHidden = 1u << 0,
  kItemHighlighted = 1u << 1,
  kItemTeleported = 1u << 2,  // not interpolated: drawn where the last step put it
};

// Per item of a strip surface. Written at any time; lasts until written again.
struct StripItem {
  std::uint32_t belly_colour = 0xff282a98u;   // sRGB, bytes R, G, B, A from the lowest (see pack_colour)
  std::uint32_t tendon_colour = 0xffc4dbe8u;
  float activation = 0.0f;                    // 0..1, warms and brightens the belly
  std::uint32_t flags = 0;                    // StripItemFlags
};
static_assert(sizeof(StripItem) == 16);

// sRGB components 0..1 to four bytes, R in the lowest.
std::uint32_t pack_colour(const glm::vec4& srgb);

// 16 bytes: a line's or point's vertex.
struct LineVertex {
  glm::vec3 position{0.0f};          // m, world space
  std::uint32_t colour = 0xffffffffu;  // sRGB, R in the lowest byte; alpha 0 hides the vertex's lines
};
static_assert(sizeof(LineVertex) == 16);

// Names a thing that the renderer holds. A handle of a removed thing is recognised (generation) and asserts.
template <class Tag>
struct DrawHandle {
  std::uint32_t index = 0xffffffffu;
  std::uint32_t generation = 0;

  explicit operator bool() const { return index != 0xffffffffu; }
  friend bool operator==(DrawHandle, DrawHandle) = default;
};
using StripTopologyHandle = DrawHandle<struct StripTopologyTag>;
using StripHandle = DrawHandle<struct StripTag>;
using MeshHandle = DrawHandle<struct MeshTag>;
using RigidHandle = DrawHandle<struct RigidTag>;
using SkinHandle = DrawHandle<struct SkinTag>;
using SurfaceHandle = DrawHandle<struct SurfaceTag>;
using FibreHandle = DrawHandle<struct FibreTag>;
using LineHandle = DrawHandle<struct LineTag>;

}  // namespace fascicle
