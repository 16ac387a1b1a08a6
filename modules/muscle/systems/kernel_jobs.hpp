// Kernel jobs over a musculature's components: the one place that matches their arrays with the kernels' pointers.
#pragma once

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/asset/muscle_levels.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/components/tendons.hpp"
#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle {

// Musculatures a parallel chunk: one takes around 10 microseconds in the larger systems.
inline constexpr std::size_t kMusculaturesPerChunk = 4;

// True where the character has the matrices that the asset's muscles need.
inline bool has_bones(const MuscleAsset& asset, const BoneMatrices* bones) {
  return bones != nullptr && asset.bone_count > 0 && bones->world.size() >= asset.bone_count;
}

inline PlacePointsJob place_points_job(const Musculature& musculature, const BoneMatrices& bones, ActionLines& lines) {
  const MuscleAsset& asset = *musculature.asset;
  PlacePointsJob job;
  job.bones = &bones.world[0][0][0];
  job.points = asset.points.data();
  job.single_count = asset.single_point_count;
  job.count = asset.points.size();
  if (musculature.morph > 0.0f) {
    job.targets = musculature.coarser->points.data();
    job.morph = musculature.morph;
  }
  job.held = lines.any_held ? lines.held.data() : nullptr;
  job.x = lines.x.data();
  job.y = lines.y.data();
  job.z = lines.z.data();
  return job;
}

inline BuildFramesJob build_frames_job(const Musculature& musculature, const BoneMatrices& bones,
                                       const ActionLines& lines, bool restart_twist, CrossSections& sections) {
  const MuscleAsset& asset = *musculature.asset;
  BuildFramesJob job;
  job.bones = &bones.world[0][0][0];
  job.blocks = asset.blocks.data();
  job.block_count = asset.blocks.size();
  job.ends = musculature.morph > 0.0f ? sections.ends.data() : asset.ends.data();
  job.held = lines.any_held ? lines.held_lanes.data() : nullptr;
  job.restart_twist = restart_twist;
  job.x = lines.x.data();
  job.y = lines.y.data();
  job.z = lines.z.data();
  job.ux = sections.ux.data();
  job.uy = sections.uy.data();
  job.uz = sections.uz.data();
  job.vx = sections.vx.data();
  job.vy = sections.vy.data();
  job.vz = sections.vz.data();
  job.arc = sections.arc.data();
  job.twist = sections.twist.data();
  return job;
}

inline FindTendonsJob find_tendons_job(const MuscleAsset& asset, const CrossSections& sections, Tendons& tendons) {
  FindTendonsJob job;
  job.blocks = asset.blocks.data();
  job.block_count = asset.blocks.size();
  job.origin_lengths = asset.tendon_lengths[0].data();
  job.insertion_lengths = asset.tendon_lengths[1].data();
  job.arc = sections.arc.data();
  for (std::size_t end = 0; end < 2; ++end) {
    job.segment[end] = tendons.segment[end].data();
    job.fraction[end] = tendons.fraction[end].data();
    job.border_arc[end] = tendons.arc[end].data();
  }
  return job;
}

inline SectionsView sections_view(const Musculature& musculature, const ActionLines& lines,
                                  const CrossSections& sections, const Tendons& tendons) {
  const MuscleAsset& asset = *musculature.asset;
  SectionsView view;
  view.layouts = asset.layouts.data();
  view.muscle_count = asset.layouts.size();
  view.circles = asset.circles.data();
  view.x = lines.x.data();
  view.y = lines.y.data();
  view.z = lines.z.data();
  view.ux = sections.ux.data();
  view.uy = sections.uy.data();
  view.uz = sections.uz.data();
  view.vx = sections.vx.data();
  view.vy = sections.vy.data();
  view.vz = sections.vz.data();
  view.radii = sections.radii.data();
  for (std::size_t end = 0; end < 2; ++end) {
    view.segment[end] = tendons.segment[end].data();
    view.fraction[end] = tendons.fraction[end].data();
  }
  view.attached = musculature.attached.data();
  return view;
}

// The part of a view for one muscle, for timing each by itself.
inline SectionsView single_muscle(SectionsView view, std::uint32_t muscle) {
  view.layouts += muscle;
  view.muscle_count = 1;
  view.attached += muscle;
  return view;
}

inline WriteSurfacesJob write_surfaces_job(const SectionsView& view, bool stream, MuscleSurfaces& surfaces) {
  WriteSurfacesJob job;
  job.sections = view;
  job.vertices = reinterpret_cast<float*>(surfaces.vertices.data());
  job.stream = stream;
  return job;
}

}  // namespace fascicle::muscle
