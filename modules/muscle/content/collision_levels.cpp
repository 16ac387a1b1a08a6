#include "modules/muscle/content/collision_levels.hpp"

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/asset/muscle_levels.hpp"

namespace fascicle::muscle {

void build_collision_levels(CharacterAsset& asset) {
  if (!asset.levels) return;
  for (const std::shared_ptr<const MuscleAsset>& level : asset.levels->assets) {
    asset.collision_levels.push_back(
        build_collision_asset(level, asset.collision, asset.bone_fields, asset.skeleton->rest_world));
  }
}

}  // namespace fascicle::muscle
