// A lookup has to be cheap in random order, so it is three dependent steps: point to brick, brick to samples by one
// load from a small dense table, and eight samples that lie together. Bricks are of 8^3 samples and 7^3 cells:
// neighbouring bricks repeat the samples of the face that they share, so a cell never straddles two bricks, and rows of
// eight floats are aligned to half a cache line, so the eight corners lie in two to four lines. What repeating costs is
// half as many samples again; what a sparse tree costs is a walk through its nodes for each lookup.
//
// In random order each of these loads misses the nearest cache, and whether a brick has samples can't be foreseen. So
// many points are looked up in blocks: first all their cells, whose misses overlap, then all their samples.
#include "modules/muscle/asset/collision/bone_field.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle::muscle {

namespace {

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

constexpr std::uint32_t kFarBit = 0x80000000u;
constexpr int kRow = kBrickSamples, kSlab = kBrickSamples * kBrickSamples;

// The squared gaps, in bricks, along one axis: for each brick of a line the least of `squares` plus the squared gap.
void spread_gaps(std::vector<float>& squares, std::size_t first, std::size_t step, int count,
                 std::vector<float>& line) {
  line.resize(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    float least = squares[first + static_cast<std::size_t>(i) * step];
    for (int j = 0; j < count; ++j) {
      const float gap = static_cast<float>(std::max(std::abs(i - j) - 1, 0));
      least = std::min(least, squares[first + static_cast<std::size_t>(j) * step] + gap * gap);
    }
    line[static_cast<std::size_t>(i)] = least;
  }
  for (std::size_t i = 0; i < line.size(); ++i) squares[first + i * step] = line[i];
}

// For each brick the least gap, in bricks, between it and one that the surface may pass through.
std::vector<float> gaps_to_surface(const BoneSamples& field) {
  const glm::ivec3 n = field.count;
  const auto nx = static_cast<std::size_t>(n.x), ny = static_cast<std::size_t>(n.y), nz = static_cast<std::size_t>(n.z);
  const float touches = 2.0f * field.voxel;  // a point of a brick has a sample within sqrt(3) / 2 voxels
  std::vector<float> squares(nx * ny * nz, kNowhere);
  for (std::size_t b = 0; b < field.bricks.size(); ++b) {
    const auto first = field.samples.begin() + static_cast<std::ptrdiff_t>(b * kSamplesPerBrick);
    const bool near = std::any_of(first, first + kSamplesPerBrick, [&](float d) { return std::abs(d) < touches; });
    if (near) squares[field.bricks[b]] = 0.0f;
  }
  std::vector<float> line;
  for (std::size_t i = 0; i < nx * ny; ++i) spread_gaps(squares, i * nz, 1, n.z, line);
  for (std::size_t i = 0; i < nx; ++i) {
    for (std::size_t k = 0; k < nz; ++k) spread_gaps(squares, i * ny * nz + k, nz, n.y, line);
  }
  for (std::size_t i = 0; i < ny * nz; ++i) spread_gaps(squares, i, ny * nz, n.x, line);
  for (float& square : squares) square = std::sqrt(square);
  return squares;
}

}  // namespace

// The cell of samples that a point lies in.
struct BoneField::Cell {
  const float* corner = nullptr;       // its lowest sample
  float x = 0.0f, y = 0.0f, z = 0.0f;  // in the cell, 0 to 1
  float bound = 0.0f;                  // m: the brick's, above 0, where it has no samples; else 0
};

BoneField::BoneField(BoneSamples field)
    : voxel_(field.voxel), band_(field.band), inverse_voxel_(1.0f / field.voxel), lower_(field.lower),
      upper_(field.upper), origin_(field.origin), extent_(glm::vec3(field.count * kBrickCells)), count_(field.count) {
  const std::vector<float> gaps = gaps_to_surface(field);
  table_.resize(gaps.size());
  const float brick = voxel_ * static_cast<float>(kBrickCells);
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    // A shade less: the gap is exact, its product rounded.
    const float bound = std::max(band_, gaps[i] * brick * 0.99999f);
    table_[i] = std::bit_cast<std::uint32_t>(std::min(bound, kNowhere)) | kFarBit;
  }
  for (std::size_t b = 0; b < field.bricks.size(); ++b) table_[field.bricks[b]] = static_cast<std::uint32_t>(b);
  samples_ = std::move(field.samples);
  samples_.shrink_to_fit();
  if (samples_.empty()) extent_ = glm::vec3(-1.0f);
}

// False beyond all bricks, where comparisons are written so that points that are not finite end up too.
inline bool BoneField::find_cell(const glm::vec3& point, Cell& cell) const {
  const float x = (point.x - origin_.x) * inverse_voxel_;
  const float y = (point.y - origin_.y) * inverse_voxel_;
  const float z = (point.z - origin_.z) * inverse_voxel_;
  if (!(x >= 0.0f && y >= 0.0f && z >= 0.0f && x < extent_.x && y < extent_.y && z < extent_.z)) return false;
  const auto cells_x = static_cast<std::int32_t>(x), cells_y = static_cast<std::int32_t>(y),
             cells_z = static_cast<std::int32_t>(z);
  const std::int32_t brick_x = cells_x / kBrickCells, brick_y = cells_y / kBrickCells, brick_z = cells_z / kBrickCells;
  const std::uint32_t place = table_[static_cast<std::uint32_t>((brick_x * count_.y + brick_y) * count_.z + brick_z)];
  const std::int32_t local = (cells_x - brick_x * kBrickCells) * kSlab + (cells_y - brick_y * kBrickCells) * kRow +
                             (cells_z - brick_z * kBrickCells);
  const bool far = (place & kFarBit) != 0;
  // Both are always set, so that nothing waits for the table here.
  const std::size_t sample = std::size_t{place} * kSamplesPerBrick + static_cast<std::uint32_t>(local);
  cell.corner = samples_.data() + (far ? 0 : sample);
  cell.bound = std::bit_cast<float>(far ? place & ~kFarBit : 0u);
  cell.x = x - static_cast<float>(cells_x);
  cell.y = y - static_cast<float>(cells_y);
  cell.z = z - static_cast<float>(cells_z);
  return true;
}

