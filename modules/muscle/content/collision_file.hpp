// A collision file as it is written (content/schema/collision.schema.json): every field checked by itself, nothing
// looked up yet. It stands beside the character file that names it, so that a tool can write it and the character file
// stays its author's. Version 1 of the format.
#pragma once

#include <optional>
#include <vector>

#include "engine/content/json_reader.hpp"
#include "modules/muscle/asset/collision/collision_description.hpp"
#include "modules/muscle/content/character_file.hpp"
#include "modules/muscle/content/field_log.hpp"

namespace fascicle::muscle {

// Whether an entry also stands for the other side. Not given: where the character has the other side.
struct MirrorEntry {
  JsonNode node;
  std::optional<bool> wanted;
};

// A place on a muscle, or for a constraint's second end a bone.
struct PlaceEntry {
  JsonNode node;
  NameEntry muscle, bone;
  float at = 0.0f;     // of the arc length
  float angle = 0.0f;  // rad, 0..2 pi
};

struct TransversalEntry {
  JsonNode node;
  PlaceEntry first, second;
  JsonNode yields_node;  // missing where it was not given
  Yields yields = Yields::kBoth;
  bool sweeps = false, automatic = false;
  MirrorEntry mirror;
  bool sound = false;  // read without an error
};

struct StayOutEntry {
  JsonNode node;
  NameEntry muscle;
  float from = 0.0f, to = 1.0f;
  std::vector<NameEntry> bones;
  bool automatic = false;
  MirrorEntry mirror;
  bool sound = false;
};

struct IgnoredEntry {
  JsonNode node;
  NameEntry muscle, other, bone;  // one of the last two
  MirrorEntry mirror;
  bool sound = false;
};

struct CollisionFile {
  JsonNode root;
  CollisionSettings settings;
  std::vector<TransversalEntry> transversals;
  std::vector<StayOutEntry> stay_out;
  std::vector<IgnoredEntry> ignored;
};

// Reads what it can and appends all errors. The document must outlive the answer.
CollisionFile read_collision_file(const JsonNode& root, const ReadContext& context);

}  // namespace fascicle::muscle
