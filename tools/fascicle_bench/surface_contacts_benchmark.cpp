// Contacts of surface muscles with themselves and with each other:
//
//   surface_contacts/itself/gluteus    places boxes and normals and finds the pairs of the gluteus at rest, margin 1 mm
//   surface_contacts/two/10000         places the boxes of two spheres of 10,000 vertices that touch, finds their pairs
//   surface_contacts/project/10000     pushes those apart, once, as each substep does
//
// Pairs serve for some steps where things are slow, so steps cost less than this.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/asset/surface/surface_tree.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "modules/muscle/content/scene_asset.hpp"
#include "modules/muscle/kernels/surface/surface_pairs.hpp"

namespace {

using namespace fascicle;
using namespace fascicle::muscle;

constexpr float kContact = 0.0012f, kMargin = 0.001f;  // m

struct Body {
  std::shared_ptr<const SurfaceAsset> asset;
  SurfaceBoxes boxes;
  AlignedVector<SurfacePoint> points;

  Body(std::shared_ptr<const SurfaceAsset> of, bool itself) : asset(std::move(of)), points(asset->rest) {
    lay_out_boxes(*asset->tree, *asset, itself, boxes);
  }
  PairedSurface paired() { return {asset.get(), asset->tree.get(), &boxes, points, {}}; }
  void place() { place_boxes(*asset->tree, *asset, points, boxes); }
};

// 2 n^2 + 2 vertices, poles on the z axis: two that lie beside each other touch where triangles are even.
std::shared_ptr<const SurfaceAsset> sphere(std::uint32_t n, float radius, float x) {
  SurfaceMuscleDescription description;
  const auto at = [&](double theta, double phi) {
    const double r = static_cast<double>(radius);
    return glm::vec3(static_cast<double>(x) + r * std::sin(theta) * std::cos(phi), r * std::sin(theta) * std::sin(phi),
                     r * std::cos(theta));
  };
  TriangleMesh& mesh = description.mesh;
  const std::uint32_t around = 2 * n, rings = n;
  mesh.positions.push_back(at(0.0, 0.0));
  for (std::uint32_t k = 1; k <= rings; ++k) {
    for (std::uint32_t i = 0; i < around; ++i) {
      mesh.positions.push_back(at(std::numbers::pi * k / (rings + 1), 2.0 * std::numbers::pi * i / around));
    }
  }
  mesh.positions.push_back(at(std::numbers::pi, 0.0));
  const auto last = static_cast<std::uint32_t>(mesh.positions.size()) - 1;
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t j = (i + 1) % around;
    mesh.indices.insert(mesh.indices.end(), {0, 1 + i, 1 + j});
    for (std::uint32_t k = 0; k + 1 < rings; ++k) {
      const std::uint32_t a = 1 + k * around + i, b = 1 + k * around + j, c = a + around, d = b + around;
      mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, d});
    }
    mesh.indices.insert(mesh.indices.end(), {last, 1 + (rings - 1) * around + j, 1 + (rings - 1) * around + i});
  }
  const auto asset = build_surface_asset(description, 1);
  return asset ? *asset : nullptr;
}

PairsJob job_of(Body& first, Body* second) {
  PairsJob job;
  job.first = first.paired();
  if (second != nullptr) job.second = second->paired();
  job.contact_distance = kContact;
  job.margin = kMargin;
  return job;
}

void itself(benchmark::State& state) {
  const auto scene = load_scene(find_scene("hip-gluteus", find_content_folder()));
  if (!scene || (*scene)->characters.empty() || (*scene)->characters[0].character->surface_muscles.empty()) {
    return state.SkipWithError("the scene's data is not there");
  }
  Body body((*scene)->characters[0].character->surface_muscles[0], true);
  SurfacePairs pairs;
  lay_out_pairs(usual_pair_capacity(body.asset->vertex_count), pairs);
  const PairsJob job = job_of(body, nullptr);
  for (auto _ : state) {
    body.place();
    find_pairs(job, pairs);
    benchmark::ClobberMemory();
  }
  state.counters["pairs"] = static_cast<double>(pairs.pairs.size());
  state.counters["vertices"] = body.asset->vertex_count;
}

void two(benchmark::State& state, bool project) {
  const auto left = sphere(70, 0.05f, 0.0f), right = sphere(70, 0.05f, 0.1f + 0.5f * kContact);
  if (left == nullptr || right == nullptr) return state.SkipWithError("no sphere");
  Body first(left, false), second(right, false);
  SurfacePairs pairs;
  lay_out_pairs(usual_pair_capacity(first.asset->vertex_count), pairs);
  const PairsJob job = job_of(first, &second);
  first.place();
  second.place();
  find_pairs(job, pairs);
  for (auto _ : state) {
    if (project) {
      project_pairs(job, pairs);
    } else {
      first.place();
      second.place();
      find_pairs(job, pairs);
    }
    benchmark::ClobberMemory();
  }
  state.counters["pairs"] = static_cast<double>(pairs.pairs.size());
  state.counters["vertices"] = first.asset->vertex_count;
}

[[maybe_unused]] const bool kRegistered = [] {
  benchmark::RegisterBenchmark("surface_contacts/itself/gluteus", itself)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("surface_contacts/two/10000", two, false)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("surface_contacts/project/10000", two, true)->Unit(benchmark::kMicrosecond);
  return true;
}();

}  // namespace
