// Surface muscles by their coarse hull (4.5), in the poses of the scene hip-hull: the femur anywhere in a radian of
// flexion, in no order.
//
//   progressive_hull/MUSCLE/VERTICES        the hull from the mesh, once at load, or when content is cooked
//   mean_value_coordinates/MUSCLE/VERTICES  all of the mesh's vertices by the hull's, once at load, one thread
//   coarse_hull/MUSCLE/VERTICES/LEVEL       a pose, one thread, without iterations on the full mesh
//   coarse_hull_refined/MUSCLE/...          a pose with the iterations on the full mesh that content asks for
//   full_mesh_reference/MUSCLE              some of these poses solved on the full mesh throughout (pose_reference.hpp)
//
// All are timed by the processor time of one thread. Of the poses, `iterations` is the mean and `converged` the part
// that came within the tolerance, `volume_error` the worst, and ms_worst the slowest. In the reference's poses, speedup
// is its time by theirs, energy theirs of the shape by its own, and mm_off and mm_off_worst are how far vertices are from its places, in the mean and at most
// (bones are met in another way there, too). M_weights counts millions a second; GFMA, L2_GB and L3_GB are what the
// machine can do at most, by the same clock (machine_rates.hpp): each product with the whole matrix of weights reads
// vertices x hull vertices x 4 bytes.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "engine/parallel/worker_arena.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/asset/hull/mean_value_coordinates.hpp"
#include "modules/muscle/asset/hull/pose_reference.hpp"
#include "modules/muscle/asset/hull/progressive_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "modules/muscle/content/scene_asset.hpp"
#include "modules/muscle/kernels/hull/pose_surface.hpp"
#include "tools/fascicle_bench/machine_rates.hpp"

namespace {

using namespace fascicle;
using namespace fascicle::muscle;

constexpr std::size_t kReferencePoses = 6;
constexpr const char* kNoData = "the scene or the real data is not there";

// A muscle, and where everything that it depends on is in the poses of the scene, in the scene's order.
struct PosedMuscle {
  struct Pose {
    std::vector<RigidMotion> attachments, carriers, bones;
    std::vector<glm::mat4> all_bones;  // rest space -> simulation's frame
  };
  std::shared_ptr<const SceneAsset> scene;  // keeps the fields; null: not to be had
  const SurfaceMuscleDescription* description = nullptr;
  std::shared_ptr<const SurfaceAsset> asset;
  SurfaceSettings settings;
  std::vector<const BoneField*> fields;
  std::vector<glm::mat4> rest_to_bone;
  AlignedVector<SurfacePoint> points;
  std::vector<Pose> poses;
};

PosedMuscle find_poses(const std::string& name) {
  const auto scene = load_scene(find_scene("hip-hull", find_content_folder()), {.hulls = HullMode::kNone});
  if (!scene || (*scene)->characters.empty()) return {};
  PosedMuscle found;
  game::Simulation simulation(*scene, {.workers = 1, .skin_meshes = false});
  const game::SpawnedCharacter& character = simulation.characters().front();
  const auto& descriptions = character.asset->surface_descriptions;
  for (std::size_t i = 0; i < character.surfaces.size(); ++i) {
    simulation.world().get<SurfaceState>(character.surfaces[i]).enabled = false;  // carried only: bones are what counts
    if (descriptions[i].name == name) found.description = &descriptions[i];
  }
  if (found.description == nullptr) return {};
  const ecs::Entity entity = character.surfaces[static_cast<std::size_t>(found.description - descriptions.data())];
  std::vector<glm::mat4> last;
  for (int i = 0; i < (*scene)->frames; ++i) {
    simulation.step();
    const SurfaceState& state = simulation.world().get<const SurfaceState>(entity);
    if (state.bones != last) {
      found.poses.push_back({state.attachment_motion, state.carrier_motion, state.bone_motion, state.bones});
    }
    last = state.bones;
  }
  const SurfaceMuscle& muscle = simulation.world().get<const SurfaceMuscle>(entity);
  const SurfaceState& state = simulation.world().get<const SurfaceState>(entity);
  found.asset = muscle.asset;
  found.settings = muscle.settings;
  found.fields = state.fields;
  found.rest_to_bone = state.rest_to_bone;
  found.points = state.points;
  found.scene = *scene;
  return found;
}

const PosedMuscle& posed_muscle(const std::string& name) {
  static std::map<std::string, PosedMuscle> muscles;
  const auto [found, added] = muscles.try_emplace(name);
  if (added) found->second = find_poses(name);
  return found->second;
}

// Empty where it can't be made.
const TriangleMesh& hull_of(const std::string& name, std::uint32_t vertices) {
  static std::map<std::tuple<std::string, std::uint32_t>, TriangleMesh> hulls;
  const auto [found, added] = hulls.try_emplace({name, vertices});
  if (added) {
    auto hull = build_progressive_hull(posed_muscle(name).description->mesh, {.vertices = vertices});
    if (hull) found->second = std::move(hull->mesh);
  }
  return found->second;
}

std::shared_ptr<const HullAsset> hull_asset(const std::string& name, std::uint32_t vertices) {
  static std::map<std::tuple<std::string, std::uint32_t>, std::shared_ptr<const HullAsset>> assets;
  const auto [found, added] = assets.try_emplace({name, vertices});
  if (added) {
    const PosedMuscle& muscle = posed_muscle(name);
    SurfaceMuscleDescription description = *muscle.description;
    description.hull.vertices = vertices;
    const auto built = build_hull_asset(*muscle.asset, description, hull_of(name, vertices),
                                        muscle.scene->characters.front().character->muscles.get());
    if (built) found->second = *built;
  }
  return found->second;
}

// One muscle that takes pose after pose by itself.
class Poser {
 public:
  Poser(const PosedMuscle& muscle, const HullAsset& hull, SimdLevel level)
      : muscle_(&muscle), hull_(&hull), level_(level), points_(muscle.points), velocity_(points_.size()),
        line_(hull.line.size()) {
    lay_out(*muscle.asset, hull, scratch_);
  }

