#include "modules/muscle/kernels/collision/place_samples.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {
namespace {

Bounds bounds_of(const float* x, const float* y, const float* z, std::uint32_t count) {
  Bounds box{glm::vec3(x[0], y[0], z[0]), glm::vec3(x[0], y[0], z[0])};
  for (std::uint32_t i = 1; i < count; ++i) {
    const glm::vec3 p(x[i], y[i], z[i]);
    box.lower = glm::min(box.lower, p);
    box.upper = glm::max(box.upper, p);
  }
  return box;
}

Bounds join(const Bounds& a, const Bounds& b) { return {glm::min(a.lower, b.lower), glm::max(a.upper, b.upper)}; }

RowDisc disc_of(const SampleRow& row, const float* x, const float* y, const float* z, const CollisionWork& work) {
  const std::uint32_t next = row.weight > 0.0f ? row.section + 1 : row.section;
  RowDisc disc;
  disc.centre = glm::mix(work.a[row.section], work.a[next], row.weight);
  const glm::vec3 normal = glm::mix(work.t[row.section], work.t[next], row.weight);
  const float length = glm::length(normal);
  if (length > 0.1f) disc.normal = normal / length;
  const glm::vec3 c = disc.centre, n = disc.normal;
  float furthest = 0.0f, thickest = 0.0f;
  for (std::uint32_t i = 0; i < row.sample_count; ++i) {
    const float dx = x[i] - c.x, dy = y[i] - c.y, dz = z[i] - c.z;
    furthest = std::max(furthest, dx * dx + dy * dy + dz * dz);
    thickest = std::max(thickest, std::abs(dx * n.x + dy * n.y + dz * n.z));
  }
  disc.radius = std::sqrt(furthest);
  disc.thickness = length > 0.1f ? thickest : disc.radius;
  return disc;
}

void place_vertices(const CollisionAsset& asset, CollisionWork& work) {
  for (std::size_t s = 0; s < asset.sections.size(); ++s) {
    const CollisionSection& section = asset.sections[s];
    const std::uint32_t first = section.first_radius;
    const glm::vec3 a = work.a[s];
    float widest = 0.0f, least = 0.0f;
    for (std::uint32_t i = first; i < first + section.count; ++i) {
      const float r = work.radii[i];
      work.vertex_x[i] = a.x + r * work.dir_x[i];
      work.vertex_y[i] = a.y + r * work.dir_y[i];
      work.vertex_z[i] = a.z + r * work.dir_z[i];
      widest = std::max(widest, std::abs(r));
      least = std::min(least, r);
    }
    work.widest[s] = widest;
    work.turned[s] = least < 0.0f;
    const float* r = &work.radii[first];
    const std::uint32_t n = section.count;
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t before = i == 0 ? n - 1 : i - 1, next = i + 1 == n ? 0 : i + 1, last = next + 1 == n ? 0 : next + 1;
      work.sector[first + i] = std::max(std::max(r[before], r[i]), std::max(r[next], r[last]));
    }
  }
}

}  // namespace

void place_directions(const CollisionAsset& asset, CollisionWork& work) {
  for (std::size_t s = 0; s < asset.sections.size(); ++s) {
    const CollisionSection& section = asset.sections[s];
    const Circle& circle = asset.muscles->circles[asset.muscles->layouts[section.muscle].circle];
    const glm::vec3 u = work.u[s], v = work.v[s];
    for (std::uint32_t i = 0; i < section.count; ++i) {
      const float c = circle.cosines[i], d = circle.sines[i];
      work.dir_x[section.first_radius + i] = c * u.x + d * v.x;
      work.dir_y[section.first_radius + i] = c * u.y + d * v.y;
      work.dir_z[section.first_radius + i] = c * u.z + d * v.z;
    }
  }
}

void place_samples(const CollisionAsset& asset, CollisionWork& work) {
  place_vertices(asset, work);
  for (std::size_t m = 0; m < asset.muscles->size(); ++m) {
    Bounds before, all;
    for (std::uint32_t s = asset.first_section[m]; s < asset.first_section[m + 1]; ++s) {
      const std::uint32_t i = asset.sections[s].first_radius;
      const Bounds here = bounds_of(&work.vertex_x[i], &work.vertex_y[i], &work.vertex_z[i], asset.sections[s].count);
      if (s > asset.first_section[m]) work.segment_boxes[s - 1] = join(before, here);
      all = s > asset.first_section[m] ? join(all, here) : here;
      before = here;
    }
    work.muscle_boxes[m] = all;
  }
  for (std::size_t r = 0; r < asset.rows.size(); ++r) {
    const SampleRow& row = asset.rows[r];
    const CollisionSection& section = asset.sections[row.section];
    float* x = &work.sample_x[row.first_sample];
    float* y = &work.sample_y[row.first_sample];
    float* z = &work.sample_z[row.first_sample];
    const std::uint32_t from = section.first_radius;
    const std::uint32_t to = row.weight > 0.0f ? asset.sections[row.section + 1].first_radius : from;
    for (std::uint32_t i = 0; i < row.sample_count; ++i) {
      const SurfaceSample& sample = asset.samples[row.first_sample + i];
      const SampleWeights w = sample_weights(row.weight, kSampleFraction * static_cast<float>(sample.fraction));
      const std::uint32_t here = sample.vertex, next = here + 1 == section.count ? 0 : here + 1;
      const std::uint32_t at[4] = {from + here, from + next, to + here, to + next};
      const auto mix = [&](const AlignedVector<float>& c) {
        return w.of[0] * c[at[0]] + w.of[1] * c[at[1]] + w.of[2] * c[at[2]] + w.of[3] * c[at[3]];
      };
      x[i] = mix(work.vertex_x);
      y[i] = mix(work.vertex_y);
      z[i] = mix(work.vertex_z);
    }
    work.row_boxes[r] = bounds_of(x, y, z, row.sample_count);
    work.row_discs[r] = disc_of(row, x, y, z, work);
  }
}

}  // namespace fascicle::muscle
