#include "modules/muscle/kernels/collision/collision_work.hpp"

#include <algorithm>

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {
namespace {

template <class... Arrays>
void grow(std::size_t size, Arrays&... arrays) {
  ((arrays.size() < size ? arrays.resize(size) : void()), ...);
}

template <class... Arrays>
std::size_t bytes_of(const Arrays&... arrays) {
  return (std::size_t{0} + ... + (arrays.capacity() * sizeof(arrays[0])));
}

}  // namespace

void CollisionWork::reserve(const CollisionAsset& asset) {
  const std::size_t sections = asset.sections.size();
  grow(sections, a, driven, u, v, t, mobility, area_target, widest, turned, segment_boxes, stamps);
  const std::size_t radius_count = asset.muscles->rest_radii.size();
  grow(radius_count, radii, wanted, least, most, sector, dir_x, dir_y, dir_z, vertex_x, vertex_y, vertex_z, pressed);
  grow(asset.samples.size(), sample_x, sample_y, sample_z);
  grow(asset.rows.size(), row_boxes, row_discs);
  grow(asset.muscles->size(), muscle_boxes, absent);
  std::size_t cells = 256;
  while (cells < 4 * sections) cells *= 2;
  grow(cells + 2, cell_starts);
  grow(64 * sections + 64, cell_segments);
  contacts.reserve(std::max<std::size_t>(contacts.capacity(), asset.samples.size() + 256));
}

std::size_t heap_bytes(const CollisionWork& w) {
  return bytes_of(w.a, w.driven, w.u, w.v, w.t, w.mobility, w.area_target, w.widest, w.turned, w.radii, w.wanted, w.least, w.most, w.sector, w.dir_x, w.dir_y,
                  w.dir_z, w.vertex_x, w.vertex_y, w.vertex_z, w.pressed, w.sample_x, w.sample_y, w.sample_z,
                  w.segment_boxes, w.row_boxes, w.row_discs, w.muscle_boxes, w.absent, w.cell_starts, w.cell_segments, w.stamps, w.contacts);
}

}  // namespace fascicle::muscle
