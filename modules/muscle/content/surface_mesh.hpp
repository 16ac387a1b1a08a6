// The mesh of a surface muscle, from its file to one closed, outward piece in the rest space. What can be mended
// without a doubt is mended and told as a warning; what cannot (holes, edges with three triangles, several pieces, a
// size that no muscle has) is an error with the way out.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/content/character_file.hpp"
#include "modules/muscle/content/content_sources.hpp"

namespace fascicle::muscle {

struct SurfaceMesh {
  std::shared_ptr<const TriangleMesh> source;  // as read, in the file's own coordinates and unit
  TriangleMesh rest;                           // mended, m, rest space
  std::vector<glm::vec3> in_file;              // by vertex of `rest`: where it stands in the file
  glm::mat4 placement{1.0f};                   // from there to the rest space
};

// `base` is the folder of `file`.
std::optional<SurfaceMesh> load_surface_mesh(const SurfaceMuscleEntry& entry, const CharacterFile& file,
                                             const std::filesystem::path& base, ContentSources& sources,
                                             Diagnostics& diagnostics);

}  // namespace fascicle::muscle
