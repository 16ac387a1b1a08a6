#include "modules/muscle/content/scene_file.hpp"

#include <numbers>

namespace fascicle::muscle {

namespace {

constexpr double kMaxPosition = 1e6;  // m
constexpr double kMaxAngle = 1e3;     // rad

void read_animation(const JsonNode& node, SceneCharacterEntry& entry, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  entry.clip = read_name(object, "clip", false);
  entry.motion = read_name(object, "motion", false);
  object.optional("speed", entry.values.animation.speed, between(-100, 100));
  object.optional("phase", entry.values.animation.phase, between(0, 1));
  if (entry.clip.given() && entry.motion.given()) {
    entry.motion.node.error(context.diagnostics, "the animation names both a clip and a motion",
                            "give one: a clip of the character's glTF file, or a motion file for a joint skeleton");
  }
  std::size_t loop = 0;
  if (object.optional_choice("loop", loop, {"cycle", "record"})) entry.whole_record = loop == 1;
  entry.loop = object.optional("loop");
  if (entry.loop.exists() && entry.clip.given()) {
    entry.loop.error(context.diagnostics, "'loop' says nothing of a clip, which is always played whole",
                     "leave it out, or name a \"motion\"");
  }
  finish_object(object, "animation", context);
}

SceneCharacterEntry read_character(const JsonNode& node, const ReadContext& context) {
  SceneCharacterEntry entry;
  entry.node = node;
  JsonObject object(node, context.diagnostics);
  entry.file = read_name(object, "file", true);
  object.optional("position", entry.values.position, between(-kMaxPosition, kMaxPosition));
  object.optional("heading", entry.values.heading, between(-kMaxAngle, kMaxAngle));
  object.optional("in_place", entry.values.in_place);
  if (const JsonNode animation = object.optional("animation"); animation.exists()) {
    read_animation(animation, entry, context);
  }
  finish_object(object, "scene_character", context);
  return entry;
}

void read_camera(const JsonNode& node, SceneCamera& camera, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  object.optional("target", camera.target, between(-kMaxPosition, kMaxPosition));
  object.optional("distance", camera.distance, NumberRange{.min = 0, .max = kMaxPosition, .above_min = true});
  object.optional("yaw", camera.yaw, between(-kMaxAngle, kMaxAngle));
  object.optional("pitch", camera.pitch, between(-std::numbers::pi / 2, std::numbers::pi / 2));
  object.optional("fov", camera.field_of_view, between(0.01, 3.0));
  finish_object(object, "camera", context);
}

}  // namespace

SceneFile read_scene_file(const JsonNode& root, const ReadContext& context) {
  SceneFile file;
  file.root = root;
  JsonObject object(root, context.diagnostics);
  std::string schema;
  object.optional("$schema", schema);
  object.require("version");  // its value is migrate's business
  file.values.name = read_name(object, "name", true).text;
  file.requires_data = object.optional("requires_data");
  if (file.requires_data.exists()) file.requires_data.read(file.values.requires_data, context.diagnostics);
  object.optional("step_hz", file.values.step_hz, between(1, 10000));
  object.optional("frames", file.values.frames, between(1, 1e8));
  for (const JsonNode node : object.require_array("characters", 0, 100000)) {
    file.characters.push_back(read_character(node, context));
  }
  if (const JsonNode node = object.optional("camera"); node.exists()) {
    read_camera(node, file.values.camera, context);
  }
  finish_object(object, "scene", context);
  return file;
}

}  // namespace fascicle::muscle
