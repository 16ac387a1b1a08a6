#include "modules/muscle/asset/surface/check_surface.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "engine/geometry/finite.hpp"
#include "engine/geometry/mesh_edges.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/mesh_pieces.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {
namespace {

class Checker {
 public:
  Checker(const SurfaceMuscleDescription& description, Diagnostics& found) : description_(description), found_(found) {}

  void check(std::uint32_t bone_count, const MuscleAsset* muscles) {
    if (check_numbers()) check_topology();
    check_bones(bone_count);
    check_attached();
    check_fibres();
    check_settings();
    if (description_.driver.empty()) return;
    if (muscles == nullptr || find_muscle(*muscles, description_.driver) < 0) {
      fault("driver", fmt::format("there is no muscle '{}' to carry it", description_.driver),
            "name one of the character's musculotendon units, or leave the driver out");
    }
  }

 private:
  void fault(const std::string& field, std::string cause, std::string remedy) {
    found_.errors.push_back(fault_of(description_, field, std::move(cause), std::move(remedy)));
  }

  bool check_numbers() {
    const TriangleMesh& mesh = description_.mesh;
    if (mesh.indices.empty() || mesh.indices.size() % 3 != 0) {
      fault("mesh", "the mesh has no triangles", "give a closed surface");
      return false;
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      if (mesh.indices[i] < mesh.positions.size()) continue;
      fault("mesh", fmt::format("triangle {} has corner {} of {} vertices", i / 3, mesh.indices[i],
                                mesh.positions.size()), "corners count from 0");
      return false;
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      if (is_finite(mesh.positions[v])) continue;
      fault("mesh", fmt::format("vertex {} is no finite place", v), "correct it in the mesh file");
      return false;
    }
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
      const std::uint32_t a = mesh.indices[t], b = mesh.indices[t + 1], c = mesh.indices[t + 2];
      if (a != b && b != c && c != a) continue;
      fault("mesh", fmt::format("triangle {} has a corner twice", t / 3), "leave it out");
      return false;
    }
    return true;
  }

  void check_topology() {
    const TriangleMesh& mesh = description_.mesh;
    const MeshEdges edges = find_edges(mesh.indices, mesh.positions.size());
    std::size_t open = 0, crowded = 0, turned = 0;
    for (std::size_t e = 0; e < edges.count(); ++e) {
      const auto sides = edges.sides_of(e);
      if (sides.size() == 1) ++open;
      if (sides.size() > 2) ++crowded;
      if (sides.size() == 2 && mesh.indices[sides[0]] == mesh.indices[sides[1]]) ++turned;
    }
    if (open > 0) fault("mesh", fmt::format("{} edges have one triangle only", open), "close the surface's holes");
    if (crowded > 0) {
      fault("mesh", fmt::format("{} edges have more than two triangles", crowded), "leave inner walls out");
    }
    if (turned > 0) {
      fault("mesh", fmt::format("{} edges run the same way in both of their triangles", turned),
            "turn the triangles on one side of them round");
    }
    if (open + crowded + turned > 0) return;
    const std::size_t pieces = find_pieces(mesh.indices, mesh.positions.size()).count;
    if (pieces > 1) {
      fault("mesh", fmt::format("the mesh is {} separate pieces", pieces), "make each a muscle of its own");
    } else if (!(mesh_volume(mesh) > 0.0)) {
      fault("mesh", "the mesh is inside out, or has no volume",
            "turn its triangles round: anticlockwise as seen from outside");
    }
  }

  void check_bone(const std::string& field, std::int32_t bone, std::uint32_t bone_count) {
    if (bone >= 0 && static_cast<std::uint32_t>(bone) < bone_count) return;
    fault(field, fmt::format("there is no bone {}", bone), fmt::format("the skeleton has {}", bone_count));
  }

  void check_bones(std::uint32_t bone_count) {
    check_bone("frame", description_.frame_bone, bone_count);
    for (const std::int32_t bone : description_.bones) check_bone("bones", bone, bone_count);
    for (std::size_t i = 0; i < description_.attachments.size(); ++i) {
      check_bone(fmt::format("attachments/{}", i), description_.attachments[i].bone, bone_count);
    }
  }

  void check_attached() {
    std::vector<std::int32_t> owner(description_.mesh.positions.size(), -1);
    for (std::size_t i = 0; i < description_.attachments.size(); ++i) {
      const std::string field = fmt::format("attachments/{}", i);
      const auto& vertices = description_.attachments[i].vertices;
      if (vertices.empty()) fault(field, "it takes no vertex of the mesh", "make it wider, or leave it out");
      for (const std::uint32_t v : vertices) {
        if (v >= owner.size()) {
          fault(field, fmt::format("there is no vertex {}", v), fmt::format("the mesh has {}", owner.size()));
          break;
        }
        if (owner[v] >= 0 && owner[v] != static_cast<std::int32_t>(i)) {
          fault(field, fmt::format("vertex {} belongs to attachment {} already", v, owner[v]),
                "let them not overlap");
          break;
        }
        owner[v] = static_cast<std::int32_t>(i);
      }
    }
  }

  void check_fibres() {
    for (std::size_t i = 0; i < description_.fibres.size(); ++i) {
      const auto& points = description_.fibres[i].points;
      const bool sound = points.size() >= 2 && std::all_of(points.begin(), points.end(), is_finite<float>);
      if (!sound) fault(fmt::format("fibres/{}", i), "a fibre is two finite points or more", "correct or leave it out");
    }
  }

  void check_range(const char* name, float value, float least, float most) {
    if (value >= least && value <= most) return;
    fault(fmt::format("settings/{}", name), fmt::format("{} is out of range", value),
          fmt::format("give {} to {}", least, most));
  }

  void check_settings() {
    const SurfaceSettings& s = description_.settings;
    check_range("substeps", static_cast<float>(s.substeps), 1, 1000);
    check_range("density", s.density, 1.0f, 1.0e5f);
    check_range("stretch_compliance", s.stretch_compliance, 0.0f, 1.0e6f);
    check_range("along_fibres", s.along_fibres, 0.0f, 1.0f);
    check_range("bend_compliance", s.bend_compliance, 0.0f, 1.0e9f);
    check_range("volume_compliance", s.volume_compliance, 0.0f, 1.0f);
    check_range("anchor_compliance", s.anchor_compliance, 0.0f, 1.0e9f);
    check_range("damping", s.damping, 0.0f, 1.0e4f);
    check_range("viscosity", s.viscosity, 0.0f, 1.0e4f);
    check_range("contact_distance", s.contact_distance, 0.0f, 0.1f);
    check_range("friction", s.friction, 0.0f, 10.0f);
  }

  const SurfaceMuscleDescription& description_;
  Diagnostics& found_;
};

}  // namespace

Diagnostic fault_of(const SurfaceMuscleDescription& description, const std::string& field, std::string cause,
                    std::string remedy) {
  Diagnostic fault = description.where;
  fault.path += "/" + field;
  fault.cause = fmt::format("surface muscle '{}': {}", description.name, cause);
  fault.remedy = std::move(remedy);
  return fault;
}

Diagnostics check_surface(const SurfaceMuscleDescription& description, std::uint32_t bone_count,
                          const MuscleAsset* muscles) {
  Diagnostics found;
  Checker(description, found).check(bone_count, muscles);
  return found;
}

}  // namespace fascicle::muscle
