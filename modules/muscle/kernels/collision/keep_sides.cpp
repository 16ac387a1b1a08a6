#include "modules/muscle/kernels/collision/keep_sides.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "modules/muscle/kernels/transversal.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kNearby = 0.004f;      // m: a section displaced by less, or less than its size, has not gone round anything
constexpr int kStepsOnTheWay = 8;      // places that the way is looked at
constexpr float kInTheWay = 0.0005f;   // m: so deep in a bone a way leads through it

TransversalEnd end_of(const CollisionAsset& asset, std::uint32_t section, std::uint32_t vertex,
                      const CollisionWork& work) {
  const std::uint32_t i = asset.sections[section].first_radius + vertex;
  const glm::vec3 direction(work.dir_x[i], work.dir_y[i], work.dir_z[i]);
  return {work.a[section] + work.radii[i] * direction, work.a[section]};
}

TransversalDepth measure(const CollisionAsset& asset, const Transversal& transversal, std::span<const glm::mat4> bones,
                         const CollisionWork& work) {
  const TransversalEnd first = end_of(asset, transversal.section, transversal.vertex, work);
  if (transversal.bone < 0) {
    return measure_transversal(first, end_of(asset, transversal.other_section, transversal.other_vertex, work));
  }
  const glm::vec3 point(bones[static_cast<std::size_t>(transversal.bone)] * glm::vec4(transversal.point, 1.0f));
  return measure_transversal(first, {point, point});
}

}  // namespace

float transversal_depth(const CollisionAsset& asset, const Transversal& transversal, std::span<const glm::mat4> bones,
                        const CollisionWork& work) {
  return std::max(measure(asset, transversal, bones, work).overlap - transversal.rest_depth, 0.0f);
}

void hold_transversals(const CollisionAsset& asset, std::span<const glm::mat4> bones, CollisionWork& work) {
  for (const Transversal& transversal : asset.transversals) {
    const TransversalDepth now = measure(asset, transversal, bones, work);
    const float depth = now.overlap - transversal.rest_depth;
    const bool both_ends = transversal.bone < 0;
    const float radius = both_ends ? std::min(now.x.radius, now.y.radius) : now.x.radius;
    if (!(depth > radius)) continue;
    const float first = transversal.first_yields ? work.mobility[transversal.section] : 0.0f;
    const float second =
        both_ends && transversal.second_yields ? work.mobility[transversal.other_section] : 0.0f;
    if (first + second <= 0.0f) continue;
    if (first > 0.0f) work.a[transversal.section] += first / (first + second) * depth * now.x.inward;
    if (second > 0.0f) work.a[transversal.other_section] += second / (first + second) * depth * now.y.inward;
  }
}

void recall_strayed(const CollisionAsset& asset, std::span<const glm::mat4> bones, CollisionWork& work) {
  for (std::size_t s = 0; s < asset.sections.size(); ++s) {
    const CollisionSection& section = asset.sections[s];
    const glm::vec3 way = work.a[s] - work.driven[s];
    const float length2 = glm::dot(way, way);
    const float nearby = std::max(kNearby, std::sqrt(section.rest_area / std::numbers::pi_v<float>));
    if (section.end || length2 < nearby * nearby) continue;
    const float reach = glm::length(way);
    for (std::size_t place = 0; place < asset.bones.size(); ++place) {
      const glm::mat4& bone = bones[static_cast<std::size_t>(asset.bones[place])];
      const BoneField& field = *asset.fields[place];
      const auto distance = [&](float along) {
        const glm::vec3 p = work.driven[s] + along * way;
        return field.distance((p - glm::vec3(bone[3])) * glm::mat3(bone));
      };
      const float from = distance(0.0f);
      if (from < 0.0f || from > reach || distance(1.0f) < 0.0f) continue;
      bool through = false;
      for (int i = 1; i < kStepsOnTheWay && !through; ++i) {
        through = distance(static_cast<float>(i) / static_cast<float>(kStepsOnTheWay)) < -kInTheWay;
      }
      if (!through) continue;
      work.a[s] = work.driven[s];
      std::copy_n(&work.wanted[section.first_radius], section.count, &work.radii[section.first_radius]);
      break;
    }
  }
}

}  // namespace fascicle::muscle
