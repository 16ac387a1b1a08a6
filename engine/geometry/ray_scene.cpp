#include "engine/geometry/ray_scene.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>

#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/ray_reference.hpp"

namespace fascicle {
namespace {

constexpr std::uint32_t kPacket = 16;
// Two crossings of neighbouring triangles closer than this share of the mesh's size are one.
constexpr float kSamePlace = 1.0e-6f;

// What the filter functions find behind Embree's own context.
struct ExtremesContext {
  RTCIntersectContext embree;
  std::array<float, kPacket> entries, exits;
  std::array<std::uint32_t, kPacket> counts;
};
struct CrossingsContext {
  RTCIntersectContext embree;
  std::array<std::vector<LineCrossing>*, kPacket> crossings;
};

// f(ray's number, t, triangle, exit) for each hit offered; all are rejected, so that the traversal goes on.
template <class F>
void for_each_hit(const RTCFilterFunctionNArguments* offered, F f) {
  const unsigned int n = offered->N;
  RTCRayN* ray = offered->ray;
  RTCHitN* hit = offered->hit;
  for (unsigned int i = 0; i < n; ++i) {
    if (offered->valid[i] == 0) continue;
    const float facing = RTCRayN_dir_x(ray, n, i) * RTCHitN_Ng_x(hit, n, i) +
                         RTCRayN_dir_y(ray, n, i) * RTCHitN_Ng_y(hit, n, i) +
                         RTCRayN_dir_z(ray, n, i) * RTCHitN_Ng_z(hit, n, i);
    f(RTCRayN_id(ray, n, i), RTCRayN_tfar(ray, n, i), RTCHitN_primID(hit, n, i), facing > 0.0f);
    offered->valid[i] = 0;
  }
}

void record_extremes(const RTCFilterFunctionNArguments* offered) {
  ExtremesContext& context = *reinterpret_cast<ExtremesContext*>(offered->context);
  for_each_hit(offered, [&](unsigned int id, float t, std::uint32_t, bool exit) {
    if (exit) context.exits[id] = std::max(context.exits[id], t);
    else context.entries[id] = std::min(context.entries[id], t);
    ++context.counts[id];
  });
}

void record_crossings(const RTCFilterFunctionNArguments* offered) {
  CrossingsContext& context = *reinterpret_cast<CrossingsContext*>(offered->context);
  for_each_hit(offered, [&](unsigned int id, float t, std::uint32_t triangle, bool exit) {
    context.crossings[id]->push_back({t, triangle, exit});
  });
}

}  // namespace

struct RayDevice::Impl {
  RTCDevice device = nullptr;
  ~Impl() {
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayDevice::RayDevice() : impl_(std::make_unique<Impl>()) {
  impl_->device = rtcNewDevice("threads=1,set_affinity=0,ignore_config_files=1");
}
RayDevice::~RayDevice() = default;
RayDevice::RayDevice(RayDevice&&) noexcept = default;
RayDevice& RayDevice::operator=(RayDevice&&) noexcept = default;

struct RayScene::Impl {
  RTCScene scene = nullptr;  // null: the plain loop
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  TriangleMesh plain;
  glm::vec3 middle{0.0f};
  float reach = 0.0f;  // m, from the middle, a little beyond the mesh
  float same_place = 0.0f;

  explicit Impl(const TriangleMesh& mesh) {
    const Bounds bounds = mesh_bounds(mesh);
    middle = 0.5f * (bounds.lower + bounds.upper);
    reach = 0.51f * bounds.diagonal();
    same_place = kSamePlace * bounds.diagonal();
  }
  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }

  // Casts lines[first ..] as one packet, each from before the mesh; gives back where each began.
  std::array<float, kPacket> cast_packet(std::span<const Line> lines, RTCIntersectContext& context) const {
    RTCRayHit16 packet;
    std::array<float, kPacket> starts{};
    alignas(64) std::array<int, kPacket> valid{};
    for (std::uint32_t i = 0; i < kPacket; ++i) {
      const Line& line = lines[std::min<std::size_t>(i, lines.size() - 1)];
      valid[i] = i < lines.size() ? -1 : 0;
      starts[i] = glm::dot(middle - line.origin, line.direction) - reach;
      const glm::vec3 from = line.origin + starts[i] * line.direction;
      packet.ray.org_x[i] = from.x;
      packet.ray.org_y[i] = from.y;
      packet.ray.org_z[i] = from.z;
      packet.ray.dir_x[i] = line.direction.x;
      packet.ray.dir_y[i] = line.direction.y;
      packet.ray.dir_z[i] = line.direction.z;
      packet.ray.tnear[i] = 0.0f;
      packet.ray.tfar[i] = 2.0f * reach;
      packet.ray.time[i] = 0.0f;
      packet.ray.mask[i] = ~0u;
      packet.ray.id[i] = i;
      packet.ray.flags[i] = 0;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid.data(), scene, &context, &packet);
    return starts;
  }

  bool are_neighbours(std::uint32_t a, std::uint32_t b) const {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (indices[3 * std::size_t{a} + i] == indices[3 * std::size_t{b} + j]) return true;
      }
    }
    return false;
  }

