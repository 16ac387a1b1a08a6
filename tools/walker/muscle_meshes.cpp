#include "tools/walker/muscle_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

namespace fascicle::walker {
namespace {

constexpr int kMarchSteps = 14;
constexpr int kBisections = 6;
constexpr int kGrowRounds = 5;
constexpr float kBoneGap = 0.0004f;     // m, between a mesh and bone
constexpr float kMiddleGap = 0.001f;    // m, between a mesh and the plane of symmetry
constexpr float kNeighbourGap = 0.02f;  // of normalised radius, between two meshes
constexpr float kLeastRadius = 0.16f;   // normalised: a rim never closes to a point
constexpr float kEndReach = 0.012f;     // m from an end, over which the mesh may sink into its bone

using Rim = std::vector<float>;  // normalised radius for each side

glm::vec2 direction(std::size_t side, std::size_t sides) {
  const float angle = glm::two_pi<float>() * static_cast<float>(side) / static_cast<float>(sides);
  return {std::cos(angle), std::sin(angle)};
}

struct Surroundings {
  const std::vector<Belly>* bellies;
  const std::vector<BoneShape>* bones;
  std::vector<std::pair<glm::vec3, glm::vec3>> boxes;  // of each belly
};

Surroundings look_around(const std::vector<Belly>& bellies, const std::vector<BoneShape>& bones) {
  Surroundings around{&bellies, &bones, {}};
  for (const Belly& belly : bellies) {
    glm::vec3 low(1e9f), high(-1e9f);
    for (const Section& section : belly.sections) {
      low = glm::min(low, section.centre - std::max(section.w, section.h));
      high = glm::max(high, section.centre + std::max(section.w, section.h));
    }
    around.boxes.emplace_back(low, high);
  }
  return around;
}

// Whether belly m may reach p, which lies at normalised radius t of its section k.
bool may_reach(const Surroundings& around, std::size_t m, std::size_t k, float t, const glm::vec3& p) {
  const Belly& belly = (*around.bellies)[m];
  const std::size_t last = belly.sections.size() - 1;
  // Rims must not cross their neighbours' planes where the curve bends.
  if (k < last && glm::dot(p - belly.sections[k + 1].centre, belly.sections[k + 1].tangent) > 0.0f) return false;
  if (k > 0 && glm::dot(p - belly.sections[k - 1].centre, belly.sections[k - 1].tangent) < 0.0f) return false;
  const float from_end = belly.length * static_cast<float>(std::min(k, last - k)) / static_cast<float>(last);
  const float sink = std::max(0.0f, 1.0f - from_end / kEndReach) * 0.004f;
  if (p.x > -kMiddleGap) return false;  // the other side's half
  if (rest_distance(*around.bones, p) < kBoneGap - sink) return false;
  for (std::size_t other = 0; other < around.boxes.size(); ++other) {
    if (other == m) continue;
    const auto& [low, high] = around.boxes[other];
    if (p.x < low.x || p.y < low.y || p.z < low.z || p.x > high.x || p.y > high.y || p.z > high.z) continue;
    if (t > (*around.bellies)[other].normalised_radius(p) - kNeighbourGap) return false;
  }
  return true;
}

float reach(const Surroundings& around, std::size_t m, std::size_t k, const glm::vec2& e) {
  const Section& section = (*around.bellies)[m].sections[k];
  float good = kLeastRadius, bad = 0.0f;
  for (int step = 1; step <= kMarchSteps; ++step) {
    const float t = kLeastRadius + (1.0f - kLeastRadius) * static_cast<float>(step) / kMarchSteps;
    if (!may_reach(around, m, k, t, section.point(t * e))) {
      bad = t;
      break;
    }
    good = t;
  }
  if (bad == 0.0f) return 1.0f;
  for (int i = 0; i < kBisections; ++i) {
    const float middle = 0.5f * (good + bad);
    (may_reach(around, m, k, middle, section.point(middle * e)) ? good : bad) = middle;
  }
  return good;
}

// Rounds the creases between neighbours, always inwards so that nothing new overlaps.
void round_off(std::vector<Rim>& rims, int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    const std::vector<Rim> old = rims;
    for (std::size_t k = 0; k < rims.size(); ++k) {
      const std::size_t sides = rims[k].size();
      const Rim& before = old[k == 0 ? 0 : k - 1];
      const Rim& after = old[std::min(k + 1, rims.size() - 1)];
      for (std::size_t j = 0; j < sides; ++j) {
        const float mean = 0.25f * (before[j] + after[j] + old[k][(j + 1) % sides] + old[k][(j + sides - 1) % sides]);
        rims[k][j] = std::min(old[k][j], 0.5f * old[k][j] + 0.5f * mean + 0.01f);
      }
    }
  }
}

TriangleMesh sweep(const Belly& belly, const std::vector<Rim>& rims) {
  TriangleMesh mesh;
  mesh.name = belly.muscle->name;
  const std::size_t n = rims.size(), sides = rims.front().size();
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j < sides; ++j)
      mesh.positions.push_back(belly.sections[k].point(rims[k][j] * direction(j, sides)));
  for (const std::size_t k : {std::size_t{0}, n - 1}) {
    glm::vec3 middle(0.0f);
    for (std::size_t j = 0; j < sides; ++j) middle += mesh.positions[k * sides + j];
    mesh.positions.push_back(middle / static_cast<float>(sides));
  }
  const auto add = [&mesh](std::size_t a, std::size_t b, std::size_t c) {
    for (const std::size_t i : {a, b, c}) mesh.indices.push_back(static_cast<std::uint32_t>(i));
  };
  for (std::size_t k = 0; k + 1 < n; ++k) {
    for (std::size_t j = 0; j < sides; ++j) {
      const std::size_t a = k * sides + j, b = k * sides + (j + 1) % sides, c = a + sides, d = b + sides;
      if ((k + j) % 2 == 0) {
        add(a, d, b);
        add(a, c, d);
      } else {
        add(a, c, b);
        add(b, c, d);
      }
    }
  }
  for (std::size_t j = 0; j < sides; ++j) {
    add(n * sides, j, (j + 1) % sides);
    add(n * sides + 1, (n - 1) * sides + (j + 1) % sides, (n - 1) * sides + j);
  }
  if (mesh_volume(mesh) < 0.0)
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  return mesh;
}

}  // namespace

