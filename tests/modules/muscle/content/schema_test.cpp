// The JSON schemas and the loader must know the same fields: the schemas are what authors see, the loader what counts.

#include <map>
#include <set>

#include <gmock/gmock.h>

#include "engine/content/json_reader.hpp"
#include "modules/muscle/content/character_file.hpp"
#include "modules/muscle/content/collision_file.hpp"
#include "modules/muscle/content/migrate.hpp"
#include "modules/muscle/content/scene_file.hpp"

namespace fascicle::muscle {
namespace {

using testing::HasSubstr;

JsonDocument read_schema(const std::string& name) {
  auto read = read_json_file(std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "schema" / name);
  EXPECT_TRUE(read.ok()) << to_text(read.diagnostics());
  return *read;
}

// Kind of object -> its schema: the root under `root_kind`, the others in /definitions.
std::map<std::string, JsonNode> object_schemas(const JsonDocument& schema, const std::string& root_kind) {
  std::map<std::string, JsonNode> objects{{root_kind, schema.root()}};
  for (const JsonNode definition : schema.root().member("definitions")) {
    if (definition.member("properties").exists()) objects.emplace(definition.key(), definition);
  }
  return objects;
}

FieldLog fields_of(const std::map<std::string, JsonNode>& schemas) {
  FieldLog fields;
  for (const auto& [kind, schema] : schemas) {
    for (const JsonNode property : schema.member("properties")) fields[kind].emplace(property.key());
  }
  return fields;
}

// A file with one object of each kind, all empty, so that the readers ask for everything.
constexpr std::string_view kEmptyCharacter = R"({ "skeleton": {}, "skin": {}, "bone_meshes": [{}], "muscle_meshes": {},
  "mirror": {}, "level": {}, "fit": {}, "muscles": [{ "origin": { "area": {} }, "via": [{}], "insertion": {},
  "profile": {}, "tendon": {}, "mesh": {} }],
  "surface_muscles": [{ "mesh": {}, "attachments": [{ "near": {} }, { "beyond": {} }], "fibres": [{}],
  "inner_fibres": {}, "settings": {}, "levels": [{}], "hull": {}, "action_line": [{}, {}] }] })";
constexpr std::string_view kEmptyCollision =
    R"({ "settings": {}, "transversals": [{ "first": {}, "second": {} }], "stay_out": [{}], "ignore": [{}] })";
constexpr std::string_view kEmptyScene = R"({ "characters": [{ "animation": {} }], "camera": {} })";

const std::map<std::string, std::string> kKindOfPath = {
    {"", ""}, {"/skeleton", "skeleton"}, {"/skin", "skin"}, {"/bone_meshes/0", "bone_mesh"},
    {"/muscle_meshes", "muscle_meshes"}, {"/mirror", "mirror"}, {"/level", "level"}, {"/muscles/0", "muscle"},
    {"/muscles/0/origin", "attachment"}, {"/muscles/0/insertion", "attachment"}, {"/muscles/0/via/0", "via"},
    {"/muscles/0/origin/area", "area"}, {"/muscles/0/mesh", "mesh"}, {"/fit", "fit"},
    {"/muscles/0/profile", "profile"}, {"/muscles/0/tendon", "tendon"}, {"/characters/0", "scene_character"},
    {"/characters/0/animation", "animation"}, {"/camera", "camera"}, {"/settings", "settings"}, {"/transversals/0", "transversal"},
    {"/transversals/0/first", "place"}, {"/transversals/0/second", "partner"}, {"/stay_out/0", "stay_out"},
    {"/ignore/0", "ignore"}, {"/surface_muscles/0", "surface_muscle"}, {"/surface_muscles/0/mesh", "mesh"},
    {"/surface_muscles/0/attachments/0", "surface_attachment"},
    {"/surface_muscles/0/attachments/1", "surface_attachment"},
    {"/surface_muscles/0/attachments/0/near", "near"}, {"/surface_muscles/0/attachments/1/beyond", "plane"},
    {"/surface_muscles/0/fibres/0", "fibres"}, {"/surface_muscles/0/inner_fibres", "inner_fibres"},
    {"/surface_muscles/0/settings", "surface_settings"}, {"/surface_muscles/0/levels/0", "surface_level"},
    {"/surface_muscles/0/hull", "hull"}, {"/surface_muscles/0/action_line/0", "line_point"},
    {"/surface_muscles/0/action_line/1", "line_point"}};

struct Known {
  FieldLog fields;
  FieldLog required;  // from what the readers miss in the empty file
};

