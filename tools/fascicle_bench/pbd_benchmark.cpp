// Surface muscles (4.1 to 4.3), by the scenes' own content:
//
//   pbd_constraints/gluteus/LEVEL   one pass over edges and dihedral angles, each counted as a constraint, in the
//                                   scene's fullest flexion
//   pbd_step/SCENE/LEVEL            whole steps through the scene, mean and median of its frames: prediction, all
//                                   constraints, bones; what `fascicle-cook surface SCENE` gives the quality of
//   pbd_step_3/gluteus/LEVEL        the paper's amount of work: 3 substeps, against the femur and a copy far away
//   pbd_step/gluteus/N/THREADS      N muscles side by side through the flexion, by the clock and by processor time
//   pbd_size/VERTICES/LEVEL         constraints, volume, prediction and velocities of a sphere, once
//
// `_reference` is the plain scalar code of the same equations, compiled with the same flags. M_constraints counts
// millions a second; GFMA and L2_GB are what the machine can do at most, by the same clock: a hinge (two constraints)
// is about 110 multiplications, 90 additions, 4 quotients and a root, none of them fused, and moves 160 bytes in and
// out of a core. A label quotes the configuration. Only the spheres go without the real data.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/ecs/monotonic_clock.hpp"
#include "engine/parallel/for_range.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/asset/surface/describe_settings.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "modules/muscle/content/scene_asset.hpp"
#include "modules/muscle/kernels/surface/step_surface.hpp"
#include "modules/muscle/kernels/surface/surface_reference.hpp"
#include "tools/fascicle_bench/machine_rates.hpp"

namespace {

using namespace fascicle;
using namespace fascicle::muscle;

// How all that a scene's muscle depends on moves, frame by frame, and where that takes it.
struct Recording {
  struct Frame {
    std::vector<RigidMotion> attachments, carriers, bones;
  };
  std::shared_ptr<const SceneAsset> scene;  // keeps the fields; null: not to be had
  std::shared_ptr<const SurfaceAsset> asset;
  SurfaceSettings settings;
  float step = 0.0f;
  std::vector<const BoneField*> fields;
  std::vector<glm::mat4> rest_to_bone;
  std::vector<Frame> frames;
  AlignedVector<SurfacePoint> start, flexed, end;  // before the first frame, after the hundredth, after the last
};

// Played once by the game's own simulation.
const Recording& find_recording(const std::string& name) {
  static std::map<std::string, Recording> recordings;
  const auto [found, added] = recordings.try_emplace(name);
  Recording& recording = found->second;
  if (!added) return recording;
  const auto scene = load_scene(find_scene(name, find_content_folder()));
  if (!scene) return recording;
  game::Simulation simulation(*scene, {.workers = 1, .skin_meshes = false});
  const auto first = [&](auto&& use) {
    bool done = false;
    simulation.world().view<const SurfaceMuscle, const SurfaceState>().each(
        [&](const SurfaceMuscle& muscle, const SurfaceState& state) {
          if (!done) use(muscle, state);
          done = true;
        });
    return done;
  };
  const bool has_muscle = first([&](const SurfaceMuscle& muscle, const SurfaceState& state) {
    recording.asset = muscle.asset;
    recording.settings = muscle.settings;
    recording.fields = state.fields;
    recording.rest_to_bone = state.rest_to_bone;
    recording.start = state.points;
  });
  if (!has_muscle) return recording;
  for (int i = 0; i < (*scene)->frames; ++i) {
    simulation.step();
    first([&](const SurfaceMuscle&, const SurfaceState& state) {
      recording.frames.push_back({state.attachment_motion, state.carrier_motion, state.bone_motion});
      if (i == 99) recording.flexed = state.points;
      recording.end = state.points;
    });
  }
  recording.step = 1.0f / (*scene)->step_hz;
  recording.scene = *scene;
  return recording;
}

// The paper's amount of work: 3 substeps, and a copy of the bone, which moves as it does a metre away.
Recording as_the_paper(const Recording& recording) {
  Recording paper = recording;
  auto asset = std::make_shared<SurfaceAsset>(*recording.asset);
  const glm::mat4 away = glm::translate(glm::mat4(1.0f), {1.0f, 0.0f, 0.0f});
  paper.settings.substeps = 3;
  if (asset->bones.size() == 1) {
    asset->bones.push_back(asset->bones.front());
    paper.fields.push_back(paper.fields.front());
    paper.rest_to_bone.push_back(paper.rest_to_bone.front());
    for (Recording::Frame& frame : paper.frames) {
      frame.bones.push_back({away * frame.bones.front().from, away * frame.bones.front().to});
    }
  }
  paper.asset = asset;
  return paper;
}

// One muscle that plays a recording by itself.
class Player {
 public:
  Player(const Recording& recording, const SurfaceKernels& kernels) : recording_(&recording), kernels_(&kernels) {
    lay_out(*recording.asset, scratch_);
    velocity_.resize(recording.start.size());
    restart();
  }

