#include "tools/fascicle_cook/collide_extremes.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "engine/animation/skeleton.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/components/muscle_collision.hpp"

namespace fascicle::cook {
namespace {

using muscle::PairDepth;
using muscle::Penetration;

constexpr double kRecovers = 0.5;  // s

void keep_worst(const std::vector<PairDepth>& now, const Penetration& rest, float& most, PairDepth& pair) {
  for (const PairDepth& candidate : now) {
    const float more = candidate.depth - depth_of(candidate, rest);
    if (!(more > most)) continue;
    most = more;
    pair = candidate;
  }
}

ExtremeFigures figures_of(const Penetration& now, const Penetration& rest, float area) {
  ExtremeFigures figures;
  figures.beyond = beyond(now, rest);
  figures.area = area;
  figures.finite = now.left_out == 0;
  float bone = 0.0f, other = 0.0f;
  keep_worst(now.bones, rest, bone, figures.bone);
  keep_worst(now.muscles, rest, other, figures.muscle);
  return figures;
}

void add(const ExtremeFigures& now, ExtremeFigures& worst) {
  if (now.beyond.bone_pair > worst.beyond.bone_pair) worst.bone = now.bone;
  if (now.beyond.muscle_pair > worst.beyond.muscle_pair) worst.muscle = now.muscle;
  for (const auto figure : {&muscle::DepthsBeyond::bone, &muscle::DepthsBeyond::muscle,
                            &muscle::DepthsBeyond::bone_pair, &muscle::DepthsBeyond::muscle_pair}) {
    worst.beyond.*figure = std::max(worst.beyond.*figure, now.beyond.*figure);
  }
  worst.area = std::max(worst.area, now.area);
  worst.finite = worst.finite && now.finite;
}

double mm(float metres) { return 1e3 * static_cast<double>(metres); }

std::string text_of(const ExtremesReport& report, const ExtremeFigures& figures) {
  const auto name = [&](const PairDepth& pair) {
    if (!(pair.depth > 0.0f)) return std::string("-");
    const auto& names = report.subject.scene->characters.front().character->skeleton->names;
    return report.subject.asset->muscles[pair.muscle].name + " in " +
           (pair.bone >= 0 ? names[static_cast<std::size_t>(pair.bone)]
                           : report.subject.asset->muscles[pair.other].name);
  };
  return fmt::format("{:>7.2f}{:>8.2f} {:<38}{:>7.2f}{:>8.2f} {:<52}{:>7.2f}%", mm(figures.beyond.bone),
                     mm(figures.beyond.bone_pair), name(figures.bone), mm(figures.beyond.muscle),
                     mm(figures.beyond.muscle_pair), name(figures.muscle), 100.0 * static_cast<double>(figures.area));
}

}  // namespace

ExtremeRun run_extreme(const CollideSubject& subject, const CollideScenario& scenario, CollideMode mode,
                       const ExtremeOptions& options) {
  game::Simulation simulation(subject.scene, {.workers = options.workers, .skin_meshes = false});
  set_mode(simulation, mode);
  ExtremeRun run;
  run.name = scenario.name;
  run.mode = mode;
  std::vector<float> areas;
  const auto measure = [&] {
    const Penetration now = measure_now(simulation, *subject.meter);
    return figures_of(now, subject.rest, measure_areas_now(simulation, areas).relative);
  };
  for (std::uint64_t i = 0; i < options.before; ++i) simulation.step();
  for (std::uint64_t i = 0; i < scenario.steps; ++i) {
    scenario.play(simulation, i);
    if ((i + 1) % options.every == 0 || i + 1 == scenario.steps) add(measure(), run.during);
  }
  for (std::uint64_t i = 1; i <= options.after; ++i) {
    simulation.step();
    if (i % options.every != 0) continue;
    const double since = static_cast<double>(i) / static_cast<double>(subject.scene->step_hz);
    const ExtremeFigures now = measure();
    if (!now.within_bounds()) run.recovery = since;
    if (since >= kRecovers) add(now, run.after);
  }
  const ecs::Entity musculature = simulation.characters().front().musculature;
  const auto* collision = simulation.world().try_get<muscle::MuscleCollision>(musculature);
  run.fallbacks = collision == nullptr ? 0 : collision->fallbacks;
  run.held = simulation.held_steps();
  return run;
}

ExtremesReport run_extremes(const muscle::SceneAsset& scene, const std::vector<CollideMode>& modes,
                            const ExtremeOptions& options, const std::string& only) {
  ExtremesReport report;
  parallel::WorkerArena workers(options.workers);
  workers.execute([&] {
    report.subject = prepare_subject(scene, {.level = {}, .workers = options.workers, .spacing = options.spacing});
    for (const CollideScenario& scenario : collide_scenarios(*report.subject.scene->characters.front().character)) {
      if (scenario.name.find(only) == std::string::npos) continue;
      for (const CollideMode mode : modes) {
        if (report.subject.has(mode)) report.runs.push_back(run_extreme(report.subject, scenario, mode, options));
      }
    }
  });
  return report;
}

std::string to_table(const ExtremesReport& report) {
  const std::string figures = fmt::format("{:>7}{:>8} {:<38}{:>7}{:>8} {:<52}{:>8}", "bone+", "by pair", "",
                                          "muscle+", "by pair", "", "area");
  std::string text = fmt::format("{:<41}{:<9}{:<8}{}{:>9}{:>7}\n", "mm", "", "", figures, "recovery", "fallb.");
  for (const ExtremeRun& run : report.runs) {
    for (const bool during : {true, false}) {
      const ExtremeFigures& shown = during ? run.during : run.after;
      text += fmt::format("{:<41}{:<9}{:<8}{}", during ? run.name : "", during ? to_string(run.mode) : "",
                          during ? "during" : "after", text_of(report, shown));
      text += during ? "\n" : fmt::format("{:>7.2f} s{:>7}", run.recovery, run.fallbacks);
      if (!during) text += run.after.finite && run.during.finite ? "\n" : "  NOT FINITE\n";
    }
  }
  return text;
}

}  // namespace fascicle::cook
