#include "modules/muscle/asset/fit/choose_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>

#include "engine/parallel/for_range.hpp"
#include "modules/muscle/asset/fit/check_mesh.hpp"
#include "modules/muscle/asset/fit/compare_fit.hpp"

namespace fascicle::muscle {
namespace {

constexpr std::array<std::uint32_t, 9> kSectionVertices{6, 8, 10, 12, 16, 20, 24, 30, 36};
constexpr std::uint32_t kMostSubdivision = 5;
constexpr std::uint32_t kHopeless = 4;  // LSS by LSS: what cannot be fitted at so many of them cannot at any
constexpr float kAsGood = 1.05f;
constexpr int kMostCorrections = 6;

// Segments count alike for all muscles: what decides is |C| 2^LSS.
std::uint32_t cost_of(const MuscleLevel& level) { return level.section_vertices << level.longitudinal_subdivision; }

// One input's search. It takes for granted that at one LSS a greater |C| is never worse, so that of each LSS the
// greatest |C| says whether any will do: where that does, it goes down to the least that does, then to the next LSS,
// with such |C| alone as have fewer vertices than the best so far. 15 levels at most of the 54, else.
class Search {
 public:
  explicit Search(float bound) : bound_(bound) {}

  MuscleLevel next() const { return {kSectionVertices[count_], subdivision_}; }
  bool done() const { return done_; }
  // Nothing: no level could be fitted.
  const std::optional<ChosenLevel>& choice() const { return choice_; }

  // What next() leaves, m; nothing: it cannot be fitted.
  void answer(std::optional<float> distance) {
    tried_.push_back({next(), distance});
    take(distance);
    // Levels that are known already need no fit.
    while (!done_) {
      const auto known = std::ranges::find(tried_, next(), &Tried::level);
      if (known == tried_.end()) return;
      take(known->distance);
    }
  }

 private:
  struct Tried {
    MuscleLevel level;
    std::optional<float> distance;
  };

  void take(std::optional<float> distance) {
    if (distance && *distance <= bound_) {
      choice_ = ChosenLevel{next(), *distance, kept_};
      if (count_ > 0) --count_;
      else finish();  // fewer vertices there are at no higher LSS
      return;
    }
    const bool any = std::ranges::any_of(tried_, [](const Tried& one) { return one.distance.has_value(); });
    if (subdivision_ == kMostSubdivision || (!any && subdivision_ + 1 == kHopeless)) return finish();
    ++subdivision_;
    while (choice_ && cost_of(next()) >= cost_of(choice_->level)) {
      if (count_ == 0) return finish();
      --count_;
    }
  }

  // Where no level keeps the bound, the one with the fewest vertices that comes near the best: more do not help.
  void finish() {
    float best = std::numeric_limits<float>::infinity();
    for (const Tried& one : tried_) best = std::min(best, one.distance.value_or(best));
    done_ = choice_ || !kept_ || !std::isfinite(best);
    if (done_) return;
    kept_ = false;
    bound_ = kAsGood * best;
    count_ = kSectionVertices.size() - 1;
    subdivision_ = 0;
  }

