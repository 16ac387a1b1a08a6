// Distances to a bone, on one thread:
//
//   bone_field/BONE/UM/random     BoneField, voxels of UM micrometres, points all over the bone's box in any order
//   bone_field/BONE/UM/coherent   the same along short lines, as a muscle's surface asks
//
// of `femur` (42,456 triangles; real data, skipped without) and `bar`, a made bone; beside each what else would do:
// _dense a plain grid over the whole box, _openvdb OpenVDB's own box sampler on the level set, and _reference the
// nearest triangle and a winding number, which is what all of them stand for.
// Counters: the time for a point, KiB for the bone.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <glm/geometric.hpp>

#include "engine/content/mesh_reader.hpp"
#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/asset/bone_fields/bone_grid.hpp"
#include "modules/muscle/asset/bone_fields/grid_state.hpp"
#include "modules/muscle/content/find_content.hpp"

namespace {

using namespace fascicle;
using muscle::BoneField;

// A bent bar with heads, 0.4 m long, about 16,000 triangles.
TriangleMesh make_bar() {
  constexpr std::uint32_t kRings = 160, kSegments = 50;
  TriangleMesh mesh;
  for (std::uint32_t k = 0; k <= kRings; ++k) {
    const double t = static_cast<double>(k) / kRings, s = 2.0 * t - 1.0;
    const double radius = (0.012 + 0.02 * std::pow(s, 8.0)) * std::sqrt(std::max(1.0 - std::pow(s, 40.0), 0.0));
    for (std::uint32_t i = 0; i < kSegments; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kSegments;
      mesh.positions.emplace_back(0.02 * s * s + radius * std::cos(angle), radius * std::sin(angle), 0.2 * s);
    }
  }
  for (std::uint32_t k = 0; k < kRings; ++k) {
    for (std::uint32_t i = 0; i < kSegments; ++i) {
      const std::uint32_t a = k * kSegments + i, b = k * kSegments + (i + 1) % kSegments;
      mesh.indices.insert(mesh.indices.end(), {a, b, a + kSegments, b, b + kSegments, a + kSegments});
    }
  }
  return mesh;
}

struct Bone {
  TriangleMesh mesh;  // m; empty: not there
  std::map<int, muscle::BoneGrid> grids;  // by micrometres
  std::map<int, BoneField> fields;
};

Bone& find_bone(const std::string& name) {
  static std::map<std::string, Bone> bones;
  const auto [found, added] = bones.try_emplace(name);
  if (added && name == "bar") found->second.mesh = make_bar();
  if (added && name == "femur") {
    auto mesh = read_mesh((muscle::find_data_folder() / "pbd" / "femur.vtk").string());
    if (mesh) {
      for (glm::vec3& position : mesh->positions) position *= 0.001f;
      found->second.mesh = clean_mesh(*mesh).mesh;
    }
  }
  return found->second;
}

struct Points {
  std::vector<float> x, y, z, distance;
};

Points make_points(const BoneField& field, bool coherent, std::size_t count) {
  std::mt19937 generator(3);
  const auto fraction = [&] { return static_cast<float>(generator() >> 8) / 16777216.0f; };
  Points points;
  glm::vec3 point(0.0f), step(0.0f);
  for (std::size_t i = 0; i < count; ++i) {
    if (!coherent || i % 256 == 0) {
      for (int axis = 0; axis < 3; ++axis) {
        point[axis] = field.lower()[axis] + fraction() * (field.upper()[axis] - field.lower()[axis]);
        step[axis] = 0.00005f * (fraction() - 0.5f);  // 256 stay within the band
      }
    }
    point += step;
    points.x.push_back(point.x);
    points.y.push_back(point.y);
    points.z.push_back(point.z);
  }
  points.distance.resize(count);
  return points;
}

// All samples of the box in one array.
class DenseGrid {
 public:
  DenseGrid(const muscle::BoneGrid::State& bone) : inverse_(1.0f / bone.voxel) {
    for (int axis = 0; axis < 3; ++axis) {
      first_[axis] = static_cast<int>(std::floor((bone.lower[axis] - bone.band) * inverse_));
      size_[axis] = static_cast<int>(std::ceil((bone.upper[axis] + bone.band) * inverse_)) - first_[axis] + 1;
    }
    const auto voxels = bone.grid->getConstAccessor();
    for (int i = 0; i < size_.x; ++i) {
      for (int j = 0; j < size_.y; ++j) {
        for (int k = 0; k < size_.z; ++k) {
          samples_.push_back(voxels.getValue({first_.x + i, first_.y + j, first_.z + k}));
        }
      }
    }
  }
  float distance(float px, float py, float pz) const {
    const float x = px * inverse_ - static_cast<float>(first_.x), y = py * inverse_ - static_cast<float>(first_.y),
                z = pz * inverse_ - static_cast<float>(first_.z);
    const int i = static_cast<int>(x), j = static_cast<int>(y), k = static_cast<int>(z);
    const float fx = x - static_cast<float>(i), fy = y - static_cast<float>(j), fz = z - static_cast<float>(k);
    const std::size_t row = static_cast<std::size_t>(size_.z), slab = row * static_cast<std::size_t>(size_.y);
    const float* c = samples_.data() + static_cast<std::size_t>(i) * slab + static_cast<std::size_t>(j) * row +
                     static_cast<std::size_t>(k);
    const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
    return mix(mix(mix(c[0], c[1], fz), mix(c[row], c[row + 1], fz), fy),
               mix(mix(c[slab], c[slab + 1], fz), mix(c[slab + row], c[slab + row + 1], fz), fy), fx);
  }
  std::size_t bytes() const { return samples_.size() * sizeof(float); }

