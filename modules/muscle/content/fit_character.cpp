#include "modules/muscle/content/fit_character.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "engine/animation/skeleton.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "engine/math/state_hash.hpp"
#include "modules/muscle/asset/fit/choose_levels.hpp"
#include "modules/muscle/asset/muscle_levels.hpp"
#include "modules/muscle/content/attachment_areas.hpp"

namespace fascicle::muscle {
namespace {

// Raised when a change of the fit makes stored ones worse than new ones.
constexpr std::uint32_t kFitVersion = 1;

class CharacterFitter {
 public:
  CharacterFitter(std::span<const ResolvedMuscle> muscles, const CharacterAsset& asset, const FitSettings& settings,
                  Diagnostics& diagnostics)
      : muscles_(muscles), asset_(asset), settings_(settings), diagnostics_(diagnostics), fits_(muscles.size()),
        inputs_(muscles.size()) {
    options_.supersampling = settings.supersampling;
    for (std::size_t i = 0; i < muscles.size(); ++i) prepare(i);
    for (std::size_t i = 0; i < muscles.size(); ++i) fits_[i].inputs = hash_inputs(i);
  }

  std::vector<MuscleFits> run(const FitStore& store) {
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < muscles_.size(); ++i) {
      const auto stored = store.find(muscles_[i].description.name);
      if (inputs_[i].mesh == nullptr) {
        set_levels(i, {muscles_[i].description.section_vertices, muscles_[i].description.longitudinal_subdivision});
      } else if (stored != store.end() && stored->second.inputs == fits_[i].inputs) {
        fits_[i] = stored->second;
      } else {
        missing.push_back(i);
      }
    }
    if (!missing.empty()) fit_missing(missing);
    for (std::size_t i = 0; i < muscles_.size(); ++i) tell(i);
    return std::move(fits_);
  }

 private:
  void prepare(std::size_t i) {
    FitInput& input = inputs_[i];
    input.description = &muscles_[i].description;
    const auto mesh = asset_.muscle_meshes.find(muscles_[i].description.name);
    if (!settings_.enabled || !muscles_[i].fit || mesh == asset_.muscle_meshes.end()) return;
    input.mesh = mesh->second.get();
    input.areas = find_attachment_areas(muscles_[i], *input.mesh, asset_, diagnostics_);
  }

  std::uint64_t hash_of(const TriangleMesh& mesh) {
    const auto [known, fresh] = mesh_hashes_.try_emplace(&mesh);
    if (fresh) {
      StateHash hash;
      hash.add(std::span(mesh.positions));
      hash.add(std::span(mesh.indices));
      known->second = hash.value();
    }
    return known->second;
  }

  void add_line(const MuscleDescription& description, StateHash& hash) const {
    for (const AttachmentDescription& attachment : description.attachments) {
      hash.add(attachment.position);
      hash.add(asset_.skeleton->rest_world[static_cast<std::size_t>(attachment.bone)]);
    }
  }

  // Everything that a muscle's levels and their fits depend on.
  std::uint64_t hash_inputs(std::size_t i) {
    const FitInput& input = inputs_[i];
    if (input.mesh == nullptr) return 0;
    StateHash hash;
    hash.add(kFitVersion);
    hash.add(settings_.supersampling);
    hash.add(settings_.coarser_levels);
    hash.add(muscles_[i].max_distance.value_or(0.0f));
    hash.add(input.description->section_vertices);
    hash.add(input.description->longitudinal_subdivision);
    hash.add(hash_of(*input.mesh));
    for (const auto& area : input.areas) {
      hash.add(area.size());
      hash.add(std::span(area));
    }
    add_line(*input.description, hash);
    for (std::size_t other = 0; other < inputs_.size(); ++other) {  // heads of one mesh take part of it each
      if (other != i && inputs_[other].mesh == input.mesh) add_line(*inputs_[other].description, hash);
    }
    return hash.value();
  }

  // The finest level and those that follow from it.
  void set_levels(std::size_t i, MuscleLevel finest) {
    MuscleLevel level = finest;
    for (std::uint32_t k = 0; k <= settings_.coarser_levels; ++k) {
      fits_[i].levels.push_back({level.section_vertices, level.longitudinal_subdivision, {}});
      const MuscleLevel coarser = coarser_level(level);
      if (coarser == level) return;
      level = coarser;
    }
  }

