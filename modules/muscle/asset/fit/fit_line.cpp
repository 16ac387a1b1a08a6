#include "modules/muscle/asset/fit/fit_line.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "modules/muscle/asset/fit/end_area.hpp"
#include "modules/muscle/asset/fit/fill_misses.hpp"
#include "modules/muscle/asset/fit/inner_point.hpp"
#include "modules/muscle/asset/fit/match_order.hpp"
#include "modules/muscle/asset/fit/outside_section.hpp"
#include "modules/muscle/asset/fit/section_rays.hpp"
#include "modules/muscle/asset/fit/section_slice.hpp"
#include "modules/muscle/asset/fit/unfold_sections.hpp"

namespace fascicle::muscle {
namespace {

constexpr int kMoreRescues = 4;

bool lies_inside(double t, std::span<const InsideInterval> intervals) {
  return std::ranges::any_of(intervals, [&](const InsideInterval& i) { return i.from < t && t < i.to; });
}

// The middle of the longest; nothing where there is none.
std::optional<double> middle_of_longest(std::span<const InsideInterval> intervals) {
  std::optional<double> middle;
  double longest = 0.0;
  for (const InsideInterval& interval : intervals) {
    if (interval.to - interval.from <= longest) continue;
    longest = interval.to - interval.from;
    middle = 0.5 * (interval.from + interval.to);
  }
  return middle;
}

glm::dvec3 place(const SectionFrame& frame, const glm::dvec2& at) {
  return frame.centre + at.x * frame.u + at.y * frame.v;
}

// The fit of one line, step by step.
class LineFitter {
 public:
  LineFitter(const FitSurface& surface, std::span<const glm::dvec3> points, const glm::dmat3& origin_bone,
             const std::array<TriangleMesh, 2>& areas, const FitOptions& options, LineFit& fit)
      : surface_(surface), points_(points), origin_bone_(origin_bone), areas_(areas), options_(options), fit_(fit) {
    fit_.centres.assign(points.begin(), points.end());
    fit_.sections.resize(points.size());
  }

  // Sweep 1: all centres inside.
  void move_centres(std::uint32_t rays_a_section) {
    cast(rays_a_section);
    if (options_.rescue) choose_slices_along();
    find_inner_points();
    if (options_.rescue) rescue_centres();
    if (options_.restore_ends) {
      fit_.centres.front() = points_.front();
      fit_.centres.back() = points_.back();
    }
    lay_ends_on_areas();
  }

  // Sweep 2, in the planes that the moved centres give: the radii.
  void find_radii(std::uint32_t section_vertices) {
    cast(section_vertices);
    if (options_.rescue) choose_slices_of_centres();
    // Planes that the moved neighbours turned may cut the mesh where they missed it before.
    for (int round = 0; options_.rescue && round < kMoreRescues && rescue_centres(); ++round) {
      lay_ends_on_areas();
      cast(section_vertices);
      choose_slices_of_centres();
    }
    const bool met = std::ranges::count(rays_.hits, 1) > 0;
    for (const std::size_t k : {std::size_t{0}, frames_.size() - 1}) {
      if (const TriangleMesh* area = area_of(k)) cast_area(*area, frames_[k], k, directions_, rays_);
    }
    report();
    if (options_.rescue && surface_.has_plain_slices()) shape_outside_sections();
    fit_.any_hit = met && std::ranges::count(rays_.hits, 1) > 0;
    if (!fit_.any_hit) return;
    std::vector<double> arcs(points_.size(), 0.0);
    for (std::size_t k = 1; k < arcs.size(); ++k) {
      arcs[k] = arcs[k - 1] + glm::distance(fit_.centres[k - 1], fit_.centres[k]);
    }
    fill_misses(section_vertices, arcs, rays_.hits, rays_.radii);
    if (options_.rescue) unfold_sections(frames_, directions_, rays_.radii);
    fit_.radii = std::move(rays_.radii);
  }

 private:
  void cast(std::uint32_t rays_a_section) {
    directions_ = ray_directions(rays_a_section);
    rest_frames(fit_.centres, origin_bone_, fit_.end_normals, frames_);
    cast_sections(surface_, frames_, directions_, rays_);
    slices_.assign(frames_.size(), std::nullopt);
  }

  // Along the line as it runs now.
  void lay_ends_on_areas() {
    const std::vector<glm::dvec3>& a = fit_.centres;
    const std::array<glm::dvec3, 2> along{a[1] - a[0], a[a.size() - 1] - a[a.size() - 2]};
    for (std::size_t end = 0; end < 2; ++end) {
      if (areas_[end].indices.empty() || glm::length(along[end]) == 0.0) continue;
      fit_.end_normals[end] = area_normal(areas_[end], glm::normalize(along[end]));
    }
  }

