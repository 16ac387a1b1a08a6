// A mesh by itself as a character: one bone, and one straight muscle through the mesh, so that an author can see how
// well a mesh can be fitted before there is a skeleton.
#pragma once

#include <memory>
#include <string>

#include "engine/content/result.hpp"
#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::cook {

struct MeshFitOptions {
  float unit = 1.0f;                            // m, of the mesh's numbers
  std::uint32_t section_vertices = 36;          // |C|
  std::uint32_t longitudinal_subdivision = 3;   // LSS
  std::uint32_t supersampling = 3;              // CSS
};

// `reference` is a path as read_mesh takes it. The action line runs straight along the mesh's principal axis, from 1 % of
// the mesh's length inside one end to 1 % inside the other; there each end lies deepest inside the mesh's slice square
// to the axis, so that a bent muscle has its ends inside, too. Errors: the reader's; a mesh without a slice; the fit's
// warnings where it fails.
Result<std::shared_ptr<const muscle::CharacterAsset>> make_mesh_character(const std::string& reference,
                                                                          const MeshFitOptions& options);

}  // namespace fascicle::cook
