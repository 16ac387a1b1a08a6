// Fitting, on one thread:
//
//   fit/walker             48 muscles of the default content, |C| = 36, LSS 1: trees built, both sweeps, reports
//   fit_rays/walker        lines through its meshes, in the planes of its sections
//   fit_rays/gluteus       the same through a mesh of 19,752 triangles (real data; skipped without)
//   fit_rays/triangles/N   through a bumpy ball of about N triangles: the cost grows with the logarithm
//
// each beside NAME_reference, the plain loop over all triangles, built with the same flags. A line answers four rays of
// the method (P and N of a vertex and of its opposite, see engine/geometry/ray_scene.hpp): ns_per_line is what a cast
// takes, ns_per_ray a quarter of it.
#include <algorithm>
#include <ctime>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <glm/geometric.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/content/mesh_reader.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/principal_axes.hpp"
#include "engine/geometry/ray_scene.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "modules/muscle/asset/fit/fit_muscles.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/find_content.hpp"

namespace {

using namespace fascicle;

constexpr std::uint32_t kRays = 108;  // a section: CSS 3 at |C| = 36

std::shared_ptr<const muscle::CharacterAsset> load_walker() {
  static const auto walker = [] {
    const auto loaded =
        muscle::load_character(muscle::find_content_folder() / "characters" / "walker" / "walker.character.json");
    return loaded ? *loaded : nullptr;
  }();
  return walker;
}

void fit_walker(benchmark::State& state, bool plain) {
  const auto walker = load_walker();
  if (walker == nullptr) return state.SkipWithError("the default content is not there");
  std::vector<muscle::MuscleDescription> descriptions = walker->descriptions;
  std::vector<muscle::FitInput> inputs;
  for (muscle::MuscleDescription& description : descriptions) {
    description.section_vertices = 36;
    description.longitudinal_subdivision = 1;
    const auto mesh = walker->muscle_meshes.find(description.name);
    if (mesh != walker->muscle_meshes.end()) inputs.push_back({&description, mesh->second.get(), {}});
  }
  const muscle::FitOptions options{.plain_rays = plain};
  parallel::WorkerArena one(1);
  one.execute([&] {
    for (auto _ : state) {
      benchmark::DoNotOptimize(muscle::fit_muscles(inputs, walker->skeleton->rest_world, options));
    }
  });
  state.counters["muscles"] = static_cast<double>(inputs.size());
}

// The lines of sections across a mesh's longest axis, as a fit casts them: fans in planes.
std::vector<Line> section_lines(const TriangleMesh& mesh, int sections) {
  const PrincipalAxes axes = principal_axes(mesh);
  std::vector<Line> lines;
  for (int k = 0; k < sections; ++k) {
    const double s = (k + 0.5) / sections;
    const glm::dvec3 centre =
        axes.centre + (axes.ranges[0].x + s * (axes.ranges[0].y - axes.ranges[0].x)) * axes.axes[0];
    for (std::uint32_t i = 0; i < kRays / 2; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kRays;
      lines.push_back({glm::vec3(centre), glm::vec3(std::cos(angle) * axes.axes[1] + std::sin(angle) * axes.axes[2])});
    }
  }
  return lines;
}

void cast(benchmark::State& state, const std::vector<std::shared_ptr<const TriangleMesh>>& meshes, int sections,
          bool plain) {
  const RayDevice device;
  std::vector<RayScene> scenes;
  std::vector<std::vector<Line>> lines;
  std::size_t count = 0;
  for (const auto& mesh : meshes) {
    scenes.push_back(plain ? RayScene(*mesh) : RayScene(device, *mesh));
    lines.push_back(section_lines(*mesh, sections));
    count += lines.back().size();
  }
  std::vector<LineExtremes> extremes;
  const std::clock_t start = std::clock();  // of the processor: neighbours on the machine do not count
  for (auto _ : state) {
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      extremes.resize(lines[i].size());
      scenes[i].cast(lines[i], extremes);
      benchmark::DoNotOptimize(extremes.data());
    }
  }
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const double nanoseconds = 1.0e9 * seconds / (static_cast<double>(count) * static_cast<double>(state.iterations()));
  state.counters["ns_per_line"] = nanoseconds;
  state.counters["ns_per_ray"] = nanoseconds / 4.0;
  state.counters["lines"] = static_cast<double>(count);
}

