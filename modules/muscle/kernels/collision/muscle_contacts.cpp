#include "modules/muscle/kernels/collision/muscle_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/kernels/collision/contact_rows.hpp"
#include "modules/muscle/kernels/collision/section_outline.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kMostCellsAlong = 8.0f;  // cells are so wide that no segment lies in more along an axis
constexpr float kSlack = 1.05f;          // of a radius: frames between two sections are mixed
constexpr float kSmallestCell = 1.0e-4f;  // m

std::uint32_t hash_cell(int x, int y, int z, std::uint32_t mask) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^ static_cast<std::uint32_t>(y) * 0xd8163841u ^
                    static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
  h ^= h >> 15;
  return h & mask;
}

template <class F>
void for_each_cell(const Bounds& box, float cell, std::uint32_t mask, F&& f) {
  const glm::ivec3 lower(glm::floor(box.lower / cell)), upper(glm::floor(box.upper / cell));
  for (int z = lower.z; z <= upper.z; ++z) {
    for (int y = lower.y; y <= upper.y; ++y) {
      for (int x = lower.x; x <= upper.x; ++x) f(hash_cell(x, y, z, mask));
    }
  }
}

bool overlap(const Bounds& a, const Bounds& b, float reach) {
  return a.lower.x <= b.upper.x + reach && b.lower.x <= a.upper.x + reach && a.lower.y <= b.upper.y + reach &&
         b.lower.y <= a.upper.y + reach && a.lower.z <= b.upper.z + reach && b.lower.z <= a.upper.z + reach;
}

std::uint32_t cell_mask(const CollisionAsset& asset) {
  std::uint32_t cells = 256;
  while (cells < 4 * asset.sections.size()) cells *= 2;
  return cells - 1;
}

// Calls f(segment) for the segments there are: all sections but their muscles' last.
template <class F>
void for_each_segment(const CollisionAsset& asset, F&& f) {
  for (std::size_t m = 0; m + 1 < asset.first_section.size(); ++m) {
    for (std::uint32_t s = asset.first_section[m]; s + 1 < asset.first_section[m + 1]; ++s) f(s);
  }
}

// About the angle of (x, y), 0..1 of a turn: within a hundredth.
float turn_of(float x, float y) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float ratio = std::min(ax, ay) / std::max(std::max(ax, ay), 1.0e-12f);
  float turn = ratio * (0.1785f - 0.0538f * ratio);
  if (ay > ax) turn = 0.25f - turn;
  if (x < 0.0f) turn = 0.5f - turn;
  if (y < 0.0f) turn = 1.0f - turn;
  return std::min(std::max(turn, 0.0f), 0.9999f);
}

// How far a row's samples reach from their centre in a direction.
float reach_along(const RowDisc& disc, const glm::vec3& direction) {
  const float along = glm::dot(disc.normal, direction);
  return disc.radius * std::sqrt(std::max(1.0f - along * along, 0.0f)) + disc.thickness * std::abs(along);
}

// Where a row's samples are against a segment.
struct RowPlaces {
  float along[kMaxRowSamples];                    // fraction from the first section to the second; negative: beyond
  float u[kMaxRowSamples], v[kMaxRowSamples];     // m, from the centre line
  float square[kMaxRowSamples];                   // m^2, the distance from it
};

class MuscleTest {
 public:
  MuscleTest(const CollisionAsset& asset, float margin, float reach, bool at_rest, CollisionWork& work)
      : asset_(asset), margin_(margin), reach_(reach), at_rest_(at_rest), work_(work) {}