  HullPose pose(std::size_t index, std::uint32_t refinements) {
    HullSettings settings = hull_->settings;
    settings.refinements = refinements;
    return pose_surface(step_of(index), *hull_, hull_kernels(level_), settings, line_, scratch_);
  }
  HullPose pose(std::size_t index, const PoseReference& reference) {
    return reference.pose(step_of(index), hull_->settings, line_);
  }

  const AlignedVector<SurfacePoint>& points() const { return points_; }

 private:
  SurfaceStep step_of(std::size_t index) {
    const PosedMuscle::Pose& at = muscle_->poses[index];
    for (std::size_t i = 0; i < line_.size(); ++i) {
      const HullLinePoint& point = hull_->line[i];
      const glm::mat4& carried = point.bone >= 0 ? at.all_bones[static_cast<std::size_t>(point.bone)]
                                                 : at.carriers[point.carrier].to;
      line_[i] = glm::vec3(carried * glm::vec4(point.rest, 1.0f));
    }
    return {.asset = muscle_->asset.get(), .kernels = &surface_kernels(level_), .settings = muscle_->settings,
            .step = 1.0f / muscle_->scene->step_hz, .attachments = at.attachments, .carriers = at.carriers,
            .bones = at.bones, .fields = muscle_->fields, .rest_to_bone = muscle_->rest_to_bone, .points = points_,
            .velocity = velocity_};
  }

