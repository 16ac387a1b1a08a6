// A scene: which characters stand where, what they play, where the camera looks from, for how long. Immutable.
// `load_scene` reads NAME.scene.json (content/schema/scene.schema.json) and its characters, each file once.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/result.hpp"
#include "modules/muscle/content/character_asset.hpp"

namespace fascicle {
struct Motion;
}

namespace fascicle::muscle {

// What a character plays: a clip of its glTF file, or an OpenSim motion on its joint skeleton. Neither: it stands at
// rest.
struct AnimationChoice {
  std::shared_ptr<const Clip> clip;
  std::shared_ptr<const Motion> motion;
  float speed = 1.0f;  // times the recorded speed
  float phase = 0.0f;  // fraction of the length at which it starts, 0..1
};

struct SceneCharacter {
  std::shared_ptr<const CharacterAsset> character;
  glm::vec3 position{0.0f};  // m
  float heading = 0.0f;      // rad about y; 0 faces +z
  AnimationChoice animation;
  bool in_place = false;     // the root's travel is left out, so that it walks on the spot
};

// An orbit camera.
struct SceneCamera {
  glm::vec3 target{0.0f, 0.7f, 0.0f};  // m
  float distance = 2.6f;               // m
  float yaw = 0.6f;                    // rad about y; 0 looks along -z, at a character's front
  float pitch = 0.1f;                  // rad, positive looks down
  float field_of_view = 0.7f;          // rad, vertical
};

struct SceneAsset {
  std::string name;
  bool requires_data = false;          // it needs the data folder
  float step_hz = 60.0f;               // simulation steps a second
  int frames = 300;                    // length of a headless run
  std::vector<SceneCharacter> characters;
  SceneCamera camera;
  std::vector<std::filesystem::path> files;  // everything that was read, the scene file first, each once
  std::filesystem::file_time_type load_started;  // edits after this are not in here
};

Result<std::shared_ptr<const SceneAsset>> load_scene(const std::filesystem::path& file,
                                                     const LoadOptions& options = {});

// True where a load failed because the scene or one of its files needs the data folder and there is none: a program
// then says so and exits with status 3 instead of 1.
bool lacks_data(const Diagnostics& diagnostics);

}  // namespace fascicle::muscle
