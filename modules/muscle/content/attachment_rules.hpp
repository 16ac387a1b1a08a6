// What a sane action line looks like, judged at rest: checks that need the skeleton. They catch a point given to the
// wrong bone, by name or by place, while every path of real models passes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/content/json_reader.hpp"
#include "modules/muscle/content/character_file.hpp"

namespace fascicle::muscle {

// One point of a muscle with its bone looked up and its place at rest.
struct PlacedAttachment {
  std::int32_t bone = -1;
  glm::vec3 rest{0.0f};  // m, in the character's rest space
  JsonNode node;         // the attachment, to quote
  JsonNode bone_node;
};

// The bones between two bones of the hierarchy, both included, by way of their nearest common ancestor; just the two
// where they have none.
std::vector<std::int32_t> bones_between(const Skeleton& skeleton, std::int32_t from, std::int32_t to);

// Checks one muscle's line:
// - consecutive points must differ (by more than 10 micrometres): a segment of no length has no direction;
// - a via point's bone must lie between the origin's and the insertion's bones, or be next to one that does: the
//   parent of the topmost, or a child that carries no further chain (a patella, a fibula, a twist bone). A bone whose
//   mirror image lies between them, itself not, is the wrong side;
// - in a line with via points no point may be further from the next than the muscle could ever be long: twice the
//   length at which its fibres are stretched to double (l_Ts + 2 l_Fo), brought to the character's size
//   where source_length is given.
// Returns whether all is well.
bool check_attachments(std::span<const PlacedAttachment> line, const MuscleDescription& values,
                       const Skeleton& skeleton, const MirrorRule& mirror, Diagnostics& diagnostics);

}  // namespace fascicle::muscle
