#include "modules/muscle/measure/surface_depth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/geometry/finite.hpp"
#include "engine/parallel/for_range.hpp"

namespace fascicle::muscle {
namespace {

constexpr std::size_t kTrianglesPerChunk = 512;
// Far more than any triangle needs: a surface torn apart by a mistake must not take for ever.
constexpr double kMostCuts = 64.0;

using Corners = std::array<glm::dvec3, 3>;

glm::dvec3 place(const SurfacePoint& point) { return {point.x, point.y, point.z}; }

Box box_of(const Corners& corners) {
  Box box = empty_box();
  for (const glm::dvec3& corner : corners) box.add(glm::vec3(corner));
  return box;
}

// Calls `each` with the corners' weights of evenly spaced points, edges and corners included.
template <class F>
void cut_triangle(const Corners& corners, double spacing, F&& each) {
  const double longest = std::max({glm::distance(corners[0], corners[1]), glm::distance(corners[1], corners[2]),
                                   glm::distance(corners[2], corners[0])});
  const int cuts = static_cast<int>(std::clamp(std::ceil(longest / spacing), 1.0, kMostCuts));
  const double step = 1.0 / cuts;
  for (int i = 0; i <= cuts; ++i) {
    for (int j = 0; i + j <= cuts; ++j) each(i * step, j * step);
  }
}

}  // namespace

SurfaceDepthMeter::SurfaceDepthMeter(std::shared_ptr<const SurfaceAsset> asset,
                                     std::shared_ptr<const BoneSolids> bones, float spacing)
    : asset_(std::move(asset)), bones_(std::move(bones)), spacing_(spacing) {
  std::vector<std::uint8_t> vertex(asset_->vertex_count);
  for (const AttachedVertex& attached : asset_->attached) vertex[attached.vertex] = 2;
  const auto each_triangle = [&](auto&& f) {
    for (std::size_t t = 0; t < asset_->triangle_count(); ++t) {
      const std::uint32_t* corners = asset_->triangles.data() + 3 * t;
      const std::uint8_t most = std::max({vertex[corners[0]], vertex[corners[1]], vertex[corners[2]]});
      f(t, corners, most);
    }
  };
  each_triangle([&](std::size_t, const std::uint32_t* corners, std::uint8_t most) {
    if (most < 2) return;
    for (int i = 0; i < 3; ++i) vertex[corners[i]] = std::max<std::uint8_t>(vertex[corners[i]], 1);
  });
  near_attached_.resize(asset_->triangle_count());
  each_triangle([&](std::size_t t, const std::uint32_t*, std::uint8_t most) { near_attached_[t] = most; });
}

SurfaceDepths SurfaceDepthMeter::measure(std::span<const SurfacePoint> points, const glm::mat4& frame,
                                         std::span<const glm::mat4> bones) const {
  struct Near {
    const BoneSolid* solid = nullptr;
    glm::dmat4 to_bone{1.0};
  };
  const glm::dmat4 to_world(frame);
  std::vector<Near> near;
  for (const BoneSolid& solid : *bones_) {
    const auto b = static_cast<std::size_t>(solid.bone());
    if (b < bones.size()) near.push_back({&solid, glm::inverse(glm::dmat4(bones[b])) * to_world});
  }

  std::vector<SurfaceDepths> found(parallel::chunk_count(asset_->triangle_count(), kTrianglesPerChunk));
  const auto measure_triangle = [&](std::size_t t, SurfaceDepths& worst) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = place(points[asset_->triangles[3 * t + i]]);
      if (!is_finite(glm::vec3(corners[i]))) {
        worst.finite = false;
        return;
      }
    }
    if (near_attached_[t] == 2) return;
    SurfaceDepth& deepest = near_attached_[t] == 0 ? worst.free : worst.beside;
    for (const Near& bone : near) {
      Corners local;
      for (std::size_t i = 0; i < 3; ++i) local[i] = glm::dvec3(bone.to_bone * glm::dvec4(corners[i], 1.0));
      if (!box_of(local).meets(bone.solid->box())) continue;
      cut_triangle(local, static_cast<double>(spacing_), [&](double s, double u) {
        ++worst.points;
        const glm::dvec3 point = local[0] + s * (local[1] - local[0]) + u * (local[2] - local[0]);
        const double depth = bone.solid->depth_beyond(glm::vec3(point), deepest.depth);
        if (!(depth > deepest.depth)) return;
        const glm::dvec3 here = corners[0] + s * (corners[1] - corners[0]) + u * (corners[2] - corners[0]);
        deepest = {depth, glm::vec3(to_world * glm::dvec4(here, 1.0)), bone.solid->bone(),
                   static_cast<std::uint32_t>(t)};
      });
    }
  };
  parallel::for_range(asset_->triangle_count(), kTrianglesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) measure_triangle(t, found[begin / kTrianglesPerChunk]);
  });

  SurfaceDepths result;
  for (const SurfaceDepths& chunk : found) {
    if (chunk.free.depth > result.free.depth) result.free = chunk.free;
    if (chunk.beside.depth > result.beside.depth) result.beside = chunk.beside;
    result.points += chunk.points;
    result.finite = result.finite && chunk.finite;
  }
  return result;
}

std::vector<double> attachment_errors(const SurfaceAsset& asset, std::span<const SurfacePoint> points,
                                      const glm::mat4& frame, std::span<const glm::mat4> rest_bones,
                                      std::span<const glm::mat4> bones) {
  std::vector<glm::dmat4> motions(asset.attachments.size(), glm::dmat4(1.0));
  for (std::size_t a = 0; a < asset.attachments.size(); ++a) {
    const auto bone = static_cast<std::size_t>(asset.attachments[a].bone);
    if (bone >= bones.size() || bone >= rest_bones.size()) continue;
    const glm::dmat4 now{bones[bone]}, rest{rest_bones[bone]};
    motions[a] = now * glm::inverse(rest);
  }
  const glm::dmat4 to_world{frame};
  std::vector<double> errors(asset.attachments.size());
  for (const AttachedVertex& attached : asset.attached) {
    const glm::dvec4 here = to_world * glm::dvec4(place(points[attached.vertex]), 1.0);
    const glm::dvec4 there = motions[attached.attachment] * glm::dvec4(place(asset.rest[attached.vertex]), 1.0);
    const double error = glm::distance(glm::dvec3(here), glm::dvec3(there));
    double& worst = errors[attached.attachment];
    worst = std::isfinite(error) ? std::max(worst, error) : std::numeric_limits<double>::infinity();
  }
  return errors;
}

}  // namespace fascicle::muscle