  // The area that the section lies on, or null.
  const TriangleMesh* area_of(std::size_t k) const {
    if (k == 0 && fit_.end_normals[0]) return &areas_[0];
    if (k + 1 == frames_.size() && fit_.end_normals[1]) return &areas_[1];
    return nullptr;
  }

  // Only a plane that some line crosses more than twice can cut the mesh in several loops that matter: a second loop
  // that no line met is thinner than the rays' spacing.
  std::vector<SectionSlice> slices_of(std::size_t k) {
    if (!surface_.has_plain_slices() || rays_.most_crossings[k] <= 2) return {};
    std::vector<SectionSlice> slices = slice_section(surface_.mesh(), frames_[k]);
    fit_.sections[k].loops = static_cast<std::uint32_t>(slices.size());
    return slices;
  }

  void keep_to(std::size_t k, SectionSlice slice) {
    cast_slice(slice, k, directions_, rays_);
    slices_[k] = std::move(slice);
  }

  // What the rays saw of a section, as a slice.
  std::vector<SectionSlice> slice_by_rays(std::size_t k) const {
    std::vector<glm::dvec2> ends;
    for (std::size_t i = 0; i < rays_.count; ++i) {
      if (rays_.hits_of(k)[i] != 0) ends.push_back(rays_.radii_of(k)[i] * directions_[i]);
    }
    if (ends.size() < 3) return {};
    return {slice_of(std::move(ends))};
  }

