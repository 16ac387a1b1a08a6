#include "modules/muscle/content/build_levels.hpp"

#include <algorithm>

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/asset/muscle_levels.hpp"

namespace fascicle::muscle {
namespace {

using Built = std::shared_ptr<const MuscleAsset>;

const FittedLevel& level_of(const MuscleFits& fits, std::size_t level) {
  return fits.levels[std::min(level, fits.levels.size() - 1)];
}

// A muscle that runs out of levels keeps its last one.
Result<Built> build_level(const CharacterAsset& asset, std::size_t level) {
  std::vector<MuscleDescription> descriptions = asset.descriptions;
  std::vector<MuscleFit> fits;
  for (std::size_t i = 0; i < descriptions.size(); ++i) {
    const FittedLevel& fitted = level_of(asset.fits[i], level);
    descriptions[i].section_vertices = fitted.section_vertices;
    descriptions[i].longitudinal_subdivision = fitted.longitudinal_subdivision;
    fits.push_back(fitted.fitted.fit);
  }
  return build_muscle_asset(descriptions, asset.skeleton->rest_world, fits);
}

void warn_of_missing_levels(const Diagnostics& found, Diagnostics& diagnostics) {
  Diagnostic warning = found.errors.front();
  warning.remedy = "the character has fewer levels; lower \"coarser_levels\" to be spared this warning";
  diagnostics.warnings.push_back(std::move(warning));
}

}  // namespace

void build_levels(std::span<const ResolvedMuscle> muscles, const FitSettings& settings, const FitStore& store,
                  CharacterAsset& asset, Diagnostics& diagnostics) {
  asset.fits = fit_character(muscles, asset, store, settings, diagnostics);
  std::size_t most = 1;
  for (std::size_t i = 0; i < muscles.size(); ++i) {
    most = std::max(most, asset.fits[i].levels.size());
    asset.descriptions[i].section_vertices = asset.fits[i].levels.front().section_vertices;
    asset.descriptions[i].longitudinal_subdivision = asset.fits[i].levels.front().longitudinal_subdivision;
  }
  std::vector<Built> levels;
  for (std::size_t level = 0; level < most; ++level) {
    Result<Built> built = build_level(asset, level);
    if (!built && level > 0) {  // too coarse to have a shape: the finer ones do
      warn_of_missing_levels(built.diagnostics(), diagnostics);
      break;
    }
    diagnostics.append(std::move(built.diagnostics()));
    if (!built) return;
    levels.push_back(*built);
  }
  Result<std::shared_ptr<const MuscleLevels>> chain = make_muscle_levels(levels);
  if (!chain && levels.size() > 1) {  // a muscle that could be fitted at some levels only
    warn_of_missing_levels(chain.diagnostics(), diagnostics);
    levels.resize(1);
    chain = make_muscle_levels(levels);
  }
  diagnostics.append(std::move(chain.diagnostics()));
  if (!chain) return;
  asset.muscles = levels.front();
  asset.levels = *chain;
}

}  // namespace fascicle::muscle
