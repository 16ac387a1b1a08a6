#include "tools/fascicle_cook/surface_checks.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "tools/fascicle_cook/surface_poses.hpp"

namespace fascicle::cook {
namespace {

using Figure = std::function<double(const SurfaceStepFigures&)>;

constexpr std::uint64_t kFlexed = kFlexedStep, kRested = 300;

double off_one(double ratio) { return std::abs(ratio - 1.0); }

class Checker {
 public:
  Checker(const SurfaceMuscleRun& run, bool keeps_volume) : run_(run) {
    for (std::size_t i = 0; i < run.steps.size() && void_from_ == 0; ++i) {
      const SurfaceStepFigures& step = run.steps[i];
      if (!(step.bone_depth_max <= kVoidDepth)) why_ = "it is deep in a bone";
      if (!(step.attachment_error_max <= kVoidAttachment)) why_ = "it does not follow its bones";
      if (keeps_volume && !(off_one(step.volume_ratio) <= kVoidVolume)) why_ = "its volume is lost";
      if (!why_.empty()) void_from_ = i + 1;
    }
  }

  // Of the figure's largest value over all steps.
  void at_every_step(const std::string& what, double limit, const char* unit, const Figure& figure) {
    SurfaceCheck check = make(what + " at every step", limit, unit);
    check.reached = !run_.steps.empty();
    check.found = std::numeric_limits<double>::lowest();
    for (std::size_t i = 0; i < run_.steps.size(); ++i) {
      const double found = figure(run_.steps[i]);
      if (found <= check.found) continue;
      check.found = found;
      check.step = i + 1;
      if (!std::isfinite(found)) break;
    }
    decide(std::move(check), limit, run_.steps.size());
  }

  void at_step(std::uint64_t step, const std::string& what, double limit, const char* unit, const Figure& figure) {
    SurfaceCheck check = make(fmt::format("{} at step {}", what, step), limit, unit);
    check.reached = run_.steps.size() >= step;
    check.step = step;
    if (check.reached) check.found = figure(run_.steps[step - 1]);
    decide(std::move(check), limit, step);
  }

  void attached_vertices(std::size_t count) {
    SurfaceCheck check;
    check.what = "vertices attached at the insertion";
    check.limit = fmt::format("{}", count);
    check.found = static_cast<double>(run_.attached_at_insertion);
    check.passed = run_.attached_at_insertion == count;
    checks_.push_back(std::move(check));
  }

  // Of the whole run; `reached`: there was something to look at.
  void in_all(const std::string& what, double limit, double found, std::uint64_t step, bool reached) {
    SurfaceCheck check = make(what, limit, "");
    check.found = found;
    check.step = step;
    check.reached = reached;
    decide(std::move(check), limit, run_.steps.size());
  }

  std::vector<SurfaceCheck> finish() { return std::move(checks_); }

 private:
  static SurfaceCheck make(const std::string& what, double limit, const char* unit) {
    SurfaceCheck check;
    check.what = what;
    check.limit = fmt::format("<= {}{}", limit, unit);
    return check;
  }

  // `last`: the step up to which the run must not be void.
  void decide(SurfaceCheck check, double limit, std::uint64_t last) {
    check.passed = check.reached && check.found <= limit;
    if (check.passed && void_from_ != 0 && void_from_ <= last) {
      check.passed = false;
      check.why = fmt::format("void: {} at step {}", why_, void_from_);
    }
    checks_.push_back(std::move(check));
  }