  void restart() {
    points_ = recording_->start;
    std::fill(velocity_.begin(), velocity_.end(), SurfacePoint{});
    carry_rest_shape(step_of(0), scratch_);
  }

  void step(std::size_t frame) { benchmark::DoNotOptimize(step_surface(step_of(frame), scratch_)); }

  const AlignedVector<SurfacePoint>& points() const { return points_; }

 private:
  SurfaceStep step_of(std::size_t frame) {
    const Recording::Frame& at = recording_->frames[frame];
    return {.asset = recording_->asset.get(), .kernels = kernels_, .settings = recording_->settings,
            .step = recording_->step, .attachments = at.attachments, .carriers = at.carriers, .bones = at.bones,
            .fields = recording_->fields, .rest_to_bone = recording_->rest_to_bone, .points = points_,
            .velocity = velocity_};
  }

  const Recording* recording_;
  const SurfaceKernels* kernels_;
  SurfaceScratch scratch_;
  AlignedVector<SurfacePoint> points_, velocity_;
};

const SurfaceKernels& kernels_of(SimdLevel level, bool reference) {
  return reference ? surface_reference_kernels() : surface_kernels(level);
}

void quote(benchmark::State& state, const SurfaceSettings& settings, SimdLevel level, const std::string& more = "") {
  state.counters["GFMA"] = 1.0e-9 * bench::multiply_adds_per_second(level);
  state.counters["L2_GB"] = 1.0e-9 * bench::second_level_bandwidth();
  state.SetLabel(to_text(settings) + more);
}

void count_constraints(benchmark::State& state, std::size_t hinges) {
  state.counters["M_constraints"] = benchmark::Counter(
      2.0e-6 * static_cast<double>(hinges) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

std::size_t count_hinges(const SurfaceAsset& asset) {
  std::size_t count = 0;
  for (const HingePack& pack : asset.packs) {
    for (const std::int32_t v : pack.vertex[0]) count += static_cast<std::uint32_t>(v) < asset.vertex_count ? 1 : 0;
  }
  return count;
}

void constraints(benchmark::State& state, SimdLevel level, bool reference) {
  const Recording& recording = find_recording("hip-gluteus");
  if (!recording.scene) return state.SkipWithError("the scene or the real data is not there");
  const float h = recording.step / static_cast<float>(recording.settings.substeps);
  AlignedVector<SurfacePoint> points = recording.flexed;
  const HingeJob job{.packs = recording.asset->packs, .points = points, .inverse_h2 = 1.0f / (h * h)};
  const SurfaceKernels& kernels = kernels_of(level, reference);
  for (auto _ : state) {
    kernels.project_hinges(job);
    benchmark::ClobberMemory();
  }
  count_constraints(state, count_hinges(*recording.asset));
  quote(state, recording.settings, level);
}

void whole_steps(benchmark::State& state, const std::string& scene, bool paper, SimdLevel level, bool reference) {
  const Recording& found = find_recording(scene);
  if (!found.scene) return state.SkipWithError("the scene or the real data is not there");
  const Recording recording = paper ? as_the_paper(found) : found;
  Player player(recording, kernels_of(level, reference));
  std::vector<double> times;  // ms
  std::size_t frame = 0;
  for (auto _ : state) {
    if (frame == recording.frames.size()) {
      player.restart();
      frame = 0;
    }
    const std::clock_t start = std::clock();
    player.step(frame++);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    state.SetIterationTime(seconds);
    times.push_back(1.0e3 * seconds);
  }
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  state.counters["ms_median"] = *middle;
  const bool same = frame == recording.frames.size() && player.points().size() == found.end.size() &&
                    std::equal(found.end.begin(), found.end.end(), player.points().begin(),
                               [](const SurfacePoint& a, const SurfacePoint& b) {
                                 return a.x == b.x && a.y == b.y && a.z == b.z;
                               });
  quote(state, recording.settings, level, same ? ", ends where the scene does" : "");
}

void crowd(benchmark::State& state, std::size_t count, int threads) {
  const Recording& recording = find_recording("hip-gluteus");
  if (!recording.scene) return state.SkipWithError("the scene or the real data is not there");
  const SimdLevel level = detect_simd();
  std::vector<Player> players(count, Player(recording, surface_kernels(level)));
  parallel::WorkerArena arena(threads);
  std::size_t frame = 0;
  std::int64_t all = 0;
  const std::clock_t clock = std::clock();  // of all threads
  for (auto _ : state) {
    const std::int64_t start = monotonic_ns();
    arena.execute([&] {
      parallel::for_range(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) players[i].step(frame);
      });
    });
    const std::int64_t took = monotonic_ns() - start;
    all += took;
    state.SetIterationTime(1.0e-9 * static_cast<double>(took));
    ++frame;
  }
  const double processor = 1.0e3 * static_cast<double>(std::clock() - clock) / CLOCKS_PER_SEC;
  state.counters["ms_a_muscle"] = 1.0e-6 * static_cast<double>(all) / static_cast<double>(frame * count);
  state.counters["cpu_ms_a_muscle"] = processor / static_cast<double>(frame * count);
  quote(state, recording.settings, level);
}

// An octahedron whose faces are cut into n^2 triangles, blown up to a sphere: 4 n^2 + 2 vertices of at most six edges.
TriangleMesh make_even_sphere(float radius, int n) {
  TriangleMesh mesh;
  std::vector<std::array<std::int32_t, 2>> vertex_at(static_cast<std::size_t>((2 * n + 1) * (2 * n + 1)), {-1, -1});
  const auto vertex = [&](int x, int y, int side) {
    const int z = n - std::abs(x) - std::abs(y);
    auto& known = vertex_at[static_cast<std::size_t>((x + n) * (2 * n + 1) + y + n)][z == 0 ? 0 : side > 0 ? 0 : 1];
    if (known < 0) {
      known = static_cast<std::int32_t>(mesh.positions.size());
      mesh.positions.push_back(radius * glm::normalize(glm::vec3(glm::ivec3(x, y, side * z))));
    }
    return static_cast<std::uint32_t>(known);
  };
  for (const int sx : {1, -1}) {
    for (const int sy : {1, -1}) {
      for (const int sz : {1, -1}) {
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
          if (sx * sy * sz < 0) std::swap(b, c);
          mesh.indices.insert(mesh.indices.end(), {a, b, c});
        };
        for (int x = 0; x < n; ++x) {
          for (int y = 0; x + y < n; ++y) {
            const auto at = [&](int i, int j) { return vertex(sx * i, sy * j, sz); };
            add(at(x, y), at(x + 1, y), at(x, y + 1));
            if (x + y + 1 < n) add(at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
          }
        }
      }
    }
  }
  return mesh;
}

void size_of_mesh(benchmark::State& state, int n, SimdLevel level, bool reference) {
  SurfaceMuscleDescription description;
  description.name = "sphere";
  description.mesh = make_even_sphere(0.1f, n);
  const auto built = build_surface_asset(description, 1);
  if (!built) return state.SkipWithError("the sphere is no muscle");
  const SurfaceAsset& asset = **built;
  const SurfaceKernels& kernels = kernels_of(level, reference);
  AlignedVector<SurfacePoint> points = asset.rest, before = points, velocity(points.size()), gradient(points.size());
  const float h = 1.0f / 300.0f;
  for (std::size_t v = 0; v < asset.vertex_count; ++v) velocity[v].x = v % 2 == 0 ? 1.0e-3f : -1.0e-3f;
  const PredictJob prediction{.carry = {}, .moved = {}, .vertex_count = asset.vertex_count, .points = points,
                              .before = before, .velocity = velocity, .h = h, .anchors = {}};
  const VolumeJob volume{.triangles = asset.triangles, .vertex_count = asset.vertex_count, .points = points,
                         .gradient = gradient, .rest = asset.kernel_volume, .rings = &asset.rings};
  for (auto _ : state) {
    kernels.predict(prediction);
    kernels.project_hinges({.packs = asset.packs, .points = points, .inverse_h2 = 1.0f / (h * h)});
    kernels.project_volume(volume);
    kernels.take_velocities(prediction);
    benchmark::ClobberMemory();
  }
  count_constraints(state, count_hinges(asset));
  state.counters["vertices"] = asset.vertex_count;
  quote(state, asset.settings, level);
}

void add_all() {
  const SimdLevel best = detect_simd();
  const auto on_levels = [&](const std::string& title, const std::string& what, auto&& add) {
    for (const bool reference : {false, true}) {
      for (const SimdLevel level : {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
        if (level > best || (reference && level != SimdLevel::kPortable)) continue;  // the plain code has one
        const std::string name = title + what + (reference ? "_reference" : "/" + std::string(to_string(level)));
        add(name.c_str(), reference ? best : level, reference);
      }
    }
  };
  on_levels("pbd_constraints", "/gluteus", [](const char* name, SimdLevel level, bool reference) {
    benchmark::RegisterBenchmark(name, constraints, level, reference)->Unit(benchmark::kMicrosecond);
  });
  const auto add_steps = [&](const std::string& title, const char* what, const std::string& scene, bool paper) {
    on_levels(title, what, [&](const char* name, SimdLevel level, bool reference) {
      benchmark::RegisterBenchmark(name, whole_steps, scene, paper, level, reference)
          ->UseManualTime()->Iterations(reference ? 300 : 600)->Unit(benchmark::kMillisecond);
    });
  };
  add_steps("pbd_step", "/gluteus", "hip-gluteus", false);
  add_steps("pbd_step", "/iliacus", "hip-iliacus", false);
  add_steps("pbd_step", "/box", "box", false);
  add_steps("pbd_step_3", "/gluteus", "hip-gluteus", true);
  for (const int threads : {1, 2}) {
    for (const std::size_t count : {1, 2, 4, 8, 16, 32}) {
      const std::string name = "pbd_step/gluteus/" + std::to_string(count) + "/" + std::to_string(threads);
      benchmark::RegisterBenchmark(name.c_str(), crowd, count, threads)
          ->UseManualTime()->Iterations(100)->Unit(benchmark::kMillisecond);
    }
  }
  for (const int n : {16, 50, 158, 500}) {
    on_levels("pbd_size", "/" + std::to_string(4 * n * n + 2), [&](const char* name, SimdLevel level, bool reference) {
      benchmark::RegisterBenchmark(name, size_of_mesh, n, level, reference)->Unit(benchmark::kMicrosecond);
    });
  }
}

[[maybe_unused]] const bool kRegistered = (add_all(), true);

}  // namespace
