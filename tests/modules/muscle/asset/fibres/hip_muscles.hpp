// The hip scenes' muscles from the real data, without a scene: in metres, turned nowhere.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/content/vtk_reader.hpp"
#include "engine/geometry/closest_point.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::test {

inline std::vector<muscle::FibreLine> read_hip_fibres() {
  const Result<PolylineSet> lines = read_polylines(data_folder() / "pbd/gluteus_maximus_fibres.vtk");
  std::vector<muscle::FibreLine> fibres;
  if (!lines) return fibres;
  // The file has every segment as a line of its own.
  std::uint32_t last = 0xffffffffu;
  for (std::size_t l = 0; l < lines->ends.size(); ++l) {
    const std::span<const std::uint32_t> line = lines->line(l);
    if (line.front() != last) fibres.push_back({{0.001f * lines->positions[line.front()]}, 0});
    for (const std::uint32_t p : line.subspan(1)) fibres.back().points.push_back(0.001f * lines->positions[p]);
    last = line.back();
  }
  return fibres;
}

// Held above `held_above` (mm) and within 2 mm of the femur. Null where the data is absent or a mesh is refused.
inline std::shared_ptr<const muscle::SurfaceAsset> build_hip_muscle(const std::string& name, float held_above) {
  const Result<TriangleMesh> femur = read_vtk(data_folder() / "pbd/femur.vtk");
  Result<TriangleMesh> mesh = read_vtk(data_folder() / ("pbd/" + name + ".vtk"));
  if (!femur || !mesh) return nullptr;
  const ClosestPoints bone(*femur);
  muscle::SurfaceMuscleDescription description;
  description.name = name;
  description.attachments = {{.bone = 0, .origin = true, .vertices = {}}, {.bone = 1, .origin = false, .vertices = {}}};
  for (std::uint32_t v = 0; v < mesh->positions.size(); ++v) {
    if (mesh->positions[v].z > held_above) {
      description.attachments[0].vertices.push_back(v);
    } else if (bone.at(mesh->positions[v]).distance <= 2.0f) {
      description.attachments[1].vertices.push_back(v);
    }
  }
  description.bones = {1};
  for (glm::vec3& p : mesh->positions) p *= 0.001f;
  description.mesh = std::move(*mesh);
  if (name == "gluteus_maximus") description.fibres = read_hip_fibres();
  const auto asset = muscle::build_surface_asset(description, 2);
  return asset ? *asset : nullptr;
}

inline std::shared_ptr<const muscle::SurfaceAsset> build_gluteus() {
  return build_hip_muscle("gluteus_maximus", -343.7f);
}
inline std::shared_ptr<const muscle::SurfaceAsset> build_iliacus() { return build_hip_muscle("iliacus", -313.8f); }

}  // namespace fascicle::test
