#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {

std::int32_t find_muscle(const MuscleAsset& asset, std::string_view name) {
  for (std::size_t i = 0; i < asset.muscles.size(); ++i) {
    if (asset.muscles[i].name == name) return static_cast<std::int32_t>(i);
  }
  return -1;
}

MuscleCounts count_muscles(const MuscleAsset& asset) {
  MuscleCounts counts;
  for (const MuscleLayout& muscle : asset.muscles) {
    counts.muscles += 1;
    counts.sections += muscle.counted_sections;
    counts.vertices += muscle.counted_vertices;
  }
  return counts;
}

glm::vec3 rest_point(const MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section) {
  const std::uint32_t slot = asset.slot(muscle, section);
  return {asset.rest_x[slot], asset.rest_y[slot], asset.rest_z[slot]};
}

std::size_t heap_bytes(const MuscleAsset& asset) {
  const auto bytes = [](const auto& array) { return array.capacity() * sizeof(array[0]); };
  std::size_t sum = bytes(asset.muscles) + bytes(asset.layouts) + bytes(asset.blocks) + bytes(asset.circles) +
                    bytes(asset.ends) + bytes(asset.tendon_lengths[0]) + bytes(asset.tendon_lengths[1]) +
                    bytes(asset.points) + bytes(asset.rest_x) + bytes(asset.rest_y) + bytes(asset.rest_z) +
                    bytes(asset.rest_radii) + bytes(asset.strip_indices) + bytes(asset.fan_indices) +
                    bytes(asset.vertex_rows) + bytes(asset.row_muscles);
  for (const auto* array : {&asset.rest_ux, &asset.rest_uy, &asset.rest_uz, &asset.rest_vx, &asset.rest_vy,
                            &asset.rest_vz, &asset.rest_arc}) {
    sum += bytes(*array);
  }
  for (const CircleTable& table : asset.circle_tables) sum += bytes(table.cosines) + bytes(table.sines);
  return sum;
}

}  // namespace fascicle::muscle