MeshSize plan_mesh(const MuscleSpec& muscle) {
  float length = 0.0f;
  const std::vector<glm::vec3> path = rest_path(muscle);
  for (std::size_t i = 1; i < path.size(); ++i) length += glm::distance(path[i - 1], path[i]);
  const BellyShape& shape = muscle.belly;
  const float belly_length = length * (shape.end - shape.begin);
  const float thickness = std::sqrt(1.7f * muscle.volume() / belly_length / (glm::pi<float>() * shape.aspect));
  const float girth = 2.1f * thickness * (1.0f + shape.aspect);
  const auto even = [](float x) { return 2 * static_cast<std::size_t>(std::lround(0.5f * x)); };
  return {std::clamp(even(14.0f + length / 0.0078f), std::size_t{24}, std::size_t{68}),
          std::clamp(even(8.0f + girth / 0.0056f), std::size_t{16}, std::size_t{40})};
}

std::vector<TriangleMesh> mesh_bellies(std::vector<Belly>& bellies, const std::vector<MeshSize>& sizes,
                                       const std::vector<BoneShape>& bones) {
  std::vector<TriangleMesh> meshes(bellies.size());
  for (int round = 0; round <= kGrowRounds; ++round) {
    const Surroundings around = look_around(bellies, bones);
    for (std::size_t m = 0; m < bellies.size(); ++m) {
      std::vector<Rim> rims(sizes[m].stations, Rim(sizes[m].sides));
      for (std::size_t k = 0; k < rims.size(); ++k)
        for (std::size_t j = 0; j < rims[k].size(); ++j) rims[k][j] = reach(around, m, k, direction(j, rims[k].size()));
      round_off(rims, 4);
      meshes[m] = sweep(bellies[m], rims);
    }
    if (round == kGrowRounds) break;
    for (std::size_t m = 0; m < bellies.size(); ++m) {
      const double ratio = bellies[m].muscle->volume() / mesh_volume(meshes[m]);
      grow_belly(bellies[m], static_cast<float>(std::clamp(ratio, 0.8, 1.35)));
    }
  }
  return meshes;
}

TriangleMesh mirrored(const TriangleMesh& mesh) {
  TriangleMesh other = mesh;
  for (glm::vec3& p : other.positions) p.x = -p.x;
  for (glm::vec3& n : other.normals) n.x = -n.x;
  for (std::size_t i = 0; i + 2 < other.indices.size(); i += 3) std::swap(other.indices[i + 1], other.indices[i + 2]);
  return other;
}

double mesh_volume(const TriangleMesh& mesh) {
  double six = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::dvec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]];
    six += glm::dot(a, glm::cross(b, glm::dvec3(mesh.positions[mesh.indices[i + 2]])));
  }
  return six / 6.0;
}

}  // namespace fascicle::walker
