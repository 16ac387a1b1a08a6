#include "modules/muscle/asset/fit/check_mesh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/mesh_measures.hpp"

namespace fascicle::muscle {
namespace {

constexpr double kUnitSlack = 4.0;       // a mesh may be this much larger or smaller than its muscle
constexpr double kStray = 100.0;         // times as far from the middle as half of all vertices
constexpr double kLeastVolume = 1.0e-9;  // of the cube of its size: less is what rounding leaves

std::uint64_t mixed(std::uint32_t from, std::uint32_t to) {
  std::uint64_t h = (std::uint64_t{from} << 32 | to) * 0x9e3779b97f4a7c15ull;
  h ^= h >> 32;
  h *= 0xd6e8feb86659fd93ull;
  return h ^ (h >> 29);
}

double take_median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

std::uint64_t hash_of(const glm::vec3& p) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x + 0.0f); };  // -0 is 0
  return mixed(bits(p.x), bits(p.y)) + mixed(bits(p.z), 1);
}

// Triangles that stand where another does, the same way round. By place, so that doubled parts count that have vertices
// of their own.
std::size_t count_duplicates(const TriangleMesh& mesh) {
  std::vector<std::uint64_t> vertices, triangles;
  vertices.reserve(mesh.positions.size());
  triangles.reserve(mesh.indices.size() / 3);
  for (const glm::vec3& p : mesh.positions) vertices.push_back(hash_of(p));
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    std::array<std::uint64_t, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = vertices[mesh.indices[i + k]];
    std::ranges::rotate(corners, std::ranges::min_element(corners));
    triangles.push_back(corners[0] + 3 * std::rotl(corners[1], 21) + 5 * std::rotl(corners[2], 42));
  }
  std::ranges::sort(triangles);
  return std::ranges::unique(triangles).size();
}

// Of a closed mesh, by Euler's number: a single surface without handles, as most muscles are, has no triangle twice. It
// saves them the count, which costs as much as a quarter of the fit.
bool is_plain_ball(const TriangleMesh& mesh) { return mesh.positions.size() == mesh.indices.size() / 6 + 2; }

bool is_sound(const TriangleMesh& mesh, double size) {
  for (const glm::vec3& p : mesh.positions) {
    if (!std::isfinite(p.x + p.y + p.z)) return false;
  }
  std::uint64_t sides = 0;  // the sum over all sides of its hash less its reverse's
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    sides += mixed(a, b) + mixed(b, c) + mixed(c, a) - mixed(b, a) - mixed(c, b) - mixed(a, c);
  }
  return sides == 0 && mesh_volume(mesh) > kLeastVolume * size * size * size;
}

}  // namespace

bool is_sound(const TriangleMesh& mesh) { return is_sound(mesh, double{mesh_bounds(mesh).diagonal()}); }

CheckedMesh check_mesh(const TriangleMesh& mesh) {
  CheckedMesh checked;
  checked.size = double{mesh_bounds(mesh).diagonal()};
  checked.sound = is_sound(mesh, checked.size);
  if (checked.sound) {
    // They stay: where parts share some triangles, the mesh without these was open.
    if (const std::size_t duplicates = is_plain_ball(mesh) ? 0 : count_duplicates(mesh); duplicates > 0) {
      checked.defects = fmt::format("{} triangle{} twice", duplicates, duplicates == 1 ? "" : "s");
    }
    return checked;
  }
  CleanMesh clean = clean_mesh(mesh);
  checked.size = double{mesh_bounds(clean.mesh).diagonal()};
  checked.sound = is_sound(clean.mesh, checked.size);
  checked.defects = clean.defects.to_text();
  checked.source_triangles = std::move(clean.source_triangles);
  checked.mended = std::move(clean.mesh);
  return checked;
}

std::optional<UnitGuess> guess_unit(double factor) {
  constexpr std::array<UnitGuess, 7> kUnits{{{"millimetres", 1000.0},
                                             {"centimetres", 100.0},
                                             {"inches", 39.37},
                                             {"millimetres given as centimetres", 10.0},
                                             {"centimetres given as millimetres", 0.1},
                                             {"metres given as centimetres", 0.01},
                                             {"metres given as millimetres", 0.001}}};
  UnitGuess best = kUnits[0];
  for (const UnitGuess& unit : kUnits) {
    if (std::abs(std::log(factor / unit.factor)) < std::abs(std::log(factor / best.factor))) best = unit;
  }
  if (factor > kUnitSlack * best.factor || factor < best.factor / kUnitSlack) return {};
  return best;
}

std::optional<double> find_stray_vertex(const TriangleMesh& mesh) {
  std::vector<glm::dvec3> positions;
  for (const std::uint32_t v : mesh.indices) {
    const glm::vec3& p = mesh.positions[v];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) positions.emplace_back(p);
  }
  if (positions.empty()) return {};
  glm::dvec3 middle(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> coordinates;
    for (const glm::dvec3& p : positions) coordinates.push_back(p[axis]);
    middle[axis] = take_median(coordinates);
  }
  std::vector<double> distances;
  for (const glm::dvec3& p : positions) distances.push_back(glm::distance(p, middle));
  const double furthest = *std::ranges::max_element(distances);
  if (furthest <= kStray * take_median(distances)) return {};
  return furthest;
}

}  // namespace fascicle::muscle
