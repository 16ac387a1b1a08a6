// The fibres of a surface muscle, from a file of lines or written out, as lines in the rest space.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "modules/muscle/asset/surface/surface_description.hpp"
#include "modules/muscle/content/character_file.hpp"
#include "modules/muscle/content/content_sources.hpp"

namespace fascicle::muscle {

// `rest` is the muscle's closed mesh in the rest space. Lines of a file that go on where the one before ends become one
// fibre: many tools write each segment as a line of its own. Errors: a file that is no .vtk of lines, fibres that stay
// further than kFibreReach from the muscle.
std::vector<FibreLine> load_fibres(std::span<const FibresEntry> entries, const SurfaceMuscleEntry& muscle,
                                   const CharacterFile& file, const std::filesystem::path& base,
                                   const TriangleMesh& rest, ContentSources& sources, Diagnostics& diagnostics);

}  // namespace fascicle::muscle
