// A scene file as it is written, each field checked by itself; see character_file.hpp for the idea.
#pragma once

#include <string>
#include <vector>

#include "engine/content/json_reader.hpp"
#include "modules/muscle/content/character_file.hpp"
#include "modules/muscle/content/field_log.hpp"
#include "modules/muscle/content/scene_asset.hpp"

namespace fascicle::muscle {

struct SceneCharacterEntry {
  JsonNode node;
  NameEntry file;
  SceneCharacter values;  // placement and animation figures; what it names is looked up later
  NameEntry clip;
  NameEntry motion;
  JsonNode loop;                 // how the motion repeats, where it was given
  bool whole_record = false;     // else its best cycle
};

struct SceneFile {
  JsonNode root;
  JsonNode requires_data;
  SceneAsset values;      // everything but the characters
  std::vector<SceneCharacterEntry> characters;
};

// Reads what it can and appends all errors. The document must outlive the answer.
SceneFile read_scene_file(const JsonNode& root, const ReadContext& context);

}  // namespace fascicle::muscle
