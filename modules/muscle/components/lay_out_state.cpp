#include "modules/muscle/components/lay_out_state.hpp"

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {

void lay_out(const MuscleAsset& asset, ActionLines& lines) {
  lines.x = asset.rest_x;
  lines.y = asset.rest_y;
  lines.z = asset.rest_z;
  lines.held.assign(asset.size(), 0);
  lines.held_lanes.assign(asset.lane_count, 0);
}

void lay_out(const MuscleAsset& asset, CrossSections& sections) {
  sections.ux = asset.rest_ux;
  sections.uy = asset.rest_uy;
  sections.uz = asset.rest_uz;
  sections.vx = asset.rest_vx;
  sections.vy = asset.rest_vy;
  sections.vz = asset.rest_vz;
  sections.arc = asset.rest_arc;
  sections.radii = asset.rest_radii;
  sections.twist.assign(asset.lane_count, 0.0f);
}

void lay_out(const MuscleAsset& asset, Tendons& tendons) {
  for (std::size_t end = 0; end < 2; ++end) {
    tendons.segment[end].assign(asset.lane_count, 0);
    tendons.fraction[end].assign(asset.lane_count, 0.0f);
    tendons.arc[end].assign(asset.lane_count, 0.0f);
  }
}

void lay_out(const MuscleAsset& asset, MuscleMeasures& measures) {
  for (std::vector<float>* values : {&measures.length, &measures.drawn_length, &measures.volume, &measures.mass,
                                     &measures.pcsa, &measures.force}) {
    values->assign(asset.size(), 0.0f);
  }
  measures.tendon_point.assign(asset.size(), glm::vec3(0.0f));
}

void lay_out(const MuscleAsset& asset, MuscleSurfaces& surfaces) {
  surfaces.vertices.assign(asset.vertex_count, SurfaceVertex{});
  surfaces.rows.assign(asset.row_count, SurfaceRow{});
  for (std::uint32_t row = 0; row < asset.row_count; ++row) surfaces.rows[row].muscle = asset.row_muscles[row];
}

void lay_out(const CollisionAsset& asset, MuscleCollision& collision) {
  for (AlignedVector<float>* axis : {&collision.offset_x, &collision.offset_y, &collision.offset_z}) {
    axis->assign(asset.muscles->slot_count, 0.0f);
  }
  collision.radii = collision.rest_radii = asset.muscles->rest_radii;
  collision.target_area.assign(asset.sections.size(), 0.0f);
  collision.area.assign(asset.sections.size(), 0.0f);
  collision.depth.assign(asset.muscles->size(), 0.0f);
  collision.cost.assign(asset.muscles->size(), 0.0f);
  collision.morph = 0.0f;
  collision.still = 0.0f;
  collision.asset = &asset;
}

}  // namespace fascicle::muscle
