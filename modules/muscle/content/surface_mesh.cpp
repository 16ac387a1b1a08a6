#include "modules/muscle/content/surface_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <glm/mat4x4.hpp>

#include "engine/content/closest_name.hpp"
#include "engine/content/gltf_reader.hpp"
#include "engine/content/length_unit.hpp"
#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/mesh_pieces.hpp"
#include "modules/muscle/content/surface_limits.hpp"

namespace fascicle::muscle {

namespace {

constexpr float kUsualLeast = 0.03f, kUsualMost = 1.0f;  // m: what a suggested unit should make of a muscle
constexpr std::size_t kMostPiecesNamed = 6;

std::string count(std::size_t number, const char* one, const char* several) {
  return fmt::format("{} {}", number, number == 1 ? one : several);
}

using MeshPointer = std::shared_ptr<const TriangleMesh>;

MeshPointer find_mesh(const SurfaceMuscleEntry& entry, const CharacterFile& file, const std::filesystem::path& base,
                      ContentSources& sources, Diagnostics& diagnostics) {
  const MeshEntry& mesh = entry.mesh;
  if (mesh.file.given()) return sources.mesh(mesh.file.text, base, mesh.file.node, diagnostics);
  if (!mesh.name.given()) return nullptr;
  const NameEntry& all = file.muscle_meshes;
  if (!all.given()) {
    mesh.node.error(diagnostics, fmt::format("the mesh '{}' is named, but the file has no muscle_meshes", mesh.name.text),
                    "add \"muscle_meshes\": {\"file\": \"muscles.glb\"}, or give the mesh as {\"file\": ...}");
    return nullptr;
  }
  const auto gltf = sources.gltf(all.text, base, all.node, diagnostics);
  if (!gltf) return nullptr;
  const GltfMesh* found = gltf->find_mesh(mesh.name.text);
  if (found == nullptr) {
    std::vector<std::string> names;
    for (const GltfMesh& one : gltf->meshes) names.push_back(one.name);
    mesh.node.error(diagnostics, fmt::format("'{}' has no mesh '{}'", all.text, mesh.name.text),
                    suggest_name(mesh.name.text, names, "meshes"));
    return nullptr;
  }
  return rest_space_mesh(*gltf, static_cast<std::size_t>(found - gltf->meshes.data()));
}

// The triangles of one piece, with the vertices that they use.
TriangleMesh take_piece(const TriangleMesh& mesh, const MeshPieces& pieces, std::uint32_t piece) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> at(mesh.positions.size(), kUnused);
  TriangleMesh taken;
  taken.name = mesh.name;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    if (pieces.piece[i / 3] == piece) at[mesh.indices[i]] = 0;
  }
  for (std::size_t v = 0; v < at.size(); ++v) {
    if (at[v] == kUnused) continue;
    at[v] = static_cast<std::uint32_t>(taken.positions.size());
    taken.positions.push_back(mesh.positions[v]);
  }
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    if (pieces.piece[i / 3] == piece) taken.indices.push_back(at[mesh.indices[i]]);
  }
  return taken;
}

// The piece that the entry chooses. Nothing, with an error, where it should choose and doesn't.
std::optional<TriangleMesh> choose_piece(const SurfaceMuscleEntry& entry, TriangleMesh mesh, double unit,
                                         Diagnostics& diagnostics) {
  const MeshPieces pieces = find_pieces(mesh.indices, mesh.positions.size());
  if (entry.piece > pieces.count) {
    entry.piece_node.error(diagnostics,
                           fmt::format("the mesh has {}, there is no piece {}", count(pieces.count, "piece", "pieces"),
                                       entry.piece),
                           "count them from 1, the largest first");
    return std::nullopt;
  }
  if (pieces.count == 1) return mesh;
  struct Piece {
    TriangleMesh mesh;
    double volume = 0.0;  // m^3
  };
  std::vector<Piece> parts;
  for (std::uint32_t piece = 0; piece < pieces.count; ++piece) {
    Piece part{take_piece(mesh, pieces, piece), 0.0};
    part.volume = unit * unit * unit * mesh_volume(part.mesh);
    parts.push_back(std::move(part));
  }
  std::ranges::stable_sort(parts, std::greater{}, &Piece::volume);
  if (entry.piece > 0) return std::move(parts[entry.piece - 1].mesh);
  std::string list;
  for (std::size_t i = 0; i < std::min(parts.size(), kMostPiecesNamed); ++i) {
    list += fmt::format("{}{}: {} vertices, {:.4g} cm^3", i == 0 ? "" : "; ", i + 1, parts[i].mesh.positions.size(),
                        1e6 * parts[i].volume);
  }
  if (parts.size() > kMostPiecesNamed) list += "; ...";
  entry.mesh.node.error(diagnostics,
                        fmt::format("the mesh has {} pieces, and a muscle is one ({})", parts.size(), list),
                        "choose one with \"piece\": 1, and give each other muscle of the file an entry of its own");
  return std::nullopt;
}

