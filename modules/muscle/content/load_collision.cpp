#include "modules/muscle/content/load_parts.hpp"

#include "modules/muscle/content/collision_file.hpp"
#include "modules/muscle/content/migrate.hpp"

namespace fascicle::muscle {

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
