// Any bytes as a collision file: parse, migrate, read, resolve against a small character, mirror; and the changes that
// saving makes to its text. Whatever is accepted must be in range, and saving twice must change nothing.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/content/json_reader.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/content/edit_collision.hpp"
#include "modules/muscle/content/migrate.hpp"
#include "modules/muscle/content/resolve_collision.hpp"

namespace {

using namespace fascicle;
using namespace fascicle::muscle;

void require(bool condition) {
  if (!condition) std::abort();
}

// Two legs of one bone each, with a mesh, a muscle on each and one more on the right.
struct Character {
  Skeleton skeleton;
  std::vector<MuscleDescription> muscles;
  MuscleNames names;
  std::vector<BoneMeshEntry> bone_meshes;
  JsonDocument rule_text = *parse_json("{}", "rule");
  MirrorRule mirror;
  std::shared_ptr<const MuscleAsset> asset;

  Character() {
    for (const char* side : {"_r", "_l"}) {
      const float x = side[1] == 'r' ? -0.1f : 0.1f;
      skeleton.names.push_back(std::string("leg") + side);
      skeleton.parents.push_back(-1);
      skeleton.rest_local.push_back({});
      skeleton.rest_world.push_back(glm::translate(glm::mat4(1.0f), {x, 1.0f, 0.0f}));
      BoneMeshEntry mesh;
      mesh.bone.text = skeleton.names.back();
      bone_meshes.push_back(mesh);
      for (const char* name : {"a", "b"}) {
        if (x > 0.0f && name[0] == 'b') continue;
        MuscleDescription muscle;
        muscle.name = std::string(name) + side;
        const auto bone = static_cast<std::int32_t>(skeleton.names.size()) - 1;
        const float z = name[0] == 'a' ? 0.0f : 0.03f;
        muscle.attachments = {{bone, {0.0f, -0.1f, z}}, {bone, {0.0f, -0.25f, z + 0.02f}}, {bone, {0.0f, -0.4f, z}}};
        muscle.profile = {{0.0f, 1.0f}, {0.01f, 0.01f}, true};
        names.emplace(muscle.name, "here:1");
        muscles.push_back(std::move(muscle));
      }
    }
    mirror.node = rule_text.root();
    mirror.bones = mirror.names = {{"_r", "_l"}};
    asset = *build_muscle_asset(muscles, skeleton.rest_world);
  }
};

void check_place(const SectionTag& tag, const Character& character) {
  require(tag.muscle < character.muscles.size());
  require(tag.fraction > 0.0f && tag.fraction < 1.0f && tag.angle >= 0.0f && tag.angle < 6.2832f);
}

void check(const CollisionDescription& found, const Character& character) {
  const auto bones = static_cast<std::int32_t>(character.skeleton.size());
  for (const TransversalTag& tag : found.transversals) {
    check_place(tag.first, character);
    require(tag.bone < bones);
    if (tag.bone < 0) check_place(tag.second, character);
    require(tag.bone >= 0 ? tag.yields == Yields::kFirst : tag.first.muscle != tag.second.muscle);
  }
  for (const BoneTag& tag : found.bone_tags) {
    require(tag.muscle < character.muscles.size() && tag.from < tag.to && !tag.bones.empty());
    for (const std::int32_t bone : tag.bones) require(bone >= 0 && bone < bones);
  }
  for (const IgnoredPair& pair : found.ignored) {
    require(pair.muscle < character.muscles.size() && pair.other < character.muscles.size() && pair.bone < bones);
  }
  require(found.settings.substeps >= 1 && found.settings.iterations >= 1);
  require(std::isfinite(found.settings.shape_time) && found.settings.bone_voxel > 0.0f);
}

void check_edits(const JsonDocument& document, const Character& character) {
  TransversalTag tag;
  tag.first = {0, 0.5f, 1.0f};
  tag.second = {1, 0.25f, 4.0f};
  tag.automatic = true;
  const std::vector<std::string> entries{write_entry(tag, {character.muscles, character.skeleton}, false)};
  const Result<JsonDocument> once = parse_json(replace_automatic(document, "transversals", entries), "once");
  require(once.ok());
  require(replace_automatic(*once, "transversals", entries) == once->text());
  require(parse_json(append_entries(document, "stay_out", entries), "appended").ok());
  if (!document.root().member("collision").exists()) {
    require(parse_json(name_collision_file(document, "a.json"), "named").ok());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Character character;
  const Result<JsonDocument> parsed = parse_json(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
  if (!parsed || !parsed->root().is_object()) return 0;
  check_edits(*parsed, character);
  const Result<JsonDocument> document = migrate(*parsed, ContentKind::kCollision);
  if (!document) return 0;
  Diagnostics diagnostics;
  const CollisionFile file = read_collision_file(document->root(), {diagnostics});
  const CollisionScope scope{character.skeleton, character.muscles, character.names, character.bone_meshes,
                             character.mirror};
  ResolvedCollision resolved = resolve_collision(file, scope, diagnostics);
  check(resolved.description, character);
  place_images(*character.asset, character.mirror.axis, resolved);
  check(resolved.description, character);
  return 0;
}
