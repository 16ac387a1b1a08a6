// Changes to collision files and to the character files that name them, made in their text: only what is asked for
// changes, and all else stays as its author wrote it, byte for byte.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/animation/skeleton.hpp"
#include "engine/content/json_reader.hpp"
#include "engine/content/result.hpp"
#include "modules/muscle/asset/collision/collision_description.hpp"
#include "modules/muscle/asset/muscle_description.hpp"

namespace fascicle::muscle {

// The names that entries are written with.
struct CollisionNames {
  std::span<const MuscleDescription> muscles;
  const Skeleton& skeleton;
};

// One entry as JSON, on one line. Without `mirror` it says nothing of the other side.
std::string write_entry(const TransversalTag& tag, const CollisionNames& names, std::optional<bool> mirror);
std::string write_entry(const BoneTag& tag, const CollisionNames& names, std::optional<bool> mirror);

// A place as it comes back from a file: written figures have four decimals, and lie within the reader's limits.
SectionTag as_written(SectionTag tag);

// A collision file without entries.
std::string empty_collision_file();

// The document's text with `entries` at the end of the root's array `list`, made where it is missing.
std::string append_entries(const JsonDocument& document, std::string_view list, std::span<const std::string> entries);

// The same, with the array's elements that have "automatic": true taken out. Twice is as good as once.
std::string replace_automatic(const JsonDocument& document, std::string_view list,
                              std::span<const std::string> entries);

// The text of a character file with "collision": `reference` before its muscles. It must not name one already.
std::string name_collision_file(const JsonDocument& character, std::string_view reference);

}  // namespace fascicle::muscle
