#include "modules/muscle/kernels/surface/surface_kernels.hpp"

#include "modules/muscle/kernels/surface/surface_kernel_data.hpp"
#include "modules/muscle/kernels/surface/surface_reference.hpp"

namespace fascicle::muscle {

namespace portable {
extern const SurfaceKernelTable kSurfaceKernels;
}
namespace avx2 {
extern const SurfaceKernelTable kSurfaceKernels;
}
namespace avx512 {
extern const SurfaceKernelTable kSurfaceKernels;
}

namespace {

VolumeRows rows_of(const VolumeJob& job) {
  return {.first_ring = job.rings->first.data(),
          .rings = job.rings->rows.front().data(),
          .vertex_count = job.vertex_count,
          .points = job.points.data(),
          .gradient = job.gradient.data(),
          .rest = job.rest,
          .compliance = job.compliance};
}

PointRows rows_of(const PredictJob& job) {
  return {.carry = job.carry.empty() ? nullptr : job.carry.data(),
          .moved = job.moved.data(),
          .moved_count = job.moved.size(),
          .vertex_count = job.vertex_count,
          .rest = nullptr,
          .points = job.points.data(),
          .before = job.before.data(),
          .velocity = job.velocity.data(),
          .h = job.h,
          .keep = job.keep,
          .anchors = job.pull > 0.0f ? job.anchors.data() : nullptr,
          .pull = job.pull};
}

bool has_rings(const VolumeJob& job) { return job.rings != nullptr && !job.rings->rows.empty(); }

// The jobs' spans become the pointers that the tables take.
template <const SurfaceKernelTable& kTable>
struct Wrapped {
  static void project_hinges(const HingeJob& job) {
    kTable.project_hinges({job.packs.data(), job.packs.size(), job.points.data(), job.inverse_h2});
  }
  static double project_volume(const VolumeJob& job) {
    return has_rings(job) ? kTable.project_volume(rows_of(job)) : surface_reference_kernels().project_volume(job);
  }
  static double measure_volume(const VolumeJob& job) {
    return has_rings(job) ? kTable.measure_volume(rows_of(job)) : surface_reference_kernels().measure_volume(job);
  }
  static void carry(const CarryJob& job) {
    PointRows rows;
    rows.carry = job.carry.empty() ? nullptr : job.carry.data();
    rows.moved = job.moved.data();
    rows.moved_count = job.moved.size();
    rows.vertex_count = job.vertex_count;
    rows.rest = job.rest.data();
    rows.points = job.out.data();
    kTable.carry(rows);
  }
  static void predict(const PredictJob& job) { kTable.predict(rows_of(job)); }
  static void take_velocities(const PredictJob& job) { kTable.take_velocities(rows_of(job)); }
  static void measure_hinges(std::span<const HingePack> packs, std::span<const SurfacePoint> points,
                             std::span<float> lengths, std::span<float> angles) {
    kTable.measure_hinges({packs.data(), packs.size(), points.data(), lengths.data(), angles.data()});
  }
  static void fade_differences(const ViscosityJob& job) {
    kTable.fade_differences({job.packs.data(), job.packs.size(), job.points.data(), job.velocity.data(), job.share});
  }
  static constexpr SurfaceKernels kKernels{project_hinges,  project_volume, measure_volume,  carry,
                                           predict,         take_velocities, measure_hinges, fade_differences};
};

}  // namespace

const SurfaceKernels& surface_kernels(SimdLevel level) {
  const SimdLevel best = detect_simd();
  switch (level < best ? level : best) {
    case SimdLevel::kAvx512: return Wrapped<avx512::kSurfaceKernels>::kKernels;
    case SimdLevel::kAvx2: return Wrapped<avx2::kSurfaceKernels>::kKernels;
    case SimdLevel::kPortable: break;
  }
  return Wrapped<portable::kSurfaceKernels>::kKernels;
}

}  // namespace fascicle::muscle