  void choose_slices_along() {
    std::vector<std::vector<SectionSlice>> candidates(frames_.size());
    bool several = false;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      candidates[k] = slices_of(k);
      several = several || candidates[k].size() > 1;
    }
    if (!several) return;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (candidates[k].empty()) candidates[k] = slice_by_rays(k);
    }
    const std::vector<int> chosen = choose_slices(frames_, candidates);
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (candidates[k].size() > 1) keep_to(k, std::move(candidates[k][static_cast<std::size_t>(chosen[k])]));
    }
  }

  void choose_slices_of_centres() {
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      std::vector<SectionSlice> slices = slices_of(k);
      if (slices.size() > 1) keep_to(k, std::move(nearest(slices)));
    }
  }

  static SectionSlice& nearest(std::vector<SectionSlice>& slices) {
    const auto off = [](const SectionSlice& slice) {
      return slice.contains(glm::dvec2(0.0)) ? 0.0 : slice.distance(glm::dvec2(0.0));
    };
    return *std::ranges::min_element(slices, {}, off);
  }

  // The stretches inside of one line in each of `sections`' planes.
  std::vector<std::vector<InsideInterval>> find_inside_along(std::span<const std::size_t> sections,
                                                             std::span<const glm::dvec2> directions) const {
    std::vector<Line> lines;
    for (std::size_t i = 0; i < sections.size(); ++i) {
      lines.push_back(section_line(frames_[sections[i]], directions[i]));
    }
    std::vector<std::uint32_t> starts;
    std::vector<InsideInterval> all;
    surface_.find_inside(lines, starts, all);
    std::vector<std::vector<InsideInterval>> found(sections.size());
    for (std::size_t i = 0; i < sections.size(); ++i) {
      if (slices_[sections[i]]) find_inside(*slices_[sections[i]], directions[i], found[i]);
      else found[i].assign(all.begin() + starts[i], all.begin() + starts[i + 1]);
    }
    return found;
  }

  // Centres of sections with matches move to their inner points; where that is not inside, to the middle of the longest
  // stretch inside on the line through it.
  void find_inner_points() {
    std::vector<std::size_t> moved;
    std::vector<double> distances;
    std::vector<glm::dvec2> towards;
    std::vector<std::uint32_t> ordered;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      order_matches(rays_.radii_of(k), rays_.hits_of(k), ordered);
      fit_.sections[k].matches = static_cast<std::uint32_t>(ordered.size());
      if (ordered.empty()) continue;
      const glm::dvec2 inner = inner_point(ordered, rays_.radii_of(k), directions_);
      const double distance = glm::length(inner);
      moved.push_back(k);
      distances.push_back(distance);
      towards.push_back(distance > 0.0 ? inner / distance : directions_[ordered[0]]);
    }
    const std::vector<std::vector<InsideInterval>> inside = find_inside_along(moved, towards);
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const double t = lies_inside(distances[i], inside[i]) ? distances[i]
                                                            : middle_of_longest(inside[i]).value_or(distances[i]);
      fit_.centres[moved[i]] = place(frames_[moved[i]], t * towards[i]);
    }
  }

  // Centres that are still outside though their planes cut the mesh go deep into the slice. False: there were none.
  bool rescue_centres() {
    std::vector<std::size_t> sections;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (!options_.restore_ends || (k > 0 && k + 1 < frames_.size())) sections.push_back(k);
    }
    // A line through the centre as it is now, in the section's plane.
    std::vector<Line> lines;
    for (const std::size_t k : sections) {
      SectionFrame frame = frames_[k];
      frame.centre = fit_.centres[k];
      lines.push_back(section_line(frame, kAnyDirection));
    }
    std::vector<std::uint32_t> starts;
    std::vector<InsideInterval> intervals;
    surface_.find_inside(lines, starts, intervals);
    bool any = false;
    for (std::size_t i = 0; i < sections.size(); ++i) {
      if (lies_inside(0.0, std::span(intervals).subspan(starts[i], starts[i + 1] - starts[i]))) continue;
      if (const std::optional<glm::dvec2> at = find_depth(sections[i])) {
        fit_.centres[sections[i]] = place(frames_[sections[i]], *at);
        fit_.sections[sections[i]].rescued = true;
        any = true;
      }
    }
    return any;
  }

  // A point inside the mesh in the section's plane, if there is any.
  std::optional<glm::dvec2> find_depth(std::size_t k) const {
    std::vector<SectionSlice> slices;
    if (slices_[k]) slices.push_back(*slices_[k]);
    else slices = slice_section(surface_.mesh(), frames_[k]);
    if (!slices.empty()) {
      const glm::dvec2 deepest = deepest_point(nearest(slices));
      if (surface_.has_plain_slices() || surface_.contains(place(frames_[k], deepest))) return deepest;
    }
    // No closed loop there, but the winding number may still say that some of the plane is inside.
    const std::vector<std::size_t> same(directions_.size() / 2, k);
    const std::vector<std::vector<InsideInterval>> inside = find_inside_along(same, directions_);
    std::optional<glm::dvec2> middle;
    double longest = 0.0;
    for (std::size_t i = 0; i < same.size(); ++i) {
      for (const InsideInterval& interval : inside[i]) {
        if (interval.to - interval.from <= longest) continue;
        longest = interval.to - interval.from;
        middle = 0.5 * (interval.from + interval.to) * directions_[i];
      }
    }
    return middle;
  }

  void shape_outside_sections() {
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (fit_.sections[k].outcome != SectionOutcome::kOutside || area_of(k) != nullptr) continue;
      const std::size_t first = k * rays_.count;
      shape_outside_section(slice_section(surface_.mesh(), frames_[k]), directions_,
                            std::span(rays_.radii).subspan(first, rays_.count),
                            std::span(rays_.hits).subspan(first, rays_.count));
    }
  }

  void report() {
    std::vector<Line> lines(frames_.size());
    for (std::size_t k = 0; k < frames_.size(); ++k) lines[k] = section_line(frames_[k], kAnyDirection);
    std::vector<std::uint32_t> starts;
    std::vector<InsideInterval> intervals;
    surface_.find_inside_mesh(lines, starts, intervals);
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      SectionReport& section = fit_.sections[k];
      section.hits = static_cast<std::uint32_t>(std::ranges::count(rays_.hits_of(k), 1));
      section.misses = rays_.count - section.hits;
      section.moved = static_cast<float>(glm::distance(points_[k], frames_[k].centre));
      section.inside = lies_inside(0.0, std::span(intervals).subspan(starts[k], starts[k + 1] - starts[k]));
      section.outcome = section.hits == 0    ? SectionOutcome::kMissed
                        : !section.inside    ? SectionOutcome::kOutside
                        : section.misses > 0 ? SectionOutcome::kPartial
                                             : SectionOutcome::kFitted;
    }
  }

  // In a section's plane; no ray's, so that it passes no vertex of a mesh made with the rays in mind.
  static constexpr glm::dvec2 kAnyDirection{0.8, 0.6};

  const FitSurface& surface_;
  std::span<const glm::dvec3> points_;
  const glm::dmat3& origin_bone_;
  const std::array<TriangleMesh, 2>& areas_;
  const FitOptions& options_;
  LineFit& fit_;
  std::vector<glm::dvec2> directions_;
  std::vector<SectionFrame> frames_;
  SectionRays rays_;
  std::vector<std::optional<SectionSlice>> slices_;  // by section: the one that it keeps to, where there are several
};

}  // namespace

LineFit fit_line(const FitSurface& surface, std::span<const glm::dvec3> points, const glm::dmat3& origin_bone,
                 std::uint32_t section_vertices, const std::array<TriangleMesh, 2>& areas, const FitOptions& options) {
  LineFit fit;
  LineFitter fitter(surface, points, origin_bone, areas, options, fit);
  fitter.move_centres(std::max(1u, options.supersampling) * section_vertices);
  fitter.find_radii(section_vertices);
  return fit;
}

}  // namespace fascicle::muscle
