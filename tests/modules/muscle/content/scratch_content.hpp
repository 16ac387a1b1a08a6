// Content files for tests: a folder that goes away, and small sound files to break.
#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "engine/content/result.hpp"

namespace fascicle::test {

class ScratchFolder {
 public:
  ScratchFolder() {
    std::random_device random;
    path_ = std::filesystem::temp_directory_path() / ("fascicle_content_" + std::to_string(random()));
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(std::string_view name, std::string_view text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

 private:
  std::filesystem::path path_;
};

// `text` with the one place of `from` changed to `to`.
inline std::string with(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "the text lacks " << from;
  if (at == std::string::npos) return text;
  EXPECT_EQ(text.find(from, at + 1), std::string::npos) << "the text holds more than one " << from;
  return text.replace(at, from.size(), to);
}

// Two legs of joints, standing at rest, and a vastus with a via point on its patella, mirrored. Lines are numbered.
inline constexpr std::string_view kLegs = R"({
  "$schema": "../../schema/character.schema.json",
  "version": 1,
  "name": "legs",
  "skeleton": { "joints": {
    "bodies": [{ "name": "pelvis" },
      { "name": "femur_r" }, { "name": "tibia_r" }, { "name": "patella_r" }, { "name": "foot_r" },
      { "name": "femur_l" }, { "name": "tibia_l" }, { "name": "patella_l" }, { "name": "foot_l" }],
    "coordinates": [],
    "joints": [
      { "name": "root", "parent": "ground", "child": "pelvis", "parent_frame": { "translation": [0, 1, 0] } },
      { "name": "hip_r", "parent": "pelvis", "child": "femur_r", "parent_frame": { "translation": [0, -0.1, 0.08] } },
      { "name": "knee_r", "parent": "femur_r", "child": "tibia_r", "parent_frame": { "translation": [0, -0.4, 0] } },
      { "name": "cap_r", "parent": "tibia_r", "child": "patella_r", "parent_frame": { "translation": [0.05, 0.02, 0] } },
      { "name": "ankle_r", "parent": "tibia_r", "child": "foot_r", "parent_frame": { "translation": [0, -0.4, 0] } },
      { "name": "hip_l", "parent": "pelvis", "child": "femur_l", "parent_frame": { "translation": [0, -0.1, -0.08] } },
      { "name": "knee_l", "parent": "femur_l", "child": "tibia_l", "parent_frame": { "translation": [0, -0.4, 0] } },
      { "name": "cap_l", "parent": "tibia_l", "child": "patella_l", "parent_frame": { "translation": [0.05, 0.02, 0] } },
      { "name": "ankle_l", "parent": "tibia_l", "child": "foot_l", "parent_frame": { "translation": [0, -0.4, 0] } }] } },
  "bone_meshes": [{ "bone": "pelvis", "file": "shapes.gltf#block", "scale": [2, 1, 1], "translation": [0, 0.1, 0] }],
  "muscle_meshes": { "file": "shapes.gltf", "bones_space": "character" },
  "mirror": { "axis": "x", "bones": [["_r", "_l"]], "names": [["_r", "_l"]] },
  "attachment_space": "bone",
  "level": { "section_vertices": 8, "longitudinal_subdivision": 1 },
  "specific_tension": 600000,
  "muscles": [
    {
      "name": "vastus_r", "mirror": true,
      "origin": { "bone": "femur_r", "position": [0.03, -0.1, 0.01] },
      "via": [
        { "bone": "femur_r", "position": [0.04, -0.33, 0.01] },
        { "bone": "patella_r", "position": [0.02, 0, 0], "counts": false }
      ],
      "insertion": { "bone": "tibia_r", "position": [0.03, -0.06, 0] },
      "max_isometric_force": 1365, "optimal_fibre_length": 0.087, "tendon_slack_length": 0.136, "pennation": 0.05,
      "profile": { "fractions": [0, 0.4, 1], "radii": [0.3, 1, 0.2], "absolute": false },
      "tendon": { "origin": 0, "insertion": 0.5 },
      "section_vertices": 10, "longitudinal_subdivision": 2,
      "mesh": "vastus_r"
    },
    {
      "name": "soleus_r",
      "origin": { "bone": "tibia_r", "position": [-0.02, -0.1, 0] },
      "insertion": { "bone": "foot_r", "position": [-0.05, 0, 0] },
      "source_length": 0.3, "specific_tension": 500000, "pcsa": 0.005, "volume": 0.0003,
      "optimal_fibre_length": 0.05
    }
  ]
}
)";

// Two tetrahedra with edges of 10 cm, `block` and `vastus_r`, the second at x = -0.1 m; and a clip `nod` that turns
// the first.
inline constexpr std::string_view kShapes = R"({
  "asset": { "version": "2.0" },
  "scene": 0, "scenes": [{ "nodes": [0, 1] }],
  "nodes": [{ "name": "block", "mesh": 0 }, { "name": "vastus_r", "mesh": 1, "translation": [-0.1, 0.5, 0] }],
  "meshes": [{ "name": "a", "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] },
             { "name": "b", "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
  "animations": [{ "name": "nod", "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }],
                   "samplers": [{ "input": 2, "output": 3 }] }],
  "accessors": [
    { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [0.1, 0.1, 0.1] },
    { "bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR" },
    { "bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [0.1] },
    { "bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3" }],
  "bufferViews": [{ "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 24 },
                  { "buffer": 0, "byteOffset": 8, "byteLength": 8 }, { "buffer": 0, "byteLength": 24 }],
  "buffers": [{ "byteLength": 72, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAzczMPQAAAAAAAAAAAAAAAM3MzD0AAAAAAAAAAAAAAADNzMw9AAACAAEAAAABAAMAAAADAAIAAQACAAMA" }]
}
)";

// A character on kShapes, and a scene with both characters.
inline constexpr std::string_view kBlock = R"({
  "version": 1, "name": "block", "skeleton": { "gltf": "shapes.gltf" },
  "skin": { "gltf": "shapes.gltf", "meshes": ["block"] }
}
)";

inline constexpr std::string_view kScene = R"({
  "version": 1,
  "name": "pair",
  "step_hz": 120,
  "frames": 10,
  "characters": [
    { "file": "legs.character.json", "position": [1, 0, 0], "heading": 0.5, "in_place": true },
    { "file": "block.character.json", "animation": { "clip": "nod", "speed": 2, "phase": 0.25 } },
    { "file": "./legs.character.json" }
  ],
  "camera": { "target": [0, 1, 0], "distance": 3, "yaw": 0.1, "pitch": 0.2, "fov": 0.8 }
}
)";

// All of the above in one folder; returns the scene.
inline std::filesystem::path write_pair(const ScratchFolder& folder) {
  folder.write("legs.character.json", kLegs);
  folder.write("block.character.json", kBlock);
  folder.write("shapes.gltf", kShapes);
  return folder.write("pair.scene.json", kScene);
}

// Errors as text without the folder in front, one a line.
inline std::string errors_of(const Diagnostics& diagnostics, const std::filesystem::path& folder) {
  std::string text;
  for (const Diagnostic& error : diagnostics.errors) text += to_string(error) + '\n';
  const std::string prefix = folder.string() + "/";
  for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at)) {
    text.erase(at, prefix.size());
  }
  return text;
}

}  // namespace fascicle::test
