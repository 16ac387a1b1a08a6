#include "engine/geometry/ray_scene.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>

#include "engine/geometry/ray_reference.hpp"

namespace fascicle {
namespace {

constexpr std::uint32_t kPacket = 8;
// A line in doubt is cast again, so many times, shifted sideways by so much more of the mesh's size each time.
constexpr int kShifts = 3;
constexpr float kShift = 2.0e-6f;
// Two crossings of neighbouring triangles closer than this share of the mesh's size are one.
constexpr float kSamePlace = 1.0e-6f;

// What the filter functions find behind Embree's own context.
struct ExtremesContext {
  RTCIntersectContext embree;
  std::array<float, kPacket> entries, exits;            // first entry, last exit
  std::array<float, kPacket> last_entries, first_exits;
  std::array<std::uint32_t, kPacket> counts;
  std::array<std::int32_t, kPacket> balances;  // entries less exits
};
struct CrossingsContext {
  RTCIntersectContext embree;
  std::array<std::vector<LineCrossing>, kPacket> found;
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
    if (exit) {
      context.exits[id] = std::max(context.exits[id], t);
      context.first_exits[id] = std::min(context.first_exits[id], t);
    } else {
      context.entries[id] = std::min(context.entries[id], t);
      context.last_entries[id] = std::max(context.last_entries[id], t);
    }
    ++context.counts[id];
    context.balances[id] += exit ? -1 : 1;
  });
}

void record_crossings(const RTCFilterFunctionNArguments* offered) {
  CrossingsContext& context = *reinterpret_cast<CrossingsContext*>(offered->context);
  for_each_hit(offered, [&](unsigned int id, float t, std::uint32_t triangle, bool exit) {
    context.found[id].push_back({t, triangle, exit});
  });
}

// Lines through a vertex, to rounding, may miss every triangle round it, though the robust traversal keeps edges tight.
// A closed mesh is left as often as it is entered; one that is missed may have been missed twice.
bool is_doubtful(const std::vector<LineCrossing>& crossings) {
  std::ptrdiff_t balance = 0;
  for (const LineCrossing& crossing : crossings) balance += crossing.exit ? -1 : 1;
  return balance != 0 || crossings.empty();
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
  Bounds bounds;
  glm::vec3 middle{0.0f};
  float reach = 0.0f;  // m, from the middle, a little beyond the mesh
  float same_place = 0.0f;

  void set_plain(const TriangleMesh& mesh) {
    plain = mesh;
    indices = mesh.indices;
    set_bounds(mesh_bounds(mesh));
  }
  void set_bounds(const Bounds& of_mesh) {
    bounds = of_mesh;
    middle = 0.5f * (bounds.lower + bounds.upper);
    reach = 0.51f * bounds.diagonal();
    same_place = kSamePlace * bounds.diagonal();
  }
  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }

  // Up to 8 lines, each from before the mesh; gives back where each began, from where its hits count.
  std::array<float, kPacket> cast_packet(std::span<const Line> lines, ExtremesContext& context) const {
    context.entries.fill(LineExtremes{}.first_entry);
    context.exits.fill(LineExtremes{}.last_exit);
    context.first_exits = context.entries;
    context.last_entries = context.exits;
    context.counts.fill(0);
    context.balances.fill(0);
    return intersect(lines, context.embree);
  }
  LineExtremes extremes_of(const ExtremesContext& context, std::size_t i, float start) const {
    return {start + context.entries[i], start + context.exits[i], context.counts[i],
            context.first_exits[i] < context.entries[i] - same_place ||
                context.last_entries[i] > context.exits[i] + same_place};
  }
  // The same; t counts from the lines' own origins.
  void cast_packet(std::span<const Line> lines, CrossingsContext& context) const {
    const std::array<float, kPacket> starts = intersect(lines, context.embree);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (LineCrossing& crossing : context.found[i]) crossing.t += starts[i];
    }
  }

  // Sideways, in a direction of no meaning.
  Line shifted(const Line& line, int shift) const {
    const glm::vec3 axis =
        std::abs(line.direction.x) < 0.6f ? glm::vec3(1.0f, 0.3f, 0.2f) : glm::vec3(0.2f, 1.0f, 0.3f);
    const glm::vec3 sideways = glm::normalize(glm::cross(line.direction, axis));
    return {line.origin + (kShift * 2.0f * reach * static_cast<float>(shift)) * sideways, line.direction};
  }

  std::array<float, kPacket> intersect(std::span<const Line> lines, RTCIntersectContext& context) const {
    RTCRayHit8 packet;
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
    rtcIntersect8(valid.data(), scene, &context, &packet);
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

  // By rising t, each place once.
  void sort_and_unite(std::vector<LineCrossing>& found) const {
    std::sort(found.begin(), found.end(), [](const LineCrossing& a, const LineCrossing& b) {
      return a.t != b.t ? a.t < b.t : a.triangle < b.triangle;
    });
    std::size_t kept = 0;
    for (const LineCrossing crossing : found) {
      bool seen = false;
      for (std::size_t i = kept; !seen && i > 0 && crossing.t - found[i - 1].t <= same_place; --i) {
        seen = found[i - 1].exit == crossing.exit && are_neighbours(found[i - 1].triangle, crossing.triangle);
      }
      if (!seen) found[kept++] = crossing;
    }
    found.resize(kept);
  }
};

