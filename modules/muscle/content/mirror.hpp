// The other side of the body: a muscle is written once, for one side, and mirrored to the other.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "modules/muscle/content/character_file.hpp"

namespace fascicle::muscle {

// `name` with one part exchanged for its partner. The first pair with a part in the name counts, in either direction;
// a part at the end of the name goes before one at its start, and that before the last one inside:
// with ["_r", "_l"], rect_fem_r becomes rect_fem_l. Empty where no part is in the name: it lies on both sides.
std::optional<std::string> mirror_name(std::string_view name, std::span<const MirrorRule::Pair> pairs);

// Reflection in the plane axis = 0 of the character's rest space (m).
glm::vec3 mirror_point(glm::vec3 point, int axis);

}  // namespace fascicle::muscle