inline float BoneField::interpolate(const Cell& cell) const {
  const float* c = cell.corner;
  const float low_low = c[0] + cell.z * (c[1] - c[0]);
  const float low_high = c[kRow] + cell.z * (c[kRow + 1] - c[kRow]);
  const float high_low = c[kSlab] + cell.z * (c[kSlab + 1] - c[kSlab]);
  const float high_high = c[kSlab + kRow] + cell.z * (c[kSlab + kRow + 1] - c[kSlab + kRow]);
  const float low = low_low + cell.y * (low_high - low_low);
  const float high = high_low + cell.y * (high_high - high_low);
  const float distance = low + cell.x * (high - low);
  // Between samples a distance may lie below what is interpolated, by h^2 / 4d at most: its second derivatives add up
  // to no more than 2 / d. Beyond the band the answer is a bound, so that much is taken off, without a step.
  const float bounded = std::max(band_, distance - 0.25f * voxel_);
  return distance <= band_ ? distance : bounded;
}

// A lower bound of the distance of a point beyond all bricks.
float BoneField::far_distance(const glm::vec3& point) const {
  if (extent_.x < 0.0f || !is_finite(point)) return kNowhere;
  const glm::vec3 gap = glm::max(glm::max(lower_ - point, point - upper_), glm::vec3(0.0f));
  const float square = gap.x * gap.x + gap.y * gap.y + gap.z * gap.z;
  return std::min(std::max(band_, std::sqrt(square) * 0.99999f), kNowhere);
}

glm::vec3 BoneField::away(const glm::vec3& point) const {
  if (extent_.x < 0.0f || !is_finite(point)) return glm::vec3(0.0f);
  glm::vec3 direction = point - glm::clamp(point, lower_, upper_);
  if (direction == glm::vec3(0.0f)) direction = point - 0.5f * (lower_ + upper_);
  const float largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  if (!(largest > 0.0f) || !std::isfinite(largest)) return glm::vec3(0.0f);
  return glm::normalize(direction / largest);
}

float BoneField::distance(const glm::vec3& point) const {
  Cell cell;
  if (!find_cell(point, cell)) return far_distance(point);
  return cell.bound > 0.0f ? cell.bound : interpolate(cell);
}

FieldValue BoneField::at(const glm::vec3& point) const {
  Cell cell;
  if (!find_cell(point, cell)) return {far_distance(point), away(point)};
  if (cell.bound > 0.0f) return {cell.bound, away(point)};
  const float distance = interpolate(cell);
  if (distance > band_) return {distance, away(point)};
  const float* c = cell.corner;
  const float x = cell.x, y = cell.y, z = cell.z;
  // Corners by x, y, z, low or high: the derivative along an axis interpolates the four differences along it.
  const float lll = c[0], llh = c[1], lhl = c[kRow], lhh = c[kRow + 1];
  const float hll = c[kSlab], hlh = c[kSlab + 1], hhl = c[kSlab + kRow], hhh = c[kSlab + kRow + 1];
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  const glm::vec3 gradient(mix(mix(hll - lll, hlh - llh, z), mix(hhl - lhl, hhh - lhh, z), y),
                           mix(mix(lhl - lll, lhh - llh, z), mix(hhl - hll, hhh - hlh, z), x),
                           mix(mix(llh - lll, lhh - lhl, y), mix(hlh - hll, hhh - hhl, y), x));
  // A distance rises by a voxel a voxel; where it hardly rises, at the ridges of its middle, no way is out.
  const float length = glm::length(gradient);
  return {distance, length > 1e-4f * voxel_ ? gradient / length : glm::vec3(0.0f)};
}

void BoneField::distances(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                          std::span<float> distance) const {
  if (samples_.empty()) return std::fill(distance.begin(), distance.end(), kNowhere);
  constexpr std::size_t kBlock = 32;
  std::array<Cell, kBlock> cells;
  for (std::size_t first = 0; first < distance.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, distance.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      Cell& cell = cells[i];
      if (!find_cell({x[first + i], y[first + i], z[first + i]}, cell)) {
        cell.corner = samples_.data();
        cell.bound = far_distance({x[first + i], y[first + i], z[first + i]});
        continue;
      }
      __builtin_prefetch(cell.corner);
      __builtin_prefetch(cell.corner + kSlab);
    }
    // Without a branch: which of the two it is can't be foreseen, and those without samples read the first ones.
    for (std::size_t i = 0; i < count; ++i) {
      const float interpolated = interpolate(cells[i]);
      distance[first + i] = cells[i].bound > 0.0f ? cells[i].bound : interpolated;
    }
  }
}

std::size_t BoneField::heap_bytes() const {
  return table_.capacity() * sizeof(table_[0]) + samples_.capacity() * sizeof(float);
}

}  // namespace fascicle::muscle