RayScene::RayScene(const RayDevice& device, const TriangleMesh& mesh) : impl_(std::make_unique<Impl>()) {
  const RTCDevice embree = device.impl_->device;
  if (embree == nullptr) {  // a processor that Embree does not run on
    impl_->set_plain(mesh);
    return;
  }
  impl_->positions = mesh.positions;
  impl_->indices = mesh.indices;
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
  if (mesh.indices.empty()) return;
  RTCBounds bounds;
  rtcGetSceneBounds(impl_->scene, &bounds);
  impl_->set_bounds({{bounds.lower_x, bounds.lower_y, bounds.lower_z}, {bounds.upper_x, bounds.upper_y, bounds.upper_z}});
}

RayScene::RayScene(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>()) { impl_->set_plain(mesh); }

const Bounds& RayScene::bounds() const { return impl_->bounds; }

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
  std::vector<std::uint32_t> doubtful;
  for (std::size_t first = 0; first < lines.size(); first += kPacket) {
    const std::size_t count = std::min<std::size_t>(kPacket, lines.size() - first);
    const std::array<float, kPacket> starts = impl_->cast_packet(lines.subspan(first, count), context);
    for (std::size_t i = 0; i < count; ++i) {
      extremes[first + i] = impl_->extremes_of(context, i, starts[i]);
      if (context.balances[i] != 0) doubtful.push_back(static_cast<std::uint32_t>(first + i));
    }
  }
  // Among lines beside each other, one that misses between such as hit.
  const auto misses = [&](std::size_t i) { return extremes[i].crossings == 0; };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool beside_hit = (i > 0 && !misses(i - 1)) || (i + 1 < lines.size() && !misses(i + 1)) || lines.size() == 1;
    if (misses(i) && beside_hit) doubtful.push_back(static_cast<std::uint32_t>(i));
  }

  std::array<Line, kPacket> shifted;
  for (int shift = 1; shift <= kShifts && !doubtful.empty(); ++shift) {
    std::vector<std::uint32_t> still;
    for (std::size_t first = 0; first < doubtful.size(); first += kPacket) {
      const std::size_t count = std::min<std::size_t>(kPacket, doubtful.size() - first);
      for (std::size_t i = 0; i < count; ++i) shifted[i] = impl_->shifted(lines[doubtful[first + i]], shift);
      const std::array<float, kPacket> starts = impl_->cast_packet(std::span(shifted).first(count), context);
      for (std::size_t i = 0; i < count; ++i) {
        if (context.balances[i] != 0) still.push_back(doubtful[first + i]);  // an open mesh: the line itself counts
        else if (context.counts[i] != 0) {
          extremes[doubtful[first + i]] = impl_->extremes_of(context, i, starts[i]);
        }
      }
    }
    doubtful = std::move(still);
  }
}

void RayScene::cast_all(std::span<const Line> lines, std::vector<std::uint32_t>& starts,
                        std::vector<LineCrossing>& crossings) const {
  starts.assign(1, 0);
  crossings.clear();
  CrossingsContext context;
  rtcInitIntersectContext(&context.embree);
  context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.embree.filter = record_crossings;
  std::vector<LineCrossing> again;
  for (std::size_t first = 0; first < lines.size(); first += kPacket) {
    const std::size_t count = std::min<std::size_t>(kPacket, lines.size() - first);
    if (impl_->scene != nullptr) {
      impl_->cast_packet(lines.subspan(first, count), context);
    } else {
      for (std::size_t i = 0; i < count; ++i) cross_line_reference(impl_->plain, lines[first + i], context.found[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<LineCrossing> found = std::move(context.found[i]);
      impl_->sort_and_unite(found);
      for (int shift = 1; impl_->scene != nullptr && shift <= kShifts && is_doubtful(found); ++shift) {
        const Line line = impl_->shifted(lines[first + i], shift);
        CrossingsContext alone;
        alone.embree = context.embree;
        impl_->cast_packet(std::span(&line, 1), alone);
        again = std::move(alone.found[0]);
        impl_->sort_and_unite(again);
        if (!is_doubtful(again)) found = again;
        else if (again.empty()) break;
      }
      crossings.insert(crossings.end(), found.begin(), found.end());
      starts.push_back(static_cast<std::uint32_t>(crossings.size()));
      context.found[i].clear();
    }
  }
}

}  // namespace fascicle