void cast_walker(benchmark::State& state, bool plain) {
  const auto walker = load_walker();
  if (walker == nullptr) return state.SkipWithError("the default content is not there");
  std::vector<std::shared_ptr<const TriangleMesh>> meshes;
  for (const auto& [name, mesh] : walker->muscle_meshes) meshes.push_back(mesh);
  cast(state, meshes, 5, plain);
}

void cast_gluteus(benchmark::State& state, bool plain) {
  const char* data = std::getenv("FASCICLE_DATA");
  const std::filesystem::path file =
      std::filesystem::path(data != nullptr ? data : "../shared/data") / "pbd" / "gluteus_maximus.vtk";
  if (!std::filesystem::exists(file)) {
    return state.SkipWithError((file.string() + " is absent; set FASCICLE_DATA").c_str());
  }
  const auto mesh = read_mesh(file.string());
  if (!mesh) return state.SkipWithError(to_text(mesh.diagnostics()).c_str());
  cast(state, {std::make_shared<const TriangleMesh>(*mesh)}, 9, plain);
}

// A long ball with bumps, of about so many triangles: rows and columns of a globe.
TriangleMesh bumpy_ball(std::int64_t triangles) {
  const int rows = std::max(4, static_cast<int>(std::sqrt(static_cast<double>(triangles) / 4.0)) + 1);
  const int columns = 2 * rows;
  TriangleMesh mesh;
  const auto add = [&](double theta, double phi) {
    const double radius = 1.0 + 0.1 * std::sin(5.0 * theta) * std::sin(4.0 * phi);
    mesh.positions.emplace_back(radius * std::sin(theta) * std::cos(phi), radius * std::sin(theta) * std::sin(phi),
                                3.0 * radius * std::cos(theta));
  };
  add(0.0, 0.0);
  for (int k = 1; k < rows; ++k) {
    for (int i = 0; i < columns; ++i) add(std::numbers::pi * k / rows, 2.0 * std::numbers::pi * i / columns);
  }
  add(std::numbers::pi, 0.0);
  const auto at = [&](int k, int i) { return static_cast<std::uint32_t>(1 + (k - 1) * columns + i % columns); };
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (int i = 0; i < columns; ++i) {
    mesh.indices.insert(mesh.indices.end(), {0u, at(1, i), at(1, i + 1)});
    for (int k = 1; k + 1 < rows; ++k) {
      mesh.indices.insert(mesh.indices.end(), {at(k, i), at(k + 1, i), at(k, i + 1)});
      mesh.indices.insert(mesh.indices.end(), {at(k, i + 1), at(k + 1, i), at(k + 1, i + 1)});
    }
    mesh.indices.insert(mesh.indices.end(), {last, at(rows - 1, i + 1), at(rows - 1, i)});
  }
  return mesh;
}

void cast_ball(benchmark::State& state, bool plain) {
  const auto mesh = std::make_shared<const TriangleMesh>(bumpy_ball(state.range(0)));
  // The plain loop's time is known from few lines.
  cast(state, {mesh}, plain ? std::max(1, static_cast<int>(20'000 / state.range(0))) : 40, plain);
  state.counters["triangles"] = static_cast<double>(mesh->indices.size() / 3);
}

BENCHMARK_CAPTURE(fit_walker, embree, false)->Name("fit/walker")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit_walker, plain, true)->Name("fit/walker_reference")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cast_walker, embree, false)->Name("fit_rays/walker")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cast_walker, plain, true)->Name("fit_rays/walker_reference")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cast_gluteus, embree, false)->Name("fit_rays/gluteus")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cast_gluteus, plain, true)->Name("fit_rays/gluteus_reference")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cast_ball, embree, false)->Name("fit_rays/triangles")->RangeMultiplier(10)->Range(1'000, 1'000'000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cast_ball, plain, true)->Name("fit_rays/triangles_reference")->RangeMultiplier(10)
    ->Range(1'000, 1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