 private:
  float inverse_;
  glm::ivec3 first_{0}, size_{0};
  std::vector<float> samples_;
};

enum class Way { kField, kDense, kOpenVdb, kReference };

void ask(benchmark::State& state, const std::string& name, int micrometres, bool coherent, Way way) {
  Bone& bone = find_bone(name);
  if (bone.mesh.indices.empty()) return state.SkipWithError("the real data is not there");
  if (!bone.grids.contains(micrometres)) {
    auto grid = muscle::build_bone_grid({&bone.mesh, 1}, name, {.voxel = 1e-6f * static_cast<float>(micrometres)});
    if (!grid) return state.SkipWithError(grid.diagnostics().errors.front().cause.c_str());
    bone.fields.emplace(micrometres, muscle::flatten(*grid));
    bone.grids.emplace(micrometres, std::move(*grid));
  }
  const BoneField& field = bone.fields.at(micrometres);
  const muscle::BoneGrid& grid = bone.grids.at(micrometres);
  Points points = make_points(field, coherent, way == Way::kReference ? 2'000 : 500'000);
  const std::size_t count = points.distance.size();
  std::size_t bytes = 0;
  if (way == Way::kField) {
    bytes = field.heap_bytes();
    for (auto _ : state) field.distances(points.x, points.y, points.z, points.distance);
  } else if (way == Way::kDense) {
    const DenseGrid dense(grid.state());
    bytes = dense.bytes();
    for (auto _ : state) {
      for (std::size_t i = 0; i < count; ++i) {
        points.distance[i] = dense.distance(points.x[i], points.y[i], points.z[i]);
      }
    }
  } else if (way == Way::kOpenVdb) {
    bytes = grid.bytes();
    const auto voxels = grid.state().grid->getConstAccessor();
    const float inverse = 1.0f / field.voxel();
    for (auto _ : state) {
      for (std::size_t i = 0; i < count; ++i) {
        const openvdb::Vec3R place(points.x[i] * inverse, points.y[i] * inverse, points.z[i] * inverse);
        points.distance[i] = openvdb::tools::BoxSampler::sample(voxels, place);
      }
    }
  } else {
    const ClosestPoints nearest(bone.mesh);
    const WindingField winding(bone.mesh);
    bytes = bone.mesh.indices.size() * 4 + bone.mesh.positions.size() * 12;
    for (auto _ : state) {
      for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 point(points.x[i], points.y[i], points.z[i]);
        const float distance = nearest.at(point).distance;
        points.distance[i] = winding.inside(glm::dvec3(point)) ? -distance : distance;
      }
    }
  }
  benchmark::DoNotOptimize(points.distance.data());
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * count));
  state.counters["KiB"] = static_cast<double>(bytes) / 1024.0;
  using benchmark::Counter;
  state.counters["point"] =
      Counter(static_cast<double>(count), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

[[maybe_unused]] const bool registered = [] {
  const std::pair<Way, const char*> ways[] = {
      {Way::kField, ""}, {Way::kDense, "_dense"}, {Way::kOpenVdb, "_openvdb"}, {Way::kReference, "_reference"}};
  for (const char* bone : {"femur", "bar"}) {
    for (const int micrometres : {2000, 1000, 500}) {
      for (const bool coherent : {false, true}) {
        for (const auto& [way, ending] : ways) {
          if (way == Way::kReference && (micrometres != 2000 || coherent)) continue;  // knows no voxels
          const std::string name = std::string("bone_field/") + bone + "/" + std::to_string(micrometres) + "/" +
                                   (coherent ? "coherent" : "random") + ending;
          benchmark::RegisterBenchmark(name.c_str(), ask, std::string(bone), micrometres, coherent, way)
              ->Unit(benchmark::kMillisecond);
        }
      }
    }
  }
  return true;
}();

}  // namespace
