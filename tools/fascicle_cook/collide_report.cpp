#include "tools/fascicle_cook/collide_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/animation/skeleton.hpp"
#include "engine/content/quote_json.hpp"

namespace fascicle::cook {
namespace {

using muscle::PairDepth;

std::string name_of(const CollideReport& report, const PairDepth& pair) {
  if (!(pair.depth > 0.0f)) return "-";
  const std::string& other = pair.bone >= 0
                                 ? report.character->skeleton->names[static_cast<std::size_t>(pair.bone)]
                                 : report.asset->muscles[pair.other].name;
  return report.asset->muscles[pair.muscle].name + " in " + other;
}

double mm(float metres) { return 1e3 * static_cast<double>(metres); }

// A run's figures: each the largest over the frames that count, with its frame where it has a place.
struct Figures {
  CollideFrame bone, muscle, area;
  muscle::DepthsBeyond beyond;
};

Figures worst_of(const CollideRun& run, std::uint64_t first) {
  Figures worst;
  for (const CollideFrame& frame : run.frames) {
    if (frame.frame < first) continue;
    if (frame.bone.depth > worst.bone.bone.depth) worst.bone = frame;
    if (frame.muscle.depth > worst.muscle.muscle.depth) worst.muscle = frame;
    if (frame.area.relative > worst.area.area.relative) worst.area = frame;
    muscle::DepthsBeyond& most = worst.beyond;
    most.bone = std::max(most.bone, frame.beyond.bone);
    most.muscle = std::max(most.muscle, frame.beyond.muscle);
    most.bone_pair = std::max(most.bone_pair, frame.beyond.bone_pair);
    most.muscle_pair = std::max(most.muscle_pair, frame.beyond.muscle_pair);
  }
  return worst;
}

std::string row_of(const CollideReport& report, const char* name, const Figures& figures, std::uint64_t fallbacks,
                   std::uint64_t held, double jitter) {
  const auto place = [&](const PairDepth& pair, std::uint64_t frame) {
    return frame == 0 ? name_of(report, pair) : fmt::format("{} ({})", name_of(report, pair), frame);
  };
  return fmt::format(
      "{:<8}{:>7.2f}  {:<36}{:>7.2f}  {:<52}{:>7.2f}{:>8.2f}{:>9.2f}{:>8.2f}{:>8.2f}%{:>7}{:>6}{:>10.5f}\n", name,
      mm(figures.bone.bone.depth), place(figures.bone.bone, figures.bone.frame), mm(figures.muscle.muscle.depth),
      place(figures.muscle.muscle, figures.muscle.frame), mm(figures.beyond.bone), mm(figures.beyond.bone_pair),
      mm(figures.beyond.muscle), mm(figures.beyond.muscle_pair),
      100.0 * static_cast<double>(figures.area.area.relative), fallbacks, held, jitter);
}

Figures rest_figures(const CollideReport& report) {
  Figures rest;
  rest.bone.bone = deepest(report.rest.bones);
  rest.muscle.muscle = deepest(report.rest.muscles);
  return rest;
}

std::string pair_table(const CollideReport& report, const std::vector<CollidePair>& pairs, std::size_t count) {
  std::string text = fmt::format("  {:<54}{:>8}{:>8}{:>8}{:>7}{:>10}{:>9}\n", "pair", "mm", "at rest", "beyond",
                                 "frame", "fraction", "section");
  for (const bool bones : {true, false}) {
    std::size_t listed = 0;
    for (const CollidePair& pair : pairs) {
      if ((pair.deepest.bone >= 0) != bones || listed == count) continue;
      ++listed;
      const std::uint32_t last = report.asset->muscles[pair.deepest.muscle].section_count - 1;
      text += fmt::format("  {:<54}{:>8.2f}{:>8.2f}{:>8.2f}{:>7}{:>10.3f}{:>6.1f}/{}\n", name_of(report, pair.deepest),
                          mm(pair.deepest.depth), mm(pair.rest), mm(pair.deepest.depth - pair.rest), pair.frame,
                          pair.deepest.place / static_cast<float>(last), pair.deepest.place, last);
    }
  }
  return text;
}

// null where it is not finite.
std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null"; }

std::string json_of(const CollideReport& report, const std::string& name, const Figures& figures) {
  return fmt::format(
      "{{\n      \"mode\": {},\n      \"bone_deepest_mm\": {},\n      \"bone_pair\": {},\n      \"bone_frame\": {},\n"
      "      \"muscle_deepest_mm\": {},\n      \"muscle_pair\": {},\n      \"muscle_frame\": {},\n"
      "      \"bone_max_mm\": {},\n      \"bone_pair_max_mm\": {},\n      \"muscle_max_mm\": {},\n"
      "      \"muscle_pair_max_mm\": {},\n      \"section_area_error_max\": {}",
      quote_json(name), number(mm(figures.bone.bone.depth)), quote_json(name_of(report, figures.bone.bone)),
      figures.bone.frame, number(mm(figures.muscle.muscle.depth)), quote_json(name_of(report, figures.muscle.muscle)),
      figures.muscle.frame, number(mm(figures.beyond.bone)), number(mm(figures.beyond.bone_pair)),
      number(mm(figures.beyond.muscle)), number(mm(figures.beyond.muscle_pair)),
      number(static_cast<double>(figures.area.area.relative)));
}

std::uint64_t fallbacks_of(const CollideRun& run) { return run.frames.empty() ? 0 : run.frames.back().fallbacks; }
std::uint64_t held_of(const CollideRun& run) { return run.frames.empty() ? 0 : run.frames.back().held; }

}  // namespace

std::string to_table(const CollideReport& report) {
  std::string text = fmt::format(
      "{}: {} muscles, {} vertices, {} points every {:.0f} mm; {} frames at {:.0f} Hz, counted from frame {}\n\n",
      report.scene, report.asset->size(), report.asset->vertex_count, report.rest.points, mm(muscle::kSampleSpacing),
      report.options.frames, report.step_hz, report.options.first);
  text += fmt::format("{:<8}{:>7}  {:<36}{:>7}  {:<52}{:>7}{:>8}{:>9}{:>8}{:>9}{:>7}{:>6}{:>10}\n", "mm", "bone",
                      "deepest (frame)", "muscle", "deepest (frame)", "bone+", "by pair", "muscle+", "by pair", "area",
                      "fallb.", "held", "jitter");
  text += row_of(report, "rest", rest_figures(report), 0, 0, 0.0);
  for (const CollideRun& run : report.runs) {
    text += row_of(report, to_string(run.mode), worst_of(run, report.options.first), fallbacks_of(run), held_of(run),
                   1e3 * run.jitter_rms);
  }
  for (const CollideRun& run : report.runs) {
    text += fmt::format("\n{}: {} frames measured, {:.3f} ms a step, {:.1f} ms a measure, jitter at most {:.5f} mm",
                        to_string(run.mode), run.frames.size(), run.step_ms, run.measure_ms, 1e3 * run.jitter_largest);
    if (run.unstable > 0) text += fmt::format("; NOT FINITE in {} frames", run.unstable);
    const CollideFrame area = worst_of(run, report.options.first).area;
    if (area.frame > 0) {
      text += fmt::format("; worst area: {} section {} (frame {})", report.asset->muscles[area.area.muscle].name,
                          area.area.section, area.frame);
    }
  }
  return text;
}

std::string to_pair_tables(const CollideReport& report, std::size_t count) {
  std::vector<CollidePair> rest;
  for (const auto* list : {&report.rest.bones, &report.rest.muscles}) {
    for (const PairDepth& pair : *list) rest.push_back({pair, 0, 0.0f});
  }
  std::stable_sort(rest.begin(), rest.end(), [](const CollidePair& a, const CollidePair& b) {
    return a.deepest.depth > b.deepest.depth;
  });
  std::string text = "rest\n" + pair_table(report, rest, count);
  for (const CollideRun& run : report.runs) {
    text += fmt::format("\n{}\n{}", to_string(run.mode), pair_table(report, run.pairs, count));
  }
  return text;
}

std::string to_json(const CollideReport& report) {
  std::string text = fmt::format(
      "{{\n  \"scene\": {},\n  \"muscles\": {},\n  \"frames\": {},\n  \"step_hz\": {},\n  \"runs\": [\n    ",
      quote_json(report.scene), report.asset->size(), report.options.frames, report.step_hz);
  text += json_of(report, "rest", rest_figures(report)) + "\n    }";
  for (const CollideRun& run : report.runs) {
    text += ",\n    " + json_of(report, to_string(run.mode), worst_of(run, report.options.first));
    text += fmt::format(
        ",\n      \"fallbacks\": {},\n      \"held\": {},\n      \"not_finite\": {},\n      \"jitter_rms_mm\": {},\n"
        "      \"jitter_max_mm\": {},\n      \"step_ms\": {}\n    }}",
        fallbacks_of(run), held_of(run), run.unstable, number(1e3 * run.jitter_rms), number(1e3 * run.jitter_largest),
        number(run.step_ms));
  }
  return text + "\n  ]\n}\n";
}

std::string to_csv(const CollideReport& report) {
  std::string text =
      "mode,frame,bone_deepest_mm,bone_pair,muscle_deepest_mm,muscle_pair,bone_max_mm,bone_pair_max_mm,muscle_max_mm,"
      "muscle_pair_max_mm,section_area_error_max,fallbacks,held\n";
  for (const CollideRun& run : report.runs) {
    for (const CollideFrame& f : run.frames) {
      text += fmt::format("{},{},{:.4f},{},{:.4f},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.6f},{},{}\n", to_string(run.mode),
                          f.frame, mm(f.bone.depth), name_of(report, f.bone), mm(f.muscle.depth),
                          name_of(report, f.muscle), mm(f.beyond.bone), mm(f.beyond.bone_pair), mm(f.beyond.muscle),
                          mm(f.beyond.muscle_pair), f.area.relative, f.fallbacks, f.held);
    }
  }
  return text;
}

}  // namespace fascicle::cook
