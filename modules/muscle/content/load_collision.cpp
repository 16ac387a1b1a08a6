#include "modules/muscle/content/load_parts.hpp"

#include <map>
#include <string_view>

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/content/collision_file.hpp"
#include "modules/muscle/content/migrate.hpp"
#include "modules/muscle/content/mirror.hpp"

namespace fascicle::muscle {

MirrorMap make_mirror_map(const MirrorRule& rule, const CharacterAsset& asset) {
  if (!rule.given()) return {};
  MirrorMap map;
  map.axis = rule.axis;
  std::map<std::string_view, std::int32_t> known;
  for (std::size_t i = 0; i < asset.descriptions.size(); ++i) {
    known.emplace(asset.descriptions[i].name, static_cast<std::int32_t>(i));
  }
  for (std::size_t i = 0; i < asset.descriptions.size(); ++i) {
    const auto image = mirror_name(asset.descriptions[i].name, rule.names);
    const auto found = image ? known.find(*image) : known.end();
    map.muscles.push_back(!image ? static_cast<std::int32_t>(i) : found == known.end() ? -1 : found->second);
  }
  for (std::size_t i = 0; i < asset.skeleton->size(); ++i) {
    const auto image = mirror_name(asset.skeleton->names[i], rule.bones);
    map.bones.push_back(image ? asset.skeleton->find(*image) : static_cast<std::int32_t>(i));
  }
  return map;
}

ResolvedCollision load_collision(const CharacterFile& file, const std::filesystem::path& base, const MirrorRule& mirror,
                                 const MuscleNames& names, ContentSources& sources, const CharacterAsset& asset,
                                 Diagnostics& diagnostics) {
  if (!file.collision.given()) return {};
  const auto path = sources.resolve(file.collision.text, base, file.collision.node, diagnostics);
  if (!path) return {};
  Result<JsonDocument> document = read_content_file(*path, ContentKind::kCollision);
  const bool readable = document.ok();
  Diagnostics found = std::move(document.diagnostics());
  ResolvedCollision collision;
  if (readable) {
    const CollisionFile entries = read_collision_file(document->root(), {found});
    if (asset.skeleton) {
      const CollisionScope scope{*asset.skeleton, asset.descriptions, names, file.bone_meshes, mirror};
      collision = resolve_collision(entries, scope, found);
    }
  }
  diagnostics.append(std::move(found));
  return collision;
}

}  // namespace fascicle::muscle