  // Sorts one line's crossings and moves them behind those of the lines before it, each place once.
  void append_sorted(std::vector<LineCrossing>& found, std::vector<LineCrossing>& crossings) const {
    std::sort(found.begin(), found.end(), [](const LineCrossing& a, const LineCrossing& b) {
      return a.t != b.t ? a.t < b.t : a.triangle < b.triangle;
    });
    const std::size_t first = crossings.size();
    for (const LineCrossing& crossing : found) {
      const auto is_the_same = [&](const LineCrossing& other) {
        return other.exit == crossing.exit && are_neighbours(other.triangle, crossing.triangle);
      };
      bool seen = false;
      for (std::size_t i = crossings.size(); !seen && i > first && crossing.t - crossings[i - 1].t <= same_place; --i) {
        seen = is_the_same(crossings[i - 1]);
      }
      if (!seen) crossings.push_back(crossing);
    }
    found.clear();
  }
};

RayScene::RayScene(const RayDevice& device, const TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {
  impl_->positions = mesh.positions;
  impl_->indices = mesh.indices;
  const RTCDevice embree = device.impl_->device;
  assert(embree != nullptr);
  impl_->scene = rtcNewScene(embree);
  rtcSetSceneFlags(impl_->scene,
                   static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  // A fit casts a few hundred lines a mesh: the tree that is built fastest is the cheapest by far.
  rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_LOW);
  if (!mesh.indices.empty()) {
    const RTCGeometry geometry = rtcNewGeometry(embree, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
    impl_->positions.emplace_back(0.0f);  // Embree reads 16 bytes at each vertex
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, impl_->positions.data(), 0,
                               sizeof(glm::vec3), mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, impl_->indices.data(), 0,
                               3 * sizeof(std::uint32_t), mesh.indices.size() / 3);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(impl_->scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(impl_->scene);
}

RayScene::RayScene(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {
  impl_->plain = mesh;
  impl_->indices = mesh.indices;
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

void RayScene::cast(std::span<const Line> lines, std::span<LineExtremes> extremes) const {
  assert(lines.size() == extremes.size());
  if (impl_->scene == nullptr) return cast_lines_reference(impl_->plain, lines, extremes);
  ExtremesContext context;
  rtcInitIntersectContext(&context.embree);
  context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.embree.filter = record_extremes;
  for (std::size_t first = 0; first < lines.size(); first += kPacket) {
    const std::size_t count = std::min<std::size_t>(kPacket, lines.size() - first);
    context.entries.fill(LineExtremes{}.first_entry);
    context.exits.fill(LineExtremes{}.last_exit);
    context.counts.fill(0);
    const std::array<float, kPacket> starts = impl_->cast_packet(lines.subspan(first, count), context.embree);
    for (std::size_t i = 0; i < count; ++i) {
      extremes[first + i] = {starts[i] + context.entries[i], starts[i] + context.exits[i], context.counts[i]};
    }
  }
}

void RayScene::cast_all(std::span<const Line> lines, std::vector<std::uint32_t>& starts,
                        std::vector<LineCrossing>& crossings) const {
  starts.assign(1, 0);
  crossings.clear();
  std::array<std::vector<LineCrossing>, kPacket> found;
  CrossingsContext context;
  rtcInitIntersectContext(&context.embree);
  context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.embree.filter = record_crossings;
  for (std::size_t i = 0; i < kPacket; ++i) context.crossings[i] = &found[i];
  for (std::size_t first = 0; first < lines.size(); first += kPacket) {
    const std::size_t count = std::min<std::size_t>(kPacket, lines.size() - first);
    std::array<float, kPacket> offsets{};
    if (impl_->scene != nullptr) {
      offsets = impl_->cast_packet(lines.subspan(first, count), context.embree);
    } else {
      for (std::size_t i = 0; i < count; ++i) cross_line_reference(impl_->plain, lines[first + i], found[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (LineCrossing& crossing : found[i]) crossing.t += offsets[i];
      impl_->append_sorted(found[i], crossings);
      starts.push_back(static_cast<std::uint32_t>(crossings.size()));
    }
  }
}

}  // namespace fascicle