  const PosedMuscle* muscle_;
  const HullAsset* hull_;
  SimdLevel level_;
  HullScratch scratch_;
  AlignedVector<SurfacePoint> points_, velocity_;
  std::vector<glm::vec3> line_;
};

// Some poses by the reference, timed and kept.
struct Reference {
  struct Pose {
    std::size_t index = 0;
    double ms = 0.0;
    HullPose pose;
    AlignedVector<SurfacePoint> points;
    double energy = 0.0;  // m^2
  };
  std::shared_ptr<const HullAsset> hull;
  std::shared_ptr<const PoseReference> solver;
  std::vector<Pose> poses;
};

const Reference& reference_of(const std::string& name) {
  static std::map<std::string, Reference> references;
  const auto [found, added] = references.try_emplace(name);
  const PosedMuscle& muscle = posed_muscle(name);
  const auto hull = hull_asset(name, 300);  // its settings and its line count
  if (!added || !hull) return found->second;
  found->second.hull = hull;
  found->second.solver = std::make_shared<const PoseReference>(*muscle.asset, *hull);
  const PoseReference& reference = *found->second.solver;
  Poser poser(muscle, *hull, detect_simd());
  for (std::size_t i = 0; i < kReferencePoses; ++i) {
    const std::size_t index = i * (muscle.poses.size() / kReferencePoses);
    const std::clock_t start = std::clock();
    const HullPose pose = poser.pose(index, reference);
    const double ms = 1.0e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    found->second.poses.push_back({index, ms, pose, poser.points(), reference.energy(poser.points())});
  }
  return found->second;
}

void full_mesh(benchmark::State& state, const std::string& name) {
  if (!posed_muscle(name).scene) return state.SkipWithError(kNoData);
  const Reference& reference = reference_of(name);
  if (reference.poses.empty()) return state.SkipWithError("no hull could be made");
  double iterations = 0.0, converged = 0.0, volume_error = 0.0;
  std::size_t i = 0;
  for (auto _ : state) {  // solved once, whoever asks first
    const Reference::Pose& pose = reference.poses[i++ % reference.poses.size()];
    state.SetIterationTime(1.0e-3 * pose.ms);
    iterations += pose.pose.iterations;
    converged += pose.pose.converged ? 1.0 : 0.0;
    volume_error = std::max(volume_error, std::abs(pose.pose.volume / posed_muscle(name).asset->volume - 1.0));
  }
  state.counters["poses"] = benchmark::Counter(static_cast<double>(i), benchmark::Counter::kIsRate);
  state.counters["iterations"] = iterations / static_cast<double>(i);
  state.counters["converged"] = converged / static_cast<double>(i);
  state.counters["volume_error"] = volume_error;
}

// How much faster than the reference `poser` takes its poses, and how far from its places it ends.
void compare(benchmark::State& state, const Reference& reference, Poser& poser, std::uint32_t refinements,
             std::uint32_t vertices) {
  double ms = 0.0, reference_ms = 0.0, worst = 0.0, sum = 0.0, energy = 0.0, reference_energy = 0.0;
  std::size_t count = 0;
  for (const Reference::Pose& wanted : reference.poses) {
    const std::clock_t start = std::clock();
    poser.pose(wanted.index, refinements);
    ms += 1.0e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    reference_ms += wanted.ms;
    energy += reference.solver->energy(poser.points());
    reference_energy += wanted.energy;
    for (std::size_t v = 0; v < vertices; ++v) {
      const SurfacePoint &a = poser.points()[v], &b = wanted.points[v];
      const double off = 1.0e3 * std::hypot(static_cast<double>(a.x) - static_cast<double>(b.x),
                                            static_cast<double>(a.y) - static_cast<double>(b.y),
                                            static_cast<double>(a.z) - static_cast<double>(b.z));
      worst = std::max(worst, off);
      sum += off;
      ++count;
    }
  }
  state.counters["speedup"] = reference_ms / ms;
  state.counters["energy"] = energy / reference_energy;
  state.counters["mm_off"] = sum / static_cast<double>(count);
  state.counters["mm_off_worst"] = worst;
}

void progressive_hull(benchmark::State& state, const std::string& name, std::uint32_t vertices) {
  const PosedMuscle& muscle = posed_muscle(name);
  if (!muscle.scene) return state.SkipWithError(kNoData);
  std::size_t got = 0;
  double overhead = 0.0;
  for (auto _ : state) {
    const std::clock_t start = std::clock();
    const auto hull = build_progressive_hull(muscle.description->mesh, {.vertices = vertices});
    state.SetIterationTime(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    if (!hull) return state.SkipWithError("no hull could be made");
    got = hull->mesh.positions.size();
    overhead = hull->overhead();
  }
  state.counters["vertices"] = static_cast<double>(got);
  state.counters["overhead"] = overhead;
}

void coordinates(benchmark::State& state, const std::string& name, std::uint32_t vertices) {
  const PosedMuscle& muscle = posed_muscle(name);
  if (!muscle.scene) return state.SkipWithError(kNoData);
  const TriangleMesh& hull = hull_of(name, vertices);
  const std::vector<glm::vec3>& points = muscle.description->mesh.positions;
  std::vector<float> weights(points.size() * hull.positions.size());
  if (weights.empty()) return state.SkipWithError("no hull could be made");
  parallel::WorkerArena arena(1);
  for (auto _ : state) {
    const std::clock_t start = std::clock();
    arena.execute([&] { find_mean_value_coordinates(hull, points, weights); });
    state.SetIterationTime(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  const double millions = 1.0e-6 * static_cast<double>(weights.size());
  state.counters["M_weights"] =
      benchmark::Counter(millions * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void poses(benchmark::State& state, const std::string& name, std::uint32_t vertices, bool refined, SimdLevel level) {
  const PosedMuscle& muscle = posed_muscle(name);
  if (!muscle.scene) return state.SkipWithError(kNoData);
  const auto hull = hull_asset(name, vertices);
  if (!hull) return state.SkipWithError("no hull could be made");
  Poser poser(muscle, *hull, level);
  const std::uint32_t refinements = refined ? hull->settings.refinements : 0;
  for (std::size_t i = 0; i < 3; ++i) poser.pose(i % muscle.poses.size(), refinements);
  parallel::WorkerArena arena(1);
  std::vector<double> times;  // ms
  double iterations = 0.0, converged = 0.0, volume_error = 0.0;
  arena.execute([&] {
    for (auto _ : state) {
      const std::clock_t start = std::clock();
      const HullPose pose = poser.pose(times.size() % muscle.poses.size(), refinements);
      const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      state.SetIterationTime(seconds);
      times.push_back(1.0e3 * seconds);
      iterations += pose.iterations;
      converged += pose.converged ? 1.0 : 0.0;
      volume_error = std::max(volume_error, std::abs(pose.volume / muscle.asset->volume - 1.0));
    }
  });
  compare(state, reference_of(name), poser, refinements, muscle.asset->vertex_count);
  state.counters["ms_worst"] = *std::max_element(times.begin(), times.end());
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  const double count = static_cast<double>(times.size());
  state.counters["ms_median"] = *middle;
  state.counters["poses"] = benchmark::Counter(count, benchmark::Counter::kIsRate);
  state.counters["iterations"] = iterations / count;
  state.counters["converged"] = converged / count;
  state.counters["volume_error"] = volume_error;
  state.counters["GFMA"] = 1.0e-9 * bench::multiply_adds_per_second(level);
  state.counters["L2_GB"] = 1.0e-9 * bench::second_level_bandwidth();
  state.counters["L3_GB"] = 1.0e-9 * bench::third_level_bandwidth();
}

void add_all() {
  const auto label = [](const std::string& muscle) { return muscle == "gluteus_maximus" ? "gluteus" : muscle; };
  for (const std::string muscle : {"gluteus_maximus", "iliacus"}) {
    const std::string at = "/" + std::string(label(muscle)) + "/";
    for (const std::uint32_t vertices : {500u, 300u, 100u}) {
      benchmark::RegisterBenchmark(("progressive_hull" + at + std::to_string(vertices)).c_str(), progressive_hull,
                                   muscle, vertices)->UseManualTime()->Unit(benchmark::kMillisecond);
      benchmark::RegisterBenchmark(("mean_value_coordinates" + at + std::to_string(vertices)).c_str(), coordinates,
                                   muscle, vertices)->UseManualTime()->Unit(benchmark::kMillisecond);
    }
    benchmark::RegisterBenchmark(("full_mesh_reference/" + std::string(label(muscle))).c_str(), full_mesh, muscle)
        ->UseManualTime()->Iterations(kReferencePoses)->Unit(benchmark::kMillisecond);
    const auto add = [&](bool refined, std::uint32_t vertices, SimdLevel level) {
      const std::string name = (refined ? "coarse_hull_refined" : "coarse_hull") + at + std::to_string(vertices) + "/" +
                               std::string(to_string(level));
      benchmark::RegisterBenchmark(name.c_str(), poses, muscle, vertices, refined, level)
          ->UseManualTime()->Iterations(300)->Unit(benchmark::kMillisecond);
    };
    for (const bool refined : {false, true}) {
      for (const SimdLevel level : {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
        if (level <= detect_simd()) add(refined, 300, level);
      }
      for (const std::uint32_t vertices : {100u, 200u, 500u}) add(refined, vertices, detect_simd());
    }
  }
}

[[maybe_unused]] const bool kRegistered = (add_all(), true);

}  // namespace
