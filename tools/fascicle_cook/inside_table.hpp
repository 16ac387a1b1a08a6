// The article's table 4: how many section centres the rays alone leave outside of the meshes.
#pragma once

#include <string>

#include "engine/content/result.hpp"
#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::cook {

// Six lines "CSS n: a b c d | e f g h": for rays of CSS = n times |C| the count of centres a_k outside, by winding
// number, for |C| = 6, 8, 10, 12 at LSS 1, then at LSS 2. As in the article the ends stay where the fit moved them, and
// nothing but the rays of 2.2 looks for the inside. Errors: the character has no muscle with a mesh.
Result<std::string> make_inside_table(const muscle::CharacterAsset& character);

}  // namespace fascicle::cook
