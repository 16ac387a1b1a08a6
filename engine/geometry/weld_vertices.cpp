#include "engine/geometry/weld_vertices.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Lists of vertices by cell, in an open-addressed table.
class CellTable {
 public:
  explicit CellTable(std::size_t count)
      : slots_(std::bit_ceil(std::max<std::size_t>(2 * count, 16))), next_(count, kNone) {}

  // The last vertex added to the cell, or kNone.
  std::uint32_t newest(std::uint64_t key) const { return slots_[find(key)].newest; }
  std::uint32_t older(std::uint32_t vertex) const { return next_[vertex]; }

  void add(std::uint64_t key, std::uint32_t vertex) {
    Slot& slot = slots_[find(key)];
    slot.key = key;
    next_[vertex] = slot.newest;
    slot.newest = vertex;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t newest = kNone;
  };

  std::size_t find(std::uint64_t key) const {
    std::uint64_t hash = key * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 32;
    for (std::size_t at = hash & (slots_.size() - 1);; at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at].newest == kNone || slots_[at].key == key) return at;
    }
  }

  std::vector<Slot> slots_;
  std::vector<std::uint32_t> next_;
};

}  // namespace

std::vector<std::uint32_t> weld_vertices(std::span<const glm::vec3> positions, double tolerance) {
  std::vector<std::uint32_t> stands_for(positions.size());
  if (positions.empty()) return stands_for;
  glm::dvec3 lower(positions[0]), upper(positions[0]);
  for (const glm::vec3& p : positions) {
    lower = glm::min(lower, glm::dvec3(p));
    upper = glm::max(upper, glm::dvec3(p));
  }
  // 20 bits a coordinate suffice for the widest mesh; a mesh that is one point needs only one cell.
  const double widest = glm::distance(lower, upper);
  const double cell = std::max(4.0 * tolerance, widest > 0.0 ? widest / (1 << 20) : 1.0);
  const auto cell_of = [&](const glm::dvec3& p) { return glm::floor((p - lower) / cell) + 1.0; };
  const auto key_of = [](double x, double y, double z) {
    return static_cast<std::uint64_t>(x) << 42 | static_cast<std::uint64_t>(y) << 21 | static_cast<std::uint64_t>(z);
  };

  CellTable table(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    const glm::dvec3 p(positions[i]);
    const glm::dvec3 first = cell_of(p - tolerance), last = cell_of(p + tolerance);
    std::uint32_t found = kNone;
    for (double x = first.x; x <= last.x; ++x) {
      for (double y = first.y; y <= last.y; ++y) {
        for (double z = first.z; z <= last.z; ++z) {
          for (std::uint32_t j = table.newest(key_of(x, y, z)); j != kNone; j = table.older(j)) {
            if (j < found && glm::distance(p, glm::dvec3(positions[j])) <= tolerance) found = j;
          }
        }
      }
    }
    stands_for[i] = found == kNone ? i : found;
    if (found != kNone) continue;
    const glm::dvec3 own = cell_of(p);
    table.add(key_of(own.x, own.y, own.z), i);
  }
  return stands_for;
}

}  // namespace fascicle
