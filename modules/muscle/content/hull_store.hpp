// Coarse hulls kept beside a character file, so that loading need not make them again: NAME.hulls.json next to
// NAME.character.json, written by `fascicle-cook hull --store`. Each muscle's entry carries a hash of what its hull was
// made from; an entry whose hash is another is out of date and not used. The file may be lost or broken at no harm:
// hulls are then made at load.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/hull/progressive_hull.hpp"

namespace fascicle::muscle {

struct StoredHull {
  std::uint64_t inputs = 0;  // hull_inputs() of what it was made from
  ProgressiveHull hull;
};

using HullStore = std::map<std::string, StoredHull>;  // by the muscle's name

// The file that holds the hulls of a character file: the same name with .hulls.json in place of .character.json or
// .json.
std::filesystem::path hull_store_of(const std::filesystem::path& character_file);

// Hash of everything that a hull depends on: the fine mesh (positions and triangles, in the rest space), the target, and
// the way hulls are made.
std::uint64_t hull_inputs(const TriangleMesh& mesh, const HullTarget& target);

// Errors: not JSON, another version, a field missing or wrong, triangles of vertices that are not there, a hull that is
// not as it was written.
Result<HullStore> parse_hull_store(std::string text, std::string file_name);
Result<HullStore> read_hull_store(const std::filesystem::path& file);

// Numbers are written so that they come back bit for bit.
std::string write_hull_store(const HullStore& store);

}  // namespace fascicle::muscle
