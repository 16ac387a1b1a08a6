// What the surface muscles' kernels read and write, as bare pointers: their source files call no inline function of
// another library, not even a span's (see engine/math/wide_float.hpp). surface_kernels.cpp fills these in.
#pragma once

#include <cstddef>
#include <cstdint>

#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

struct HingeRows {
  const HingePack* packs = nullptr;
  std::size_t pack_count = 0;
  SurfacePoint* points = nullptr;
  float inverse_h2 = 0.0f;  // 1/s^2
};

struct HingeRuler {
  const HingePack* packs = nullptr;
  std::size_t pack_count = 0;
  const SurfacePoint* points = nullptr;
  float* lengths = nullptr;  // m, by lane
  float* angles = nullptr;   // rad, by lane
};

struct VolumeRows {
  const std::uint32_t* first_ring = nullptr;
  const std::int32_t* rings = nullptr;  // four vertices a row
  std::size_t vertex_count = 0;
  SurfacePoint* points = nullptr;
  SurfacePoint* gradient = nullptr;
  double rest = 0.0;
  float compliance = 0.0f;
};

struct PointRows {  // `carry` goes from `rest` to `points`
  const CarryWeights* carry = nullptr;  // null: nothing carries
  const float* moved = nullptr;
  std::size_t moved_count = 0;
  std::size_t vertex_count = 0;
  const SurfacePoint* rest = nullptr;
  SurfacePoint *points = nullptr, *before = nullptr, *velocity = nullptr;
  float h = 0.0f;
  float keep = 1.0f;
  const SurfacePoint* anchors = nullptr;  // null: no pull
  float pull = 0.0f;
};

struct ViscosityRows {
  const HingePack* packs = nullptr;
  std::size_t pack_count = 0;
  const SurfacePoint* points = nullptr;
  SurfacePoint* velocity = nullptr;
  float share = 0.0f;
};

struct SurfaceKernelTable {
  void (*project_hinges)(const HingeRows& rows);
  void (*measure_hinges)(const HingeRuler& ruler);
  double (*project_volume)(const VolumeRows& rows);
  double (*measure_volume)(const VolumeRows& rows);
  void (*carry)(const PointRows& rows);
  void (*predict)(const PointRows& rows);
  void (*take_velocities)(const PointRows& rows);
  void (*fade_differences)(const ViscosityRows& rows);
};

}  // namespace fascicle::muscle
