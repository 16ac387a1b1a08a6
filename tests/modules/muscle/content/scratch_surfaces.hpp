// A small character with surface muscles for tests, and its meshes: a ball of 200 mm beside the middle plane, whose top
// is held by the trunk and whose foot rests on the shin's block; the other side is its image.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "tests/modules/muscle/content/scratch_content.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::test {

inline constexpr std::string_view kLimb = R"({
  "version": 1, "name": "limb",
  "skeleton": { "joints": {
    "bodies": [{ "name": "trunk" }, { "name": "shin_r" }, { "name": "shin_l" }],
    "coordinates": [],
    "joints": [
      { "name": "root", "parent": "ground", "child": "trunk" },
      { "name": "knee_r", "parent": "trunk", "child": "shin_r", "parent_frame": { "translation": [0, -0.2, 0.15] } },
      { "name": "knee_l", "parent": "trunk", "child": "shin_l", "parent_frame": { "translation": [0, -0.2, -0.15] } }] } },
  "bone_meshes": [
    { "bone": "shin_r", "file": "block.obj", "unit": "mm", "space": "character" }],
  "mirror": { "axis": "x", "bones": [["_r", "_l"]], "names": [["_r", "_l"]] },
  "muscles": [
    { "name": "calf_r", "mirror": true, "pcsa": 0.005, "optimal_fibre_length": 0.05,
      "origin": { "bone": "trunk", "position": [0, 0.09, 0.15] },
      "insertion": { "bone": "shin_r", "position": [0, 0.11, 0] } }],
  "surface_muscles": [
    {
      "name": "ball_r",
      "mesh": { "file": "ball.obj", "unit": "mm" },
      "attachments": [
        { "end": "origin", "bone": "trunk", "beyond": { "normal": [0, 2, 0], "at": 90 } },
        { "end": "insertion", "bone": "shin_r", "within_mm": 4 }],
      "fibres": [{ "points": [[-150, -100, 0], [-150, 0, 90], [-150, 100, 0]] }],
      "settings": { "substeps": 4, "contact_distance_mm": 2 },
      "bones": ["shin_r"],
      "driver": "calf_r"
    }]
}
)";

// Poles up and down the y axis; 20 rings and 24 segments; mm.
inline TriangleMesh make_ball() {
  const glm::mat4 upright = glm::rotate(glm::mat4(1.0f), -1.5707963f, {1.0f, 0.0f, 0.0f});
  return moved(make_sphere(100.0f, 20, 24), glm::translate(glm::mat4(1.0f), {-150.0f, 0.0f, 0.0f}) * upright);
}

inline std::filesystem::path write_limb(const ScratchFolder& folder, std::string_view text = kLimb) {
  folder.write("ball.obj", as_obj(make_ball()));
  folder.write("block.obj", as_obj(make_box({-200.0f, -150.0f, -50.0f}, {-100.0f, -101.0f, 50.0f})));
  return folder.write("limb.character.json", text);
}

}  // namespace fascicle::test
