#include "modules/muscle/asset/surface/pack_hinges.hpp"

#include <array>

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

}  // namespace

PackedHinges pack_hinges(std::span<const Hinge> hinges, std::uint32_t vertex_count) {
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
      HingePack pack{};
      for (std::size_t lane = 0; lane < kHingeLanes; ++lane) {
        const bool spare = begin + lane >= colour.size();
        for (std::size_t i = 0; i < 4; ++i) {
          const std::uint32_t vertex = spare ? vertex_count + static_cast<std::uint32_t>(4 * lane + i)
                                             : hinges[colour[begin + lane]].vertex[i];
          pack.vertex[i][lane] = static_cast<std::int32_t>(vertex);
        }
        if (!spare) packed.order.push_back(colour[begin + lane]);
      }
      packed.packs.push_back(pack);
    }
    packed.first_pack.push_back(static_cast<std::uint32_t>(packed.packs.size()));
  }
  return packed;
}

}  // namespace fascicle::muscle