  // Heads of one mesh are fitted together, whichever of them is missing.
  void fit_missing(std::span<const std::size_t> missing) {
    std::vector<std::size_t> group;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const bool wanted = std::ranges::any_of(
          missing, [&](std::size_t m) { return inputs_[m].mesh == inputs_[i].mesh && inputs_[m].mesh != nullptr; });
      if (wanted) group.push_back(i);
    }
    choose(group);
    std::size_t most = 0;
    for (const std::size_t i : group) most = std::max(most, fits_[i].levels.size());
    for (std::size_t level = 0; level < most; ++level) fit_level(group, level);
  }

  void choose(std::span<const std::size_t> group) {
    std::vector<FitInput> bounded;
    std::vector<float> distances;
    std::vector<std::size_t> whose;
    for (const std::size_t i : group) {
      fits_[i].levels.clear();
      if (!muscles_[i].max_distance) {
        set_levels(i, {muscles_[i].description.section_vertices, muscles_[i].description.longitudinal_subdivision});
        continue;
      }
      bounded.push_back(inputs_[i]);
      distances.push_back(*muscles_[i].max_distance);
      whose.push_back(i);
    }
    const std::vector<ChosenLevel> choices =
        choose_levels(bounded, distances, asset_.skeleton->rest_world, options_);
    for (std::size_t k = 0; k < whose.size(); ++k) {
      const ChosenLevel& choice = choices[k];
      set_levels(whose[k], choice.level);
      if (choice.kept) continue;
      Diagnostic warning;
      warning.cause = fmt::format("no level of detail keeps within {:.3g} mm of the mesh: {} vertices a section and {} "
                                  "bisections leave {:.3g} mm",
                                  1000 * distances[k], choice.level.section_vertices,
                                  choice.level.longitudinal_subdivision, 1000 * choice.distance);
      warning.remedy = "raise \"max_distance_mm\", move the attachments to the mesh's ends, or add via points";
      fits_[whose[k]].levels.front().fitted.diagnostics.warnings.push_back(std::move(warning));
    }
  }

  void fit_level(std::span<const std::size_t> group, std::size_t level) {
    std::vector<MuscleDescription> descriptions;
    descriptions.reserve(group.size());
    std::vector<FitInput> inputs;
    for (const std::size_t i : group) {
      const FittedLevel& wanted = fits_[i].levels[std::min(level, fits_[i].levels.size() - 1)];
      descriptions.push_back(muscles_[i].description);
      descriptions.back().section_vertices = wanted.section_vertices;
      descriptions.back().longitudinal_subdivision = wanted.longitudinal_subdivision;
      inputs.push_back(inputs_[i]);
      inputs.back().description = &descriptions.back();
    }
    std::vector<FittedMuscle> fitted = fit_muscles(inputs, asset_.skeleton->rest_world, options_);
    for (std::size_t k = 0; k < group.size(); ++k) {
      MuscleFits& fits = fits_[group[k]];
      if (level >= fits.levels.size()) continue;
      Diagnostics& told = fits.levels[level].fitted.diagnostics;
      std::vector<Diagnostic> before = std::move(told.warnings);
      fits.levels[level].fitted = std::move(fitted[k]);
      told.warnings.insert(told.warnings.begin(), before.begin(), before.end());
    }
  }

  // The warnings at the muscle's mesh; what each level says alike is said once (drop_repetitions).
  void tell(std::size_t i) {
    for (const FittedLevel& level : fits_[i].levels) {
      for (const Diagnostic& warning : level.fitted.diagnostics.warnings) {
        muscles_[i].mesh.node.warning(diagnostics_, fmt::format("{}: {}", muscles_[i].description.name, warning.cause),
                                      warning.remedy);
      }
    }
  }

  std::span<const ResolvedMuscle> muscles_;
  const CharacterAsset& asset_;
  const FitSettings& settings_;
  Diagnostics& diagnostics_;
  FitOptions options_;
  std::vector<MuscleFits> fits_;
  std::vector<FitInput> inputs_;
  std::map<const TriangleMesh*, std::uint64_t> mesh_hashes_;  // looked up only
};

}  // namespace

std::vector<MuscleFits> fit_character(std::span<const ResolvedMuscle> muscles, const CharacterAsset& asset,
                                      const FitStore& store, const FitSettings& settings, Diagnostics& diagnostics) {
  return CharacterFitter(muscles, asset, settings, diagnostics).run(store);
}

}  // namespace fascicle::muscle
