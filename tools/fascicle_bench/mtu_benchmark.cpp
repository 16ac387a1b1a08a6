// The musculotendon unit, action lines to positions and normals, on one thread: what `mtu_frame` does a frame is place
// the points by their bones, build the frames, find the tendons and write the surfaces, for
//
//   48x36         one set of 48 muscles, |C| = 36, LSS 1, in the cache
//   1000_walkers  1,000 sets of 48 muscles, |C| = 8, LSS 1, far larger than the caches
//
// `_reference` is the plain scalar code of the same equations, compiled with the same flags. Each runs per instruction
// set: /portable, /avx2, /avx512; those that the processor lacks are left out. ns_per_vertex counts table 3's vertices;
// bandwidth_share is the bytes of surface written per second as a part of the machine's, measured in the same run.
#include <benchmark/benchmark.h>

#include <cstring>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "engine/ecs/monotonic_clock.hpp"
#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/components/lay_out_state.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/kernels/mtu_kernels.hpp"
#include "modules/muscle/systems/kernel_jobs.hpp"
#include "tests/support/synthetic_muscles.hpp"

namespace {

using namespace fascicle;
using namespace fascicle::muscle;

constexpr std::size_t kPoses = 16;
constexpr std::size_t kBandwidthBytes = std::size_t{256} << 20;

// The state of one musculature, as its components hold it.
struct Walker {
  Musculature musculature;
  ActionLines lines;
  CrossSections sections;
  Tendons tendons;
  MuscleSurfaces surfaces;

  explicit Walker(std::shared_ptr<const MuscleAsset> asset) {
    musculature.attached.assign(asset->size(), 1);
    lay_out(*asset, lines);
    lay_out(*asset, sections);
    lay_out(*asset, tendons);
    lay_out(*asset, surfaces);
    musculature.asset = std::move(asset);
  }

  void step(const MtuKernels& kernels, const BoneMatrices& bones, bool stream) {
    kernels.place_points(place_points_job(musculature, bones, lines));
    kernels.build_frames(build_frames_job(musculature, bones, lines, false, sections));
    kernels.find_tendons(find_tendons_job(*musculature.asset, sections, tendons));
    kernels.write_surfaces(write_surfaces_job(sections_view(musculature, lines, sections, tendons), stream, surfaces));
  }
};

std::shared_ptr<const MuscleAsset> make_asset(std::uint32_t section_vertices) {
  auto built = build_muscle_asset(test::synthetic_muscles(section_vertices, 1), test::rest_bones());
  return built.ok() ? *built : nullptr;
}

std::vector<BoneMatrices> make_poses() {
  std::vector<BoneMatrices> poses(kPoses);
  for (std::size_t i = 0; i < kPoses; ++i) poses[i].world = test::walk_bones(static_cast<float>(i) / kPoses);
  return poses;
}

// Bytes per second that one thread writes past the caches, measured once.
double write_bandwidth() {
  static const double result = [] {
    AlignedVector<char> to(kBandwidthBytes, 1);
    double best = 0.0;
    for (int round = 0; round < 4; ++round) {
      const std::int64_t start = fascicle::monotonic_ns();
      std::memset(to.data(), round, to.size());
      benchmark::DoNotOptimize(to.data());
      benchmark::ClobberMemory();
      best = std::max(best, static_cast<double>(to.size()) / static_cast<double>(fascicle::monotonic_ns() - start));
    }
    return best * 1.0e9;
  }();
  return result;
}

void report(benchmark::State& state, const MuscleAsset& asset, std::size_t walkers, SimdLevel level,
            double seconds) {
  const double frames = static_cast<double>(state.iterations());
  const double vertices = static_cast<double>(count_muscles(asset).vertices) * static_cast<double>(walkers);
  const double bytes = static_cast<double>(asset.vertex_count) * sizeof(SurfaceVertex) * static_cast<double>(walkers);
  using benchmark::Counter;
  state.counters["vertices_per_second"] = Counter(vertices * frames, Counter::kIsRate);
  // Not one of the library's rates: those are printed as "2s" for two nanoseconds.
  state.counters["ns_per_vertex"] = Counter(1.0e9 * seconds / (vertices * frames));
  state.counters["bytes_per_vertex"] = Counter(bytes / vertices);
  state.counters["bandwidth_share"] = Counter(bytes * frames / (write_bandwidth() * seconds));
  state.SetLabel(std::string(to_string(level)));
}

void mtu_frame(benchmark::State& state, std::uint32_t section_vertices, std::size_t walker_count, SimdLevel level,
               bool reference) {
  const std::shared_ptr<const MuscleAsset> asset = make_asset(section_vertices);
  const std::vector<BoneMatrices> poses = make_poses();
  const MtuKernels& kernels = reference ? mtu_reference_kernels(level) : mtu_kernels(level);
  std::vector<Walker> walkers(walker_count, Walker(asset));
  const bool stream = sizeof(SurfaceVertex) * asset->vertex_count * walker_count > MuscleSettings{}.stream_bytes;
  std::size_t frame = 0;
  const std::clock_t start = std::clock();  // processor time: the library's own, which it does not tell
  for (auto _ : state) {
    for (std::size_t w = 0; w < walkers.size(); ++w) walkers[w].step(kernels, poses[(frame + w) % kPoses], stream);
    ++frame;
    benchmark::ClobberMemory();
  }
  report(state, *asset, walker_count, level, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
}

// What the machine can do: bytes copied (read and written) and written per second by one thread.
void memory_bandwidth(benchmark::State& state, bool copy) {
  AlignedVector<char> from(kBandwidthBytes / 2, 1), to(kBandwidthBytes / 2, 2);
  for (auto _ : state) {
    if (copy) std::memcpy(to.data(), from.data(), to.size());
    else std::memset(to.data(), 3, to.size());
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
  const auto moved = static_cast<std::int64_t>(to.size()) * (copy ? 2 : 1);
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * moved);
}

void add_frames(const char* size, std::uint32_t section_vertices, std::size_t walkers) {
  const SimdLevel best = detect_simd();
  for (const SimdLevel level : {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
    if (level > best) continue;
    for (const bool reference : {false, true}) {
      const std::string name = std::string("mtu_frame/") + size + (reference ? "_reference/" : "/") +
                               std::string(to_string(level));
      benchmark::RegisterBenchmark(name.c_str(), mtu_frame, section_vertices, walkers, level, reference)
          ->Unit(walkers > 1 ? benchmark::kMillisecond : benchmark::kMicrosecond);
    }
  }
}

const bool kRegistered = [] {
  add_frames("48x36", 36, 1);
  add_frames("1000_walkers", 8, 1000);
  benchmark::RegisterBenchmark("memory_bandwidth/copy", memory_bandwidth, true)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("memory_bandwidth/write", memory_bandwidth, false)->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
