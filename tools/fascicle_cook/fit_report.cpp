#include "tools/fascicle_cook/fit_report.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "engine/content/quote_json.hpp"
#include "tools/fascicle_cook/mesh_groups.hpp"

namespace fascicle::cook {
namespace {

using namespace fascicle::muscle;

constexpr double kMm = 1000.0, kCm3 = 1.0e6;  // in a metre, in a cubic metre

struct OutcomeCounts {
  std::size_t fitted = 0, partial = 0, missed = 0, outside = 0, rescued = 0;
  float moved = 0.0f;  // m, the most
};

OutcomeCounts count_outcomes(const FittedMuscle& muscle) {
  OutcomeCounts counts;
  for (const SectionReport& section : muscle.sections) {
    counts.fitted += section.outcome == SectionOutcome::kFitted ? 1 : 0;
    counts.partial += section.outcome == SectionOutcome::kPartial ? 1 : 0;
    counts.missed += section.outcome == SectionOutcome::kMissed ? 1 : 0;
    counts.outside += section.outcome == SectionOutcome::kOutside ? 1 : 0;
    counts.rescued += section.rescued ? 1 : 0;
    counts.moved = std::max(counts.moved, section.moved);
  }
  return counts;
}

const FittedLevel& finest(const FitReport& report, std::size_t i) {
  return report.character->fits[report.muscles[i]].levels.front();
}

const std::string& name_of_muscle(const FitReport& report, std::size_t i) {
  return report.character->descriptions[report.muscles[i]].name;
}

std::string distance_json(const SurfaceDistance& distance) {
  return fmt::format("{{ \"rms\": {:.6g}, \"mean\": {:.6g}, \"max\": {:.6g} }}", distance.rms, distance.mean,
                     distance.max);
}

void append_muscle_json(const FitReport& report, std::size_t i, std::string& out) {
  const auto to = std::back_inserter(out);
  const FittedLevel& level = finest(report, i);
  const FitComparison& compared = report.comparisons[i];
  const CharacterAsset& character = *report.character;
  const MuscleDescription& description = character.descriptions[report.muscles[i]];
  const bool fitted = !level.fitted.fit.radii.empty();
  fmt::format_to(to,
                 "    {{ \"name\": {}, \"mesh\": {}, \"fitted\": {}, \"section_vertices\": {}, "
                 "\"longitudinal_subdivision\": {},\n      \"vertices\": {}, \"mesh_vertices\": {}, \"volume\": {:.6g}, "
                 "\"mesh_volume\": {:.6g}, \"sections_outside\": {},\n      \"fit_to_mesh\": {}, \"mesh_to_fit\": {},\n"
                 "      \"warnings\": [",
                 quote_json(description.name), quote_json(description.mesh), fitted, level.section_vertices,
                 level.longitudinal_subdivision, compared.fit_vertices, compared.mesh_vertices, compared.fit_volume,
                 compared.mesh_volume, compared.sections_outside, distance_json(compared.fit_to_mesh),
                 distance_json(compared.mesh_to_fit));
  const auto& warnings = level.fitted.diagnostics.warnings;
  for (std::size_t k = 0; k < warnings.size(); ++k) {
    fmt::format_to(to, "{}{}", k == 0 ? "" : ", ", quote_json(warnings[k].cause + "; " + warnings[k].remedy));
  }
  out += "],\n      \"sections\": [";
  append_json(level.fitted.sections, out);
  out += "] }";
}

}  // namespace

FitReport make_fit_report(const CharacterAsset& character, const std::string& only) {
  FitReport report;
  report.character = &character;
  std::vector<MeshGroup> groups = group_by_mesh(character);
  std::erase_if(groups, [&](const MeshGroup& group) {
    const auto wanted = [&](std::uint32_t i) { return only.empty() || character.descriptions[i].name == only; };
    return std::ranges::none_of(group.muscles, wanted);
  });
  std::vector<bool> fitted;
  for (const MuscleFits& fits : character.fits) fitted.push_back(!fits.levels.front().fitted.fit.radii.empty());
  const std::vector<FitComparison> compared = compare_groups(groups, *character.muscles, fitted);
  for (std::uint32_t i = 0; i < character.descriptions.size(); ++i) {
    const std::string& name = character.descriptions[i].name;
    if (!character.muscle_meshes.contains(name) || (!only.empty() && name != only)) continue;
    report.muscles.push_back(i);
    report.comparisons.push_back(compared[i]);
  }
  return report;
}

std::string to_table(const FitReport& report) {
  std::string out = fmt::format(
      "{:<24}{:>5}{:>5}{:>6}{:>9}{:>8}{:>9}{:>8}{:>10}{:>9}{:>9}{:>9}{:>9}{:>10}{:>9}\n", "muscle", "|C|", "LSS", "part.",
      "missed", "outside", "rescued", "moved", "vertices", "of mesh", "rms", "max", "vol.", "of mesh", "");
  FitComparison sum;
  double squares = 0.0;
  std::size_t fitted = 0;
  OutcomeCounts all;
  const auto to = std::back_inserter(out);
  for (std::size_t i = 0; i < report.muscles.size(); ++i) {
    const FittedLevel& level = finest(report, i);
    const FitComparison& compared = report.comparisons[i];
    const OutcomeCounts counts = count_outcomes(level.fitted);
    if (level.fitted.fit.radii.empty()) {
      fmt::format_to(to, "{:<24}{:>5}{:>5}  not fitted\n", name_of_muscle(report, i), level.section_vertices,
                     level.longitudinal_subdivision);
      continue;
    }
    fmt::format_to(to, "{:<24}{:>5}{:>5}{:>6}{:>9}{:>8}{:>9}{:>8.2f}{:>10}{:>9}{:>9.3f}{:>9.3f}{:>9.1f}{:>10.1f}\n",
                   name_of_muscle(report, i), level.section_vertices, level.longitudinal_subdivision, counts.partial,
                   counts.missed, compared.sections_outside, counts.rescued, kMm * double{counts.moved},
                   compared.fit_vertices, compared.mesh_vertices, kMm * compared.rms(), kMm * compared.max(),
                   kCm3 * compared.fit_volume, kCm3 * compared.mesh_volume);
    ++fitted;
    all.partial += counts.partial;
    all.missed += counts.missed;
    all.rescued += counts.rescued;
    all.moved = std::max(all.moved, counts.moved);
    sum.sections_outside += compared.sections_outside;
    sum.fit_vertices += compared.fit_vertices;
    sum.mesh_vertices += compared.mesh_vertices;
    sum.fit_volume += compared.fit_volume;
    sum.mesh_volume += compared.mesh_volume;
    sum.fit_to_mesh.max = std::max(sum.fit_to_mesh.max, compared.max());
    squares += compared.rms() * compared.rms();
  }
  fmt::format_to(to, "{:<24}{:>10}{:>6}{:>9}{:>8}{:>9}{:>8.2f}{:>10}{:>9}{:>9.3f}{:>9.3f}{:>9.1f}{:>10.1f}\n",
                 fmt::format("all ({} of {} fitted)", fitted, report.muscles.size()), "", all.partial, all.missed,
                 sum.sections_outside, all.rescued, kMm * double{all.moved}, sum.fit_vertices, sum.mesh_vertices,
                 fitted == 0 ? 0.0 : kMm * std::sqrt(squares / static_cast<double>(fitted)), kMm * sum.fit_to_mesh.max,
                 kCm3 * sum.fit_volume, kCm3 * sum.mesh_volume);
  out += "Lengths in mm, volumes in cm^3; rms and max of the distance between the fitted surface and the mesh, both ways.\n";
  return out;
}

std::string to_section_table(const FitReport& report) {
  std::string out;
  const auto to = std::back_inserter(out);
  for (std::size_t i = 0; i < report.muscles.size(); ++i) {
    fmt::format_to(to, "\n{}\n{:>8}{:>7}{:>8}{:>9}{:>7}{:>11}{:>8}{:>9}  outcome\n", name_of_muscle(report, i), "section",
                   "hits", "misses", "matches", "loops", "moved (mm)", "inside", "rescued");
    const auto& sections = finest(report, i).fitted.sections;
    for (std::size_t k = 0; k < sections.size(); ++k) {
      const SectionReport& section = sections[k];
      fmt::format_to(to, "{:>8}{:>7}{:>8}{:>9}{:>7}{:>11.2f}{:>8}{:>9}  {}\n", k, section.hits, section.misses,
                     section.matches, section.loops, kMm * double{section.moved}, section.inside ? "yes" : "no",
                     section.rescued ? "yes" : "no", name_of(section.outcome));
    }
  }
  return out;
}

std::string to_json(const FitReport& report) {
  std::string out = fmt::format("{{\n  \"character\": {},\n  \"muscles\": [\n", quote_json(report.character->name));
  for (std::size_t i = 0; i < report.muscles.size(); ++i) {
    append_muscle_json(report, i, out);
    out += i + 1 < report.muscles.size() ? ",\n" : "\n";
  }
  out += "  ]\n}\n";
  return out;
}

}  // namespace fascicle::cook