  void test(std::uint32_t r, std::uint32_t muscle, std::uint32_t segment) {
    const std::uint32_t other = asset_.sections[segment].muscle;
    const std::uint8_t kind = asset_.muscles_touch[muscle * asset_.muscles->size() + other];
    if (kind == kNeverTouch || work_.absent[other] != 0) return;
    if (!overlap(work_.row_boxes[r], work_.segment_boxes[segment], margin_ + reach_)) return;
    const glm::vec3 a0 = work_.a[segment], a1 = work_.a[segment + 1];
    const glm::vec3 t0 = work_.t[segment], t1 = work_.t[segment + 1];
    const RowDisc& disc = work_.row_discs[r];
    const float enter = glm::dot(disc.centre - a0, t0), leave = glm::dot(disc.centre - a1, t1);
    if (enter < -reach_along(disc, t0) || leave > reach_along(disc, t1)) return;
    const float widest = std::max(work_.widest[segment], work_.widest[segment + 1]) + margin_ + reach_ + disc.radius;
    const float middle = enter > 0.0f && leave < 0.0f ? enter / (enter - leave) : (enter > 0.0f ? 1.0f : 0.0f);
    const glm::vec3 apart = disc.centre - glm::mix(a0, a1, middle);
    if (glm::dot(apart, apart) > widest * widest) return;
    const SampleRow& row = asset_.rows[r];
    const float* x = &work_.sample_x[row.first_sample];
    const float* y = &work_.sample_y[row.first_sample];
    const float* z = &work_.sample_z[row.first_sample];
    // All samples at once: how far along the segment they are, and where from its centre line.
    const glm::vec3 u0 = work_.u[segment], u1 = work_.u[segment + 1], v0 = work_.v[segment], v1 = work_.v[segment + 1];
    RowPlaces& at = places_;
    for (std::uint32_t i = 0; i < row.sample_count; ++i) {
      const float before = (x[i] - a0.x) * t0.x + (y[i] - a0.y) * t0.y + (z[i] - a0.z) * t0.z;
      const float behind = (x[i] - a1.x) * t1.x + (y[i] - a1.y) * t1.y + (z[i] - a1.z) * t1.z;
      const float along = before / (before - behind);  // 0 to 1 between the sections, elsewhere whatever
      const float dx = x[i] - (a0.x + along * (a1.x - a0.x));
      const float dy = y[i] - (a0.y + along * (a1.y - a0.y));
      const float dz = z[i] - (a0.z + along * (a1.z - a0.z));
      at.u[i] = dx * (u0.x + along * (u1.x - u0.x)) + dy * (u0.y + along * (u1.y - u0.y)) +
                dz * (u0.z + along * (u1.z - u0.z));
      at.v[i] = dx * (v0.x + along * (v1.x - v0.x)) + dy * (v0.y + along * (v1.y - v0.y)) +
                dz * (v0.z + along * (v1.z - v0.z));
      at.along[i] = (before >= 0.0f) & (behind < 0.0f) ? along : -1.0f;
      at.square[i] = dx * dx + dy * dy + dz * dz;
    }
    const float furthest = std::max(work_.widest[segment], work_.widest[segment + 1]) + margin_ + reach_;
    const bool turned = work_.turned[segment] != 0 || work_.turned[segment + 1] != 0;
    for (std::uint32_t i = 0; i < row.sample_count; ++i) {
      if (at.along[i] < 0.0f || at.square[i] > furthest * furthest) continue;
      if (!turned && !may_touch(segment, at.along[i], at.u[i], at.v[i], at.square[i])) continue;
      touch(r, i, segment, other, kind == kInterpenetrate, at.along[i], glm::vec3(x[i], y[i], z[i]));
    }
  }

 private:
  // False where a point is certainly out of reach of the outline: further from the centre than the radii towards it.
  bool may_touch(std::uint32_t segment, float along, float u, float v, float square) const {
    const CollisionSection& section = asset_.sections[segment];
    const std::uint32_t i = static_cast<std::uint32_t>(turn_of(u, v) * static_cast<float>(section.count));
    const float first = work_.sector[section.first_radius + i];
    const float second = work_.sector[asset_.sections[segment + 1].first_radius + i];
    const float largest = first + along * (second - first);
    const float bound = kSlack * largest + margin_ + reach_;
    return square <= bound * bound;
  }

