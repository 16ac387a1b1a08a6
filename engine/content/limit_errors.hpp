// Lists of errors that end: enough to mend a file by. What a hostile file has beyond a limit is counted, not described.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/content/result.hpp"

namespace fascicle {

// Whether `list` has room for one more below `limit`. Where it has none, counts the one that is left out in a last
// entry of the list, "N more are left out", made for `file`. Cheap, so that a caller can ask before it describes an
// error.
bool has_room(std::vector<Diagnostic>& list, std::size_t limit, const std::string& file);

// How many errors `list` tells of, with those that were left out.
std::size_t count_with_left_out(const std::vector<Diagnostic>& list);

}  // namespace fascicle
