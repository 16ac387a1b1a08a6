#include "modules/muscle/asset/surface/pack_hinges.hpp"

#include <array>

#include "modules/muscle/kernels/surface/surface_kernels.hpp"

namespace fascicle::muscle {
namespace {

// Which colours the vertices have, a bit each; as many words as the busiest vertex needs.
class VertexColours {
 public:
  explicit VertexColours(std::size_t vertices) : used_(vertices) {}

  std::uint32_t take(const std::array<std::uint32_t, 4>& vertices) {
    for (std::uint32_t word = 0;; ++word) {
      std::uint64_t taken = 0;
      for (const std::uint32_t v : vertices) taken |= word < used_[v].size() ? used_[v][word] : 0;
      if (taken == ~std::uint64_t{0}) continue;
      const std::uint64_t free = ~taken & (taken + 1);
      for (const std::uint32_t v : vertices) {
        if (used_[v].size() <= word) used_[v].resize(word + 1, 0);
        used_[v][word] |= free;
      }
      return 64 * word + static_cast<std::uint32_t>(__builtin_ctzll(free));
    }
  }

 private:
  std::vector<std::vector<std::uint64_t>> used_;
};

// k = 0 drops an edge (4.1): so soft that nothing comes of it.
constexpr float kDropped = 1.0e30f;

void set_lane(HingePack& pack, std::size_t lane, const Hinge& hinge, const SurfaceSettings& settings) {
  for (std::size_t i = 0; i < 4; ++i) pack.vertex[i][lane] = static_cast<std::int32_t>(hinge.vertex[i]);
  pack.length[lane] = hinge.length;
  pack.angle[lane] = hinge.angle;
  pack.stretch_compliance[lane] = hinge.anisotropy > 0.0f ? settings.stretch_compliance / hinge.anisotropy : kDropped;
  pack.bend_compliance[lane] = settings.bend_compliance;
}

// The padding of a lane, as a hinge.
Hinge spare_hinge(std::uint32_t vertex_count, std::size_t lane) {
  const auto first = vertex_count + static_cast<std::uint32_t>(4 * lane);
  return {.vertex = {first, first + 1, first + 2, first + 3}, .length = 1.0f};
}

}  // namespace

PackedHinges pack_hinges(std::span<const Hinge> hinges, std::uint32_t vertex_count, const SurfaceSettings& settings) {
  VertexColours colours(vertex_count);
  std::vector<std::vector<std::uint32_t>> members;
  for (std::uint32_t i = 0; i < hinges.size(); ++i) {
    const std::uint32_t colour = colours.take(hinges[i].vertex);
    if (colour >= members.size()) members.resize(colour + 1);
    members[colour].push_back(i);
  }

  PackedHinges packed;
  packed.order.reserve(hinges.size());
  packed.first_pack.push_back(0);
  for (const std::vector<std::uint32_t>& colour : members) {
    for (std::size_t begin = 0; begin < colour.size(); begin += kHingeLanes) {
      HingePack& pack = packed.packs.emplace_back();
      for (std::size_t lane = 0; lane < kHingeLanes; ++lane) {
        const bool spare = begin + lane >= colour.size();
        set_lane(pack, lane, spare ? spare_hinge(vertex_count, lane) : hinges[colour[begin + lane]], settings);
      }
    }
    packed.order.insert(packed.order.end(), colour.begin(), colour.end());
    packed.first_pack.push_back(static_cast<std::uint32_t>(packed.packs.size()));
  }
  return packed;
}

void measure_hinges(std::span<const SurfacePoint> points, std::span<Hinge> hinges) {
  const auto vertex_count = static_cast<std::uint32_t>(points.size() - kPaddingPoints);
  std::array<float, kHingeLanes> lengths, angles;
  for (std::size_t begin = 0; begin < hinges.size(); begin += kHingeLanes) {
    HingePack pack{};
    for (std::size_t lane = 0; lane < kHingeLanes; ++lane) {
      const bool spare = begin + lane >= hinges.size();
      set_lane(pack, lane, spare ? spare_hinge(vertex_count, lane) : hinges[begin + lane], {});
    }
    surface_kernels(SimdLevel::kPortable).measure_hinges(std::span(&pack, 1), points, lengths, angles);
    for (std::size_t lane = 0; lane < kHingeLanes && begin + lane < hinges.size(); ++lane) {
      hinges[begin + lane].length = lengths[lane];
      hinges[begin + lane].angle = angles[lane];
    }
  }
}

void add_padding(AlignedVector<SurfacePoint>& points) {
  for (std::size_t lane = 0; lane < kHingeLanes; ++lane) {
    points.push_back({0.0f, 0.0f, 0.0f, 0.0f});
    points.push_back({1.0f, 0.0f, 0.0f, 0.0f});
    points.push_back({0.0f, 1.0f, 0.0f, 0.0f});
    points.push_back({0.0f, -1.0f, 0.0f, 0.0f});
  }
}

}  // namespace fascicle::muscle