  void touch(std::uint32_t r, std::uint32_t i, std::uint32_t segment, std::uint32_t other, bool deep, float along,
             const glm::vec3& p) {
    OutlineSegment outline;
    outline.count = asset_.sections[segment].count;
    for (std::uint32_t k = 0; k < 2; ++k) {
      const std::uint32_t first = asset_.sections[segment + k].first_radius;
      outline.x[k] = &work_.vertex_x[first];
      outline.y[k] = &work_.vertex_y[first];
      outline.z[k] = &work_.vertex_z[first];
      outline.u[k] = work_.u[segment + k];
      outline.v[k] = work_.v[segment + k];
    }
    // What overlaps at rest has no side that it came from: the nearest way out is the best there is.
    const float allowed = allowed_depth(r, i, other);
    const bool any_side = at_rest_ || deep || allowed > 0.0f;
    const glm::vec3 outward = any_side ? glm::vec3(0.0f) : sample_normal(asset_, work_, r, i);
    OutlinePoint point;
    if (!find_outline_point(outline, along, p, outward, margin_ + reach_, point)) return;
    const float value = point.distance + allowed - margin_;
    if (value > reach_) return;
    Contact contact;
    contact.normal = point.normal;
    carry_sample(asset_, work_, r, i, contact);
    carry_outline(asset_, work_, segment, along, point.edge, point.fraction, contact);
    contact.found = value;
    contact.allowed = allowed;
    // n . (c - q) is the distance now.
    contact.base = margin_ - allowed;
    add_contact(contact, work_);
  }

  float allowed_depth(std::uint32_t r, std::uint32_t i, std::uint32_t other) const {
    for (std::uint32_t o = asset_.first_overlap[r]; o < asset_.first_overlap[r + 1]; ++o) {
      if (asset_.overlaps[o].other == other) return asset_.rest_depths[asset_.overlaps[o].first_depth + i];
    }
    return 0.0f;
  }

  const CollisionAsset& asset_;
  RowPlaces places_;
  float margin_, reach_;
  bool at_rest_;
  CollisionWork& work_;
};

}  // namespace

void fill_grid(const CollisionAsset& asset, CollisionWork& work) {
  float sum = 0.0f, largest = 0.0f, segments = 0.0f;
  for_each_segment(asset, [&](std::uint32_t s) {
    const glm::vec3 extent = work.segment_boxes[s].upper - work.segment_boxes[s].lower;
    const float longest = std::max({extent.x, extent.y, extent.z});
    sum += longest;
    segments += 1.0f;
    largest = std::max(largest, longest);
  });
  work.cell = std::max({segments > 0.0f ? sum / segments : 0.0f, largest / kMostCellsAlong, kSmallestCell});

  // Counting sort: numbers, then ends, then, filled from behind, starts.
  const std::uint32_t mask = cell_mask(asset);
  std::vector<std::uint32_t>& starts = work.cell_starts;
  std::fill_n(starts.begin(), mask + 2, 0u);
  for_each_segment(asset, [&](std::uint32_t s) {
    for_each_cell(work.segment_boxes[s], work.cell, mask, [&](std::uint32_t cell) { ++starts[cell]; });
  });
  for (std::uint32_t cell = 1; cell <= mask + 1; ++cell) starts[cell] += starts[cell - 1];
  if (starts[mask + 1] > work.cell_segments.size()) {
    work.overflow = true;
    std::fill_n(starts.begin(), mask + 2, 0u);
    return;
  }
  for_each_segment(asset, [&](std::uint32_t s) {
    for_each_cell(work.segment_boxes[s], work.cell, mask,
                  [&](std::uint32_t cell) { work.cell_segments[--starts[cell]] = s; });
  });
}

void find_muscle_contacts(const CollisionAsset& asset, float margin, float reach, bool at_rest, CollisionWork& work) {
  const std::uint32_t mask = cell_mask(asset);
  MuscleTest muscle_test(asset, margin, reach, at_rest, work);
  std::fill(work.stamps.begin(), work.stamps.end(), 0xffffffffu);
  for (std::uint32_t m = 0; m + 1 < asset.first_row.size(); ++m) {
    if (work.absent[m] != 0) continue;
    for (std::uint32_t r = asset.first_row[m]; r < asset.first_row[m + 1]; ++r) {
      for_each_cell(work.row_boxes[r], work.cell, mask, [&](std::uint32_t cell) {
        for (std::uint32_t place = work.cell_starts[cell]; place < work.cell_starts[cell + 1]; ++place) {
          const std::uint32_t segment = work.cell_segments[place];
          if (work.stamps[segment] == r) continue;
          work.stamps[segment] = r;
          if (asset.sections[segment].muscle != m) muscle_test.test(r, m, segment);
        }
      });
    }
  }
}

}  // namespace fascicle::muscle