  float bound_;  // m
  bool kept_ = true, done_ = false;
  std::size_t count_ = kSectionVertices.size() - 1;
  std::uint32_t subdivision_ = 0;
  std::vector<Tried> tried_;
  std::optional<ChosenLevel> choice_;
};

class Chooser {
 public:
  Chooser(std::span<const FitInput> inputs, std::span<const float> max_distances,
          std::span<const glm::mat4> rest_bones, const FitOptions& options)
      : inputs_(inputs), max_distances_(max_distances), rest_bones_(rest_bones), options_(options) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const MuscleDescription& description = *inputs[i].description;
      searches_.emplace_back(max_distances[i]);
      choices_.push_back({{description.section_vertices, description.longitudinal_subdivision}, 0.0f, true});
      if (inputs[i].mesh != nullptr) add_to_group(static_cast<std::uint32_t>(i));
    }
    parallel::for_range(groups_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g) {
        Group& group = groups_[g];
        group.checked = check_mesh(*group.mesh);
        group.oracle = std::make_unique<const MeshOracle>(group.checked.mended.value_or(*group.mesh));
      }
    });
  }

  std::vector<ChosenLevel> run() {
    while (advance([this](const Group& group) { return is_open(group); },
                   [this](std::uint32_t i, std::optional<float> distance) { note(i, distance); })) {
    }
    // Heads were judged beside others whose levels have changed since.
    for (int round = 0; round < kMostCorrections; ++round) {
      if (!advance([](const Group& group) { return group.changed; },
                   [this, round](std::uint32_t i, std::optional<float> distance) {
                     correct(i, distance, round + 1 < kMostCorrections);
                   })) {
        break;
      }
    }
    return choices_;
  }

 private:
  // The heads of one mesh.
  struct Group {
    const TriangleMesh* mesh = nullptr;
    std::vector<std::uint32_t> heads{};
    CheckedMesh checked{};
    std::unique_ptr<const MeshOracle> oracle{};
    bool changed = false;  // since the heads were judged together
  };

  bool is_open(const Group& group) const {
    return std::ranges::any_of(group.heads, [&](std::uint32_t i) { return !searches_[i].done(); });
  }

  void add_to_group(std::uint32_t i) {
    const auto known = std::ranges::find(groups_, inputs_[i].mesh, &Group::mesh);
    if (known == groups_.end()) return groups_.push_back({.mesh = inputs_[i].mesh, .heads = {i}});
    known->heads.push_back(i);
    known->changed = true;
  }

  MuscleLevel level_of(std::uint32_t i) const {
    return searches_[i].done() ? choices_[i].level : searches_[i].next();
  }

  // Fits the groups that are wanted, every open search at its next level, and tells what each head leaves. Heads of one
  // mesh must be fitted together: those that are done take part with what was chosen for them. False: none was wanted.
  template <class Wanted, class Tell>
  bool advance(const Wanted& wanted, const Tell& tell) {
    std::vector<Group*> judged;
    std::vector<std::size_t> first;
    std::vector<MuscleDescription> descriptions;
    std::vector<FitInput> inputs;
    for (Group& group : groups_) {
      if (!wanted(group)) continue;
      judged.push_back(&group);
      first.push_back(inputs.size());
      for (const std::uint32_t i : group.heads) {
        const MuscleLevel level = level_of(i);
        descriptions.push_back(*inputs_[i].description);
        descriptions.back().section_vertices = level.section_vertices;
        descriptions.back().longitudinal_subdivision = level.longitudinal_subdivision;
        inputs.push_back(inputs_[i]);
        inputs.back().checked = &group.checked;
      }
    }
    for (std::size_t k = 0; k < inputs.size(); ++k) inputs[k].description = &descriptions[k];
    const std::vector<FittedMuscle> fitted = fit_muscles(inputs, rest_bones_, options_);
    parallel::for_range(judged.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g) {
        const std::size_t count = judged[g]->heads.size();
        judged[g]->changed = judged[g]->changed && is_open(*judged[g]);
        const std::vector<std::optional<float>> distances =
            measure(*judged[g], std::span(descriptions).subspan(first[g], count),
                    std::span(fitted).subspan(first[g], count));
        for (std::size_t h = 0; h < count; ++h) tell(judged[g]->heads[h], distances[h]);
      }
    });
    return !judged.empty();
  }

  // By head; nothing: it cannot be fitted, or not be built with its fit.
  std::vector<std::optional<float>> measure(const Group& group, std::span<const MuscleDescription> descriptions,
                                            std::span<const FittedMuscle> fitted) const {
    const auto build = [&](std::span<const std::uint32_t> heads) {
      std::vector<MuscleDescription> chosen;
      std::vector<MuscleFit> fits;
      for (const std::uint32_t h : heads) {
        chosen.push_back(descriptions[h]);
        fits.push_back(fitted[h].fit);
      }
      return build_muscle_asset(chosen, rest_bones_, fits);
    };
    std::vector<std::uint32_t> whose;
    for (std::uint32_t h = 0; h < fitted.size(); ++h) {
      if (!fitted[h].fit.radii.empty()) whose.push_back(h);
    }
    std::vector<std::optional<float>> distances(fitted.size());
    auto built = build(whose);
    if (!built.ok()) {
      std::erase_if(whose, [&](std::uint32_t h) { return !build({&h, 1}).ok(); });
      built = build(whose);
    }
    if (whose.empty() || !built.ok()) return distances;
    std::vector<std::uint32_t> muscles(whose.size());
    std::iota(muscles.begin(), muscles.end(), 0u);
    const std::vector<FitComparison> comparisons = compare_heads(**built, muscles, *group.oracle);
    for (std::size_t k = 0; k < whose.size(); ++k) distances[whose[k]] = static_cast<float>(comparisons[k].max());
    return distances;
  }

  void note(std::uint32_t i, std::optional<float> distance) {
    if (searches_[i].done()) return;
    searches_[i].answer(distance);
    if (searches_[i].done() && searches_[i].choice()) choices_[i] = *searches_[i].choice();
  }

  // Of heads whose levels were chosen: what they leave together. One that no longer keeps its bound gets another
  // bisection, or where there is none left more vertices, and its mesh's heads are judged once more.
  void correct(std::uint32_t i, std::optional<float> distance, bool may_change) {
    ChosenLevel& choice = choices_[i];
    if (!searches_[i].choice() || !distance) return;
    const bool kept_before = choice.kept;
    choice.distance = *distance;
    choice.kept = *distance <= max_distances_[i];
    if (choice.kept || !kept_before || !may_change) return;
    MuscleLevel& level = choice.level;
    const auto more = std::ranges::upper_bound(kSectionVertices, level.section_vertices);
    if (level.longitudinal_subdivision < kMostSubdivision) ++level.longitudinal_subdivision;
    else if (more != kSectionVertices.end()) level.section_vertices = *more;
    else return;
    choice.kept = true;  // until it is judged
    std::ranges::find(groups_, inputs_[i].mesh, &Group::mesh)->changed = true;
  }

  std::span<const FitInput> inputs_;
  std::span<const float> max_distances_;
  std::span<const glm::mat4> rest_bones_;
  FitOptions options_;
  std::vector<Search> searches_;
  std::vector<ChosenLevel> choices_;
  std::vector<Group> groups_;
};

}  // namespace

std::vector<ChosenLevel> choose_levels(std::span<const FitInput> inputs, std::span<const float> max_distances,
                                       std::span<const glm::mat4> rest_bones, const FitOptions& options) {
  return Chooser(inputs, max_distances, rest_bones, options).run();
}

}  // namespace fascicle::muscle
