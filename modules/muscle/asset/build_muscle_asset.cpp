#include "modules/muscle/asset/build_muscle_asset.hpp"

#include "modules/muscle/asset/check_descriptions.hpp"
#include "modules/muscle/asset/lay_out_muscles.hpp"
#include "modules/muscle/asset/rest_shape.hpp"

namespace fascicle::muscle {

Result<std::shared_ptr<const MuscleAsset>> build_muscle_asset(std::span<const MuscleDescription> descriptions,
                                                              std::span<const glm::mat4> rest_bones,
                                                              std::span<const MuscleFit> fits) {
  Diagnostics found = check_descriptions(descriptions, rest_bones, fits);
  if (!found.ok()) return found;
  const auto asset = std::make_shared<MuscleAsset>();
  lay_out_muscles(descriptions, rest_bones, *asset);
  asset->layouts.assign(asset->muscles.begin(), asset->muscles.end());
  bind_points(descriptions, rest_bones, fits, *asset);
  found.append(shape_rest(descriptions, rest_bones, fits, *asset));
  if (!found.ok()) return found;
  return {std::shared_ptr<const MuscleAsset>(asset), std::move(found)};
}

}  // namespace fascicle::muscle