Known ask_readers(std::string_view text, const std::string& root_kind) {
  Known known;
  Diagnostics diagnostics;
  const JsonDocument document = *parse_json(std::string(text), "empty");
  const ReadContext context{diagnostics, &known.fields};
  if (root_kind == "scene") {
    read_scene_file(document.root(), context);
  } else if (root_kind == "collision") {
    read_collision_file(document.root(), context);
  } else {
    read_character_file(document.root(), context);
  }
  for (const Diagnostic& error : diagnostics.errors) {
    const std::size_t end = error.cause.find("' is missing");
    if (end == std::string::npos) continue;
    std::string kind = kKindOfPath.at(error.path);
    if (kind.empty()) kind = root_kind;
    known.required[kind].insert(error.cause.substr(1, end - 1));
  }
  return known;
}

// `skeleton` and `origin` are in the empty files, but required all the same.
FieldLog required_of(const std::map<std::string, JsonNode>& schemas, const std::set<std::string>& present) {
  FieldLog required;
  for (const auto& [kind, schema] : schemas) {
    for (const JsonNode name : schema.member("required")) {
      std::string text;
      Diagnostics ignored;
      name.read(text, ignored);
      if (!present.contains(text)) required[kind].insert(text);
    }
  }
  return required;
}

TEST(Schema, CharacterAndLoaderKnowTheSameFields) {
  const JsonDocument schema = read_schema("character.schema.json");
  const auto schemas = object_schemas(schema, "character");
  const Known known = ask_readers(kEmptyCharacter, "character");
  EXPECT_EQ(fields_of(schemas), known.fields);
  // "mesh" is required of a surface muscle only, and in the empty file.
  EXPECT_EQ(required_of(schemas, {"skeleton", "origin", "insertion", "mesh"}), known.required);
}

TEST(Schema, SceneAndLoaderKnowTheSameFields) {
  const JsonDocument schema = read_schema("scene.schema.json");
  const auto schemas = object_schemas(schema, "scene");
  const Known known = ask_readers(kEmptyScene, "scene");
  EXPECT_EQ(fields_of(schemas), known.fields);
  EXPECT_EQ(required_of(schemas, {"characters"}), known.required);
}

TEST(Schema, CollisionAndLoaderKnowTheSameFields) {
  const JsonDocument schema = read_schema("collision.schema.json");
  const auto schemas = object_schemas(schema, "collision");
  const Known known = ask_readers(kEmptyCollision, "collision");
  EXPECT_EQ(fields_of(schemas), known.fields);
  EXPECT_EQ(required_of(schemas, {"first", "second"}), known.required);
}

// Every field has a description, every number one with its unit in brackets; unknown fields are refused.
void expect_documented(const JsonDocument& schema, const std::string& root_kind) {
  for (const auto& [kind, object] : object_schemas(schema, root_kind)) {
    EXPECT_TRUE(object.member("additionalProperties").exists()) << kind;
    for (JsonNode property : object.member("properties")) {
      const std::string name = kind + "." + std::string(property.key());
      std::string description, type, reference;
      Diagnostics ignored;
      property.member("$ref").read(reference, ignored);
      constexpr std::string_view kLocal = "#/definitions/";
      JsonNode target = property;
      if (reference.starts_with(kLocal)) {
        target = schema.root().member("definitions").member(reference.substr(kLocal.size()));
      }
      if (!property.member("description").read(description, ignored)) {
        target.member("description").read(description, ignored);
      }
      EXPECT_FALSE(description.empty() && reference != "#/definitions/pairs") << name << " has no description";
      target.member("type").read(type, ignored);
      if (type == "number" || reference == "#/definitions/vector" || reference == "#/definitions/position") {
        EXPECT_THAT(description, HasSubstr("(")) << name << " has no unit";
      }
    }
  }
}

TEST(Schema, EveryFieldIsDocumented) {
  expect_documented(read_schema("character.schema.json"), "character");
  expect_documented(read_schema("scene.schema.json"), "scene");
  expect_documented(read_schema("collision.schema.json"), "collision");
}

TEST(Schema, HasTheLoadersVersion) {
  for (const char* name : {"character.schema.json", "scene.schema.json", "collision.schema.json"}) {
    const JsonDocument schema = read_schema(name);
    std::int32_t version = 0;
    Diagnostics diagnostics;
    ASSERT_TRUE(schema.root().member("properties").member("version").member("const").read(version, diagnostics));
    EXPECT_EQ(version, kContentVersion) << name;
  }
}

}  // namespace
}  // namespace fascicle::muscle
