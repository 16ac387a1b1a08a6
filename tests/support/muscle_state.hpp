// One musculature's state outside of any world, stepped kernel by kernel: for tests of kernels.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/components/lay_out_state.hpp"
#include "modules/muscle/systems/kernel_jobs.hpp"

namespace fascicle::test {

struct MuscleState {
  muscle::Musculature musculature;
  muscle::ActionLines lines;
  muscle::CrossSections sections;
  muscle::Tendons tendons;
  muscle::MuscleSurfaces surfaces;
  std::vector<float> volumes;

  explicit MuscleState(std::shared_ptr<const muscle::MuscleAsset> asset) {
    musculature.attached.assign(asset->size(), 1);
    muscle::lay_out(*asset, lines);
    muscle::lay_out(*asset, sections);
    muscle::lay_out(*asset, tendons);
    muscle::lay_out(*asset, surfaces);
    volumes.assign(asset->size(), 0.0f);
    musculature.asset = std::move(asset);
  }

  const muscle::MuscleAsset& asset() const { return *musculature.asset; }

  void step(const muscle::MtuKernels& kernels, const std::vector<glm::mat4>& bones, bool restart_twist = false,
            bool stream = false) {
    const BoneMatrices matrices{bones, 0};
    kernels.place_points(muscle::place_points_job(musculature, matrices, lines));
    kernels.build_frames(muscle::build_frames_job(musculature, matrices, lines, restart_twist, sections));
    shape(kernels, stream);
  }

  // Everything that follows from lines, frames and radii.
  void shape(const muscle::MtuKernels& kernels, bool stream = false) {
    kernels.find_tendons(muscle::find_tendons_job(asset(), sections, tendons));
    const muscle::SectionsView view = muscle::sections_view(musculature, lines, sections, tendons);
    kernels.write_surfaces(muscle::write_surfaces_job(view, stream, surfaces));
    muscle::MeasureVolumeJob job;
    job.sections = view;
    job.volumes = volumes.data();
    kernels.measure_volume(job);
  }

  glm::vec3 point(std::uint32_t m, std::uint32_t k) const { return muscle::line_point(asset(), lines, m, k); }
  glm::vec3 u(std::uint32_t m, std::uint32_t k) const {
    const std::uint32_t s = asset().slot(m, k);
    return {sections.ux[s], sections.uy[s], sections.uz[s]};
  }
  glm::vec3 v(std::uint32_t m, std::uint32_t k) const {
    const std::uint32_t s = asset().slot(m, k);
    return {sections.vx[s], sections.vy[s], sections.vz[s]};
  }
  float twist(std::uint32_t m) const { return sections.twist[asset().muscles[m].lane_index]; }
  std::span<const muscle::SurfaceVertex> vertices(std::uint32_t m) const {
    return std::span(surfaces.vertices).subspan(asset().muscles[m].first_vertex, asset().muscles[m].vertex_count);
  }
};

// The levels that this machine has.
inline std::vector<SimdLevel> available_levels() {
  std::vector<SimdLevel> levels;
  for (const SimdLevel level : {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
    if (level <= detect_simd()) levels.push_back(level);
  }
  return levels;
}

}  // namespace fascicle::test
