#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <glm/geometric.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/asset/bone_fields/bone_grid.hpp"
#include "modules/muscle/asset/bone_fields/bone_grid_file.hpp"
#include "modules/muscle/content/bone_field_store.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "tools/fascicle_cook/commands.hpp"
#include "tools/fascicle_cook/find_character.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;
using muscle::BoneField;
using muscle::StoredBoneGrid;

struct Options {
  std::string source;
  bool rebuild = false, info = false;
};

class Watch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// The bone's meshes cleaned, in one.
struct Original {
  TriangleMesh mesh;
  std::size_t open_edges = 0;
};

Original join(const std::vector<TriangleMesh>& meshes) {
  Original joined;
  for (const TriangleMesh& mesh : meshes) {
    const CleanMesh clean = clean_mesh(mesh);
    joined.open_edges += clean.defects.open_edges;
    const auto first = static_cast<std::uint32_t>(joined.mesh.positions.size());
    joined.mesh.positions.insert(joined.mesh.positions.end(), clean.mesh.positions.begin(), clean.mesh.positions.end());
    for (const std::uint32_t index : clean.mesh.indices) joined.mesh.indices.push_back(first + index);
  }
  return joined;
}

// m: how far the field is from the nearest triangle's distance, at points up to a voxel outside some 2,000 triangles.
double largest_error(const TriangleMesh& mesh, const BoneField& field) {
  const ClosestPoints nearest(mesh);
  const WindingField winding(mesh);
  const std::size_t count = mesh.indices.size() / 3, stride = std::max<std::size_t>(count / 2000, 1);
  double worst = 0.0;
  for (std::size_t t = 0; t < count; t += stride) {
    const glm::vec3 a = mesh.positions[mesh.indices[3 * t]], b = mesh.positions[mesh.indices[3 * t + 1]],
                    c = mesh.positions[mesh.indices[3 * t + 2]];
    const glm::vec3 area = glm::cross(b - a, c - a);
    const float length = glm::length(area);
    if (!(length > 0.0f)) continue;
    for (const float voxels : {0.25f, 0.5f, 1.0f}) {
      const glm::vec3 point = (a + b + c) / 3.0f + area * (voxels * field.voxel() / length);
      if (winding.at(glm::dvec3(point)) > 0.25) continue;  // in another part of the bone, or in a hole
      worst = std::max(worst, std::abs(double{field.distance(point)} - double{nearest.at(point).distance}));
    }
  }
  return worst;
}

int print_fields(const Options& options) {
  const auto file = find_character(options.source);
  if (!file) {
    print_diagnostics(file.diagnostics());
    return kErrors;
  }
  const auto character =
      muscle::load_character(*file, {.fit = muscle::FitMode::kNone, .bone_fields = false});
  print_diagnostics(character.diagnostics());
  if (!character) return kErrors;
  const std::vector<std::vector<TriangleMesh>> meshes = muscle::bone_surfaces(**character);
  const muscle::BoneGridSettings settings{.voxel = (*character)->collision.settings.bone_voxel};
  const fs::path store = muscle::bone_field_store_of(*file);
  const Watch reading;
  std::vector<StoredBoneGrid> stored;
  if (!options.rebuild) stored = muscle::read_bone_grids(store);
  const double read_time = reading.milliseconds();

  fmt::print("{:<20} {:>9} {:>10} {:>9} {:>7} {:>9} {:>9} {:>10} {:>9}\n", "bone", "triangles", "open edges", "voxels",
             "bricks", "KiB", "build ms", "flatten ms", "error mm");
  std::vector<StoredBoneGrid> kept;
  std::size_t built = 0, bytes = 0;
  double flatten_time = 0.0;
  bool sound = true;
  for (std::size_t bone = 0; bone < meshes.size(); ++bone) {
    if (meshes[bone].empty()) continue;
    const std::string& name = (*character)->skeleton->names[bone];
    const std::uint64_t inputs = muscle::hash_bone_inputs(meshes[bone], settings);
    const auto known = std::find_if(stored.begin(), stored.end(),
                                    [&](const StoredBoneGrid& grid) { return grid.inputs == inputs; });
    std::string build_time = "stored";
    if (known != stored.end()) {
      kept.push_back({name, inputs, known->grid});
    } else {
      const Watch building;
      Result<muscle::BoneGrid> grid = muscle::build_bone_grid(meshes[bone], name, settings);
      if (!grid) {
        print_diagnostics(grid.diagnostics());
        sound = false;
        continue;
      }
      build_time = fmt::format("{:.1f}", building.milliseconds());
      kept.push_back({name, inputs, std::move(*grid)});
      ++built;
    }
    const Watch flattening;
    const BoneField field = muscle::flatten(kept.back().grid);
    const double flat = flattening.milliseconds();
    flatten_time += flat;
    bytes += field.heap_bytes();
    const Original original = join(meshes[bone]);
    fmt::print("{:<20} {:>9} {:>10} {:>9} {:>7} {:>9} {:>9} {:>10.2f} {:>9.3f}\n", name,
               original.mesh.indices.size() / 3, original.open_edges, kept.back().grid.active_voxels(),
               field.brick_count(), field.heap_bytes() / 1024, build_time, flat,
               1000.0 * largest_error(original.mesh, field));
  }
  fmt::print("\n{} bones at {:.3g} mm, {:.1f} MiB of fields; read {} stored in {:.1f} ms, flattened in {:.1f} ms\n",
             kept.size(), 1000.0 * double{settings.voxel}, static_cast<double>(bytes) / 1048576.0, stored.size(),
             read_time, flatten_time);
  if (!options.info && (built > 0 || kept.size() != stored.size())) {
    if (!muscle::write_bone_grids(store, kept)) {
      print_diagnostics({.errors = {{store.string(), 0, 0, {}, "the bones' fields cannot be stored",
                                     "check that the folder may be written; else they are built at each load"}},
                         .warnings = {}});
      return kErrors;
    }
    fmt::print("wrote {}\n", store.string());
  }
  return sound ? kFine : kErrors;
}

}  // namespace

void add_fields(CLI::App& program, Command& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "fields", "Build the fields of a character's bones, store them beside its file, and tell how good they are");
  command->add_option("CHARACTER", options->source, "A character's name (walker) or file")->required();
  command->add_flag("--rebuild", options->rebuild, "Build all of them, stored or not");
  command->add_flag("--info", options->info, "Store nothing");
  command->callback([options, &chosen] { chosen = [options] { return print_fields(*options); }; });
}

}  // namespace fascicle::cook
