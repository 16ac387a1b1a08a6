// Where a muscle's fibres begin and end on its surface: one connected patch of attached vertices at the origin and one
// at the insertion, without holes. What lies between them is a tube that the isocontour method cuts into rings (4.4).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

enum class Patch : std::uint8_t { kBetween, kOrigin, kInsertion };

struct AttachmentPatches {
  std::vector<Patch> of;          // by vertex
  std::uint32_t left_out = 0;     // attached vertices of smaller patches: they count as between
  std::uint32_t filled = 0;       // vertices that were not attached but ringed by a patch
};

// Each attachment gives its largest connected patch, so specks that "all within 2 mm of the bone" leaves do no harm.
// Errors, at the muscle's name: an end without attached vertices; several heads, that is, attachments of one end whose
// patches do not touch; patches that leave nothing between them.
Result<AttachmentPatches> find_attachment_patches(const SurfaceAsset& surface);

}  // namespace fascicle::muscle