  const SurfaceMuscleRun& run_;
  std::uint64_t void_from_ = 0;  // 0: the run is not void
  std::string why_;
  std::vector<SurfaceCheck> checks_;
};

void check_fibres_inside(Checker& checker, const SurfaceMuscleRun& run) {
  if (run.fibre_rest.empty()) return;
  checker.at_every_step("points of fibres outside of the muscle", 0.0, "", [](const auto& s) {
    return s.fibres_outside;
  });
}

void check_fibres(Checker& checker, const SurfaceMuscleRun& run) {
  check_fibres_inside(checker, run);
  if (run.fibre_rest.empty()) return;
  checker.at_step(kRested, "worst fibre |length ratio - 1|", 0.005, "", [](const SurfaceStepFigures& s) {
    return std::max(off_one(s.fibre_min), off_one(s.fibre_max));
  });
}

bool any_posed(const SurfaceMuscleRun& run) {
  return std::any_of(run.steps.begin(), run.steps.end(), [](const auto& s) { return s.posed != 0.0; });
}

// Steps that the hull did not make pass.
void check_posed(Checker& checker, const SurfaceMuscleRun& run, const SurfaceMuscleRun* smooth) {
  checker.at_every_step("|volume ratio - 1| of a pose", 0.001, "", [](const SurfaceStepFigures& s) {
    return s.posed != 0.0 ? off_one(s.volume_ratio) : 0.0;
  });
  checker.at_every_step("iterations of a pose", kMostIterations, "", [](const auto& s) { return s.iterations; });
  checker.at_every_step("poses that did not converge (1)", 0.0, "", [](const auto& s) { return 1.0 - s.converged; });
  const Repeats iterated = compare_iterated(run);
  checker.in_all(fmt::format("{} poses iterated further: shapes apart, of the size", iterated.count), kIteratedTolerance,
                 iterated.largest, iterated.step, iterated.count > 0);
  const Repeats repeats = compare_repeats(run);
  checker.in_all(fmt::format("{} poses taken again: shapes apart, of the size", repeats.count), kRepeatTolerance,
                 repeats.largest, repeats.step, repeats.count > 0);
  if (smooth == nullptr) return;
  const std::vector<PosePair> pairs = pair_poses(run, *smooth);
  double worst = 0.0;
  std::uint64_t step = 0;
  for (const PosePair& pair : pairs) {
    const double ratio = bend_ratio(run, *smooth, pair);
    if (std::isnan(worst) || (step != 0 && ratio <= worst)) continue;
    worst = ratio;
    step = pair.step;
  }
  checker.in_all(fmt::format("{} poses beside dynamics': mean dihedral change to theirs", pairs.size()), kMostBend, worst,
                 step, !pairs.empty());
}

}  // namespace

std::vector<SurfaceCheck> check_surface(const std::string& scene, const SurfaceMuscleRun& run,
                                        const SurfaceMuscleRun* smooth) {
  const auto is = [&](const char* name) { return scene.find(name) != std::string::npos; };
  const auto mean = [](const SurfaceStepFigures& s) { return s.edge_abs_mean; };
  const auto most = [](const SurfaceStepFigures& s) { return s.edge_max; };
  const auto bent = [](const SurfaceStepFigures& s) { return s.dihedral_mean; };
  const auto turned = [](const SurfaceStepFigures& s) { return s.turned; };
  const auto volume = [](const SurfaceStepFigures& s) { return off_one(s.volume_ratio); };
  Checker checker(run, !is("box"));
  checker.at_every_step("fallbacks so far", 0.0, "", [](const auto& s) { return s.fallbacks; });
  checker.at_every_step("deepest point in a bone", 0.5, " mm", [](const auto& s) { return s.bone_depth_max; });
  if (!run.asset->attached.empty()) {
    checker.at_every_step("attachment error", 0.1, " mm", [](const auto& s) { return s.attachment_error_max; });
  }
  if (is("box")) {
    // The gap leaves no room for the box's volume.
    checker.at_step(kRested, "|volume ratio - 1|", 0.005, "", volume);
    checker.at_step(kRested, "|mean edge ratio - 1|", 0.005, "", [](const auto& s) { return off_one(s.edge_mean); });
    checker.at_step(kRested, "largest edge ratio", 1.3, "", most);
    checker.at_step(kRested, "mean dihedral change", 0.01, " rad", bent);
    check_fibres(checker, run);
    return checker.finish();
  }
  checker.at_every_step("|volume ratio - 1|", 0.005, "", volume);
  if (any_posed(run)) {
    check_posed(checker, run, smooth);
    check_fibres_inside(checker, run);
    return checker.finish();
  }
  if (is("gluteus")) {
    checker.attached_vertices(269);
    checker.at_step(kFlexed, "largest edge ratio", 3.0, "", most);
    checker.at_step(kFlexed, "edges turned inside out", 0.0, "", turned);
    checker.at_step(kRested, "mean |edge ratio - 1|", 0.01, "", mean);
    checker.at_step(kRested, "largest edge ratio", 1.5, "", most);
    checker.at_step(kRested, "mean dihedral change", 0.02, " rad", bent);
  }
  if (is("iliacus")) {
    checker.attached_vertices(267);
    checker.at_step(kRested, "furthest vertex from rest", 2.0, " mm",
                    [](const auto& s) { return s.rest_distance_max; });
  }
  check_fibres(checker, run);
  return checker.finish();
}

bool all_passed(const std::vector<SurfaceCheck>& checks) {
  return std::all_of(checks.begin(), checks.end(), [](const SurfaceCheck& check) { return check.passed; });
}

}  // namespace fascicle::cook
