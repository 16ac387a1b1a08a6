#include "modules/muscle/asset/fit/choose_levels.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <tuple>

#include "engine/geometry/clean_mesh.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/asset/fit/compare_fit.hpp"

namespace fascicle::muscle {
namespace {

constexpr std::array<std::uint32_t, 9> kSectionVertices{6, 8, 10, 12, 16, 20, 24, 30, 36};
constexpr std::uint32_t kMostSubdivision = 5;
constexpr float kAsGood = 1.05f;

// All levels, those with fewer vertices first. Segments count alike for all muscles: what decides is |C| 2^LSS.
std::vector<MuscleLevel> list_candidates() {
  std::vector<MuscleLevel> levels;
  for (const std::uint32_t count : kSectionVertices) {
    for (std::uint32_t subdivision = 0; subdivision <= kMostSubdivision; ++subdivision) {
      levels.push_back({count, subdivision});
    }
  }
  std::ranges::sort(levels, {}, [](const MuscleLevel& level) {
    return std::tuple(level.section_vertices << level.longitudinal_subdivision, level.section_vertices);
  });
  return levels;
}

// One input's search: candidate after candidate until one keeps the bound.
struct Search {
  std::size_t candidate = 0;
  std::vector<ChosenLevel> tried;  // in order: those with fewer vertices first
  ChosenLevel choice;              // once done
  bool done = false;
};

// Where no level keeps the bound: more vertices than these do not help.
ChosenLevel choose_nearest(const std::vector<ChosenLevel>& tried) {
  float best = tried.front().distance;
  for (const ChosenLevel& one : tried) best = std::min(best, one.distance);
  return *std::ranges::find_if(tried, [&](const ChosenLevel& one) { return one.distance <= kAsGood * best; });
}

class Chooser {
 public:
  Chooser(std::span<const FitInput> inputs, std::span<const float> max_distances,
          std::span<const glm::mat4> rest_bones, const FitOptions& options)
      : inputs_(inputs), max_distances_(max_distances), rest_bones_(rest_bones), options_(options),
        searches_(inputs.size()) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const MuscleDescription& description = *inputs[i].description;
      searches_[i].choice = {{description.section_vertices, description.longitudinal_subdivision}, 0.0f, true};
      searches_[i].done = inputs[i].mesh == nullptr;
      if (!searches_[i].done) add_to_group(static_cast<std::uint32_t>(i));
    }
    parallel::for_range(groups_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g) {
        groups_[g].oracle = std::make_unique<const MeshOracle>(clean_mesh(*groups_[g].mesh).mesh);
      }
    });
  }

  std::vector<ChosenLevel> run() {
    while (std::ranges::any_of(groups_, [this](const Group& group) { return is_open(group); })) advance();
    std::vector<ChosenLevel> choices;
    for (const Search& search : searches_) choices.push_back(search.choice);
    return choices;
  }

 private:
  // The heads of one mesh.
  struct Group {
    const TriangleMesh* mesh = nullptr;
    std::vector<std::uint32_t> heads;
    std::unique_ptr<const MeshOracle> oracle;
  };

  bool is_open(const Group& group) const {
    return std::ranges::any_of(group.heads, [&](std::uint32_t i) { return !searches_[i].done; });
  }

  void add_to_group(std::uint32_t i) {
    const auto known = std::ranges::find(groups_, inputs_[i].mesh, &Group::mesh);
    if (known != groups_.end()) known->heads.push_back(i);
    else groups_.push_back({inputs_[i].mesh, {i}, nullptr});
  }

  // Every open search tries its next candidate. Heads of one mesh must be fitted together: those that are done take
  // part with what was chosen for them.
  void advance() {
    std::vector<MuscleDescription> descriptions;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const Search& search = searches_[i];
      const MuscleLevel level = search.done ? search.choice.level : candidates_[search.candidate];
      descriptions.push_back(*inputs_[i].description);
      descriptions.back().section_vertices = level.section_vertices;
      descriptions.back().longitudinal_subdivision = level.longitudinal_subdivision;
    }
    std::vector<FitInput> inputs(inputs_.begin(), inputs_.end());
    for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i].description = &descriptions[i];
    for (const Group& group : groups_) {
      if (is_open(group)) continue;
      for (const std::uint32_t i : group.heads) inputs[i].mesh = nullptr;
    }
    const std::vector<FittedMuscle> fitted = fit_muscles(inputs, rest_bones_, options_);
    std::vector<MuscleFit> fits;
    for (const FittedMuscle& muscle : fitted) fits.push_back(muscle.fit);
    const auto built = build_muscle_asset(descriptions, rest_bones_, fits);
    parallel::for_range(groups_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g) {
        if (is_open(groups_[g])) judge(groups_[g], fits, built.ok() ? built->get() : nullptr);
      }
    });
  }

  void judge(const Group& group, std::span<const MuscleFit> fits, const MuscleAsset* asset) {
    std::vector<std::uint32_t> fitted;
    for (const std::uint32_t i : group.heads) {
      if (asset != nullptr && !fits[i].radii.empty()) fitted.push_back(i);
      else give_up(searches_[i]);
    }
    if (fitted.empty()) return;
    const std::vector<FitComparison> comparisons = compare_heads(*asset, fitted, *group.oracle);
    for (std::size_t k = 0; k < fitted.size(); ++k) {
      if (!searches_[fitted[k]].done) judge(fitted[k], static_cast<float>(comparisons[k].max()));
    }
  }

  // What cannot be fitted at the first level cannot at any.
  void give_up(Search& search) const {
    if (search.done) return;
    if (search.tried.empty()) search.done = true;
    else next(search);
  }

  void judge(std::size_t i, float distance) {
    Search& search = searches_[i];
    search.tried.push_back({candidates_[search.candidate], distance, distance <= max_distances_[i]});
    if (search.tried.back().kept) {
      search.choice = search.tried.back();
      search.done = true;
    } else {
      next(search);
    }
  }

  void next(Search& search) const {
    if (++search.candidate < candidates_.size()) return;
    search.choice = choose_nearest(search.tried);
    search.done = true;
  }

  std::span<const FitInput> inputs_;
  std::span<const float> max_distances_;
  std::span<const glm::mat4> rest_bones_;
  FitOptions options_;
  std::vector<MuscleLevel> candidates_ = list_candidates();
  std::vector<Search> searches_;
  std::vector<Group> groups_;
};

}  // namespace

std::vector<ChosenLevel> choose_levels(std::span<const FitInput> inputs, std::span<const float> max_distances,
                                       std::span<const glm::mat4> rest_bones, const FitOptions& options) {
  return Chooser(inputs, max_distances, rest_bones, options).run();
}

}  // namespace fascicle::muscle