// What cannot be mended.
bool is_closed(const MeshEntry& entry, const MeshDefects& defects, Diagnostics& diagnostics) {
  if (defects.components == 0) {
    entry.node.error(diagnostics, "the mesh has no triangle with an area", "name a file that holds a closed surface");
  }
  if (defects.open_edges > 0) {
    entry.node.error(diagnostics,
                     fmt::format("the mesh is open: {} one triangle only, round {}",
                                 count(defects.open_edges, "edge has", "edges have"),
                                 count(defects.holes, "hole", "holes")),
                     "close the holes: what is open has no volume to keep");
  }
  if (defects.crowded_edges > 0) {
    entry.node.error(diagnostics,
                     fmt::format("the mesh is no surface everywhere: {} more than two triangles",
                                 count(defects.crowded_edges, "edge has", "edges have")),
                     "remove inner walls and doubled parts, so that each edge has two");
  }
  if (defects.twisted_edges > 0) {
    entry.node.error(diagnostics,
                     fmt::format("the mesh has only one side: its triangles cannot be turned to agree at {}",
                                 count(defects.twisted_edges, "edge", "edges")),
                     "cut it there and close it the other way round");
  }
  return defects.closed();
}

void tell_repairs(const SurfaceMuscleEntry& entry, const MeshDefects& defects, Diagnostics& diagnostics) {
  const auto tell = [&](bool is_so, std::string cause, const char* remedy) {
    if (is_so) entry.mesh.node.warning(diagnostics, std::move(cause), remedy);
  };
  constexpr const char* kMend = "mend the file; until then this is done at each load";
  tell(defects.inverted, "the mesh is inside out: all its triangles are turned round", kMend);
  tell(defects.flipped_triangles > 0,
       fmt::format("{} the wrong way and {} {}",
                   count(defects.flipped_triangles, "triangle faces", "triangles face"),
                   defects.flipped_triangles == 1 ? "is" : "are", defects.inverted ? "left as it was" : "turned round"),
       kMend);
  const std::size_t dropped = defects.degenerate_triangles + defects.duplicate_triangles;
  tell(dropped > 0, fmt::format("{} without area or there twice, and left out", count(dropped, "triangle is", "triangles are")), kMend);
  tell(defects.non_finite_vertices > 0,
       fmt::format("{} no finite place, and left out",
                   count(defects.non_finite_vertices, "vertex is", "vertices are")),
       kMend);
  tell(defects.self_intersections > 0 && entry.settings.collide_with_itself,  // nothing else minds
       fmt::format("{}{} through each other at rest", defects.more_self_intersections ? "at least " : "",
                   count(defects.self_intersections, "pair of triangles passes", "pairs of triangles pass")),
       "smooth the mesh there: what crosses at rest stays crossed");
}

// An error where the size is none that a muscle has: the unit is wrong, then.
bool has_plausible_size(const MeshEntry& entry, const TriangleMesh& rest, float unit, Diagnostics& diagnostics) {
  const float size = mesh_bounds(rest).diagonal();
  if (size >= kShortestMuscle && size <= kLongestMuscle) return true;
  std::string remedy = "correct its \"unit\" or \"scale\"";
  for (const LengthUnit& known : kLengthUnits) {
    const float with_it = size / unit * known.metres;
    if (with_it < kUsualLeast || with_it > kUsualMost) continue;
    remedy = fmt::format("give \"unit\": \"{}\", with which it would be {:.3g} m", known.name, with_it);
    break;
  }
  entry.node.error(diagnostics, fmt::format("the muscle would be {:.3g} m long", size), std::move(remedy));
  return false;
}

}  // namespace

std::optional<SurfaceMesh> load_surface_mesh(const SurfaceMuscleEntry& entry, const CharacterFile& file,
                                             const std::filesystem::path& base, ContentSources& sources,
                                             Diagnostics& diagnostics) {
  SurfaceMesh mesh;
  mesh.source = find_mesh(entry, file, base, sources, diagnostics);
  if (!mesh.source) return std::nullopt;
  CleanMesh clean = clean_mesh(*mesh.source);
  if (!is_closed(entry.mesh, clean.defects, diagnostics)) return std::nullopt;
  tell_repairs(entry, clean.defects, diagnostics);

  const float unit = entry.mesh.name.given() ? file.muscle_mesh_unit : entry.mesh.unit;
  Trs placement = entry.mesh.transform;
  placement.scale *= unit;
  std::optional<TriangleMesh> piece = choose_piece(entry, std::move(clean.mesh), static_cast<double>(unit), diagnostics);
  if (!piece) return std::nullopt;
  mesh.rest = std::move(*piece);
  mesh.in_file = mesh.rest.positions;
  mesh.placement = to_matrix(placement);
  for (glm::vec3& position : mesh.rest.positions) position = glm::vec3(mesh.placement * glm::vec4(position, 1.0f));
  if (placement.scale.x * placement.scale.y * placement.scale.z < 0.0f) {  // a reflection turns it inside out
    for (std::size_t i = 0; i + 2 < mesh.rest.indices.size(); i += 3) {
      std::swap(mesh.rest.indices[i + 1], mesh.rest.indices[i + 2]);
    }
  }
  if (!has_plausible_size(entry.mesh, mesh.rest, unit, diagnostics)) return std::nullopt;
  return mesh;
}

}  // namespace fascicle::muscle
