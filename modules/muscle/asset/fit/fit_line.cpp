#include "modules/muscle/asset/fit/fit_line.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "modules/muscle/asset/fit/fill_misses.hpp"
#include "modules/muscle/asset/fit/inner_point.hpp"
#include "modules/muscle/asset/fit/match_order.hpp"
#include "modules/muscle/asset/fit/section_rays.hpp"

namespace fascicle::muscle {
namespace {

// Where t = 0 of line i lies inside.
bool starts_inside(std::span<const InsideInterval> intervals) {
  return std::ranges::any_of(intervals, [](const InsideInterval& i) { return i.from <= 0.0 && 0.0 <= i.to; });
}

// Sweep 1: the centres of sections that have matches move to their inner points; where that is not inside, to the
// middle of the longest stretch inside on the line through it.
void find_inner_points(const FitSurface& surface, std::span<const SectionFrame> frames,
                       std::span<const glm::dvec2> directions, const SectionRays& rays, std::span<glm::dvec3> centres,
                       std::span<SectionReport> sections) {
  std::vector<std::size_t> moved;
  std::vector<double> distances;
  std::vector<Line> lines;
  std::vector<std::uint32_t> ordered;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    order_matches(rays.radii_of(k), rays.hits_of(k), ordered);
    sections[k].matches = static_cast<std::uint32_t>(ordered.size());
    if (ordered.empty()) continue;
    const glm::dvec2 inner = inner_point(ordered, rays.radii_of(k), directions);
    const double distance = glm::length(inner);
    moved.push_back(k);
    distances.push_back(distance);
    lines.push_back(section_line(frames[k], distance > 0.0 ? inner / distance : directions[ordered[0]]));
  }
  std::vector<std::uint32_t> starts;
  std::vector<InsideInterval> intervals;
  surface.find_inside(lines, starts, intervals);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const std::span<const InsideInterval> inside =
        std::span(intervals).subspan(starts[i], starts[i + 1] - starts[i]);
    double t = distances[i];
    if (std::ranges::none_of(inside, [&](const InsideInterval& s) { return s.from < t && t < s.to; })) {
      double longest = 0.0;
      for (const InsideInterval& s : inside) {
        if (s.to - s.from <= longest) continue;
        longest = s.to - s.from;
        t = 0.5 * (s.from + s.to);
      }
    }
    centres[moved[i]] = frames[moved[i]].centre + t * glm::dvec3(lines[i].direction);
  }
}

void report_sections(const FitSurface& surface, std::span<const SectionFrame> frames, const SectionRays& rays,
                     std::span<const glm::dvec3> points, std::span<SectionReport> sections) {
  std::vector<Line> lines(frames.size());
  for (std::size_t k = 0; k < frames.size(); ++k) lines[k] = section_line(frames[k], glm::dvec2(0.8, 0.6));
  std::vector<std::uint32_t> starts;
  std::vector<InsideInterval> intervals;
  surface.find_inside(lines, starts, intervals);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    SectionReport& section = sections[k];
    section.hits = static_cast<std::uint32_t>(std::ranges::count(rays.hits_of(k), 1));
    section.misses = rays.count - section.hits;
    section.moved = static_cast<float>(glm::distance(points[k], frames[k].centre));
    section.inside = starts_inside(std::span(intervals).subspan(starts[k], starts[k + 1] - starts[k]));
    section.outcome = section.hits == 0      ? SectionOutcome::kMissed
                      : !section.inside      ? SectionOutcome::kOutside
                      : section.misses > 0   ? SectionOutcome::kPartial
                                             : SectionOutcome::kFitted;
  }
}

}  // namespace

LineFit fit_line(const FitSurface& surface, std::span<const glm::dvec3> points, const glm::dmat3& origin_bone,
                 std::uint32_t section_vertices, const FitOptions& options) {
  LineFit fit;
  fit.centres.assign(points.begin(), points.end());
  fit.sections.resize(points.size());
  std::vector<SectionFrame> frames;
  SectionRays rays;

  const std::vector<glm::dvec2> many = ray_directions(std::max(1u, options.supersampling) * section_vertices);
  rest_frames(fit.centres, origin_bone, frames);
  cast_sections(surface, frames, many, rays);
  find_inner_points(surface, frames, many, rays, fit.centres, fit.sections);
  if (options.restore_ends) {
    fit.centres.front() = points.front();
    fit.centres.back() = points.back();
  }

  rest_frames(fit.centres, origin_bone, frames);
  cast_sections(surface, frames, ray_directions(section_vertices), rays);
  fit.any_hit = std::ranges::count(rays.hits, 1) > 0;
  report_sections(surface, frames, rays, points, fit.sections);
  if (!fit.any_hit) return fit;

  std::vector<double> arcs(points.size(), 0.0);
  for (std::size_t k = 1; k < arcs.size(); ++k) {
    arcs[k] = arcs[k - 1] + glm::distance(fit.centres[k - 1], fit.centres[k]);
  }
  fill_misses(section_vertices, arcs, rays.hits, rays.radii);
  fit.radii = std::move(rays.radii);
  return fit;
}

}  // namespace fascicle::muscle
