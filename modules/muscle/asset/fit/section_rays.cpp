#include "modules/muscle/asset/fit/section_rays.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fascicle::muscle {

std::vector<glm::dvec2> ray_directions(std::uint32_t count) {
  std::vector<glm::dvec2> directions(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    directions[i] = {std::cos(angle), std::sin(angle)};
  }
  return directions;
}

Line section_line(const SectionFrame& frame, const glm::dvec2& direction) {
  return {glm::vec3(frame.centre), glm::vec3(direction.x * frame.u + direction.y * frame.v)};
}

void cast_sections(const FitSurface& surface, std::span<const SectionFrame> frames,
                   std::span<const glm::dvec2> directions, SectionRays& rays) {
  const std::uint32_t count = static_cast<std::uint32_t>(directions.size()), half = count / 2;
  std::vector<Line> lines(frames.size() * half);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (std::uint32_t i = 0; i < half; ++i) lines[k * half + i] = section_line(frames[k], directions[i]);
  }
  std::vector<LineExtremes> extremes(lines.size());
  surface.cast(lines, extremes);

  rays.count = count;
  rays.radii.assign(frames.size() * count, 0.0);
  rays.hits.assign(frames.size() * count, 0);
  rays.most_crossings.assign(frames.size(), 0);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (std::uint32_t i = 0; i < half; ++i) {
      const LineExtremes& found = extremes[k * half + i];
      const std::size_t ray = k * count + i, opposite = ray + half;
      rays.most_crossings[k] = std::max(rays.most_crossings[k], found.crossings);
      if (std::isfinite(found.last_exit)) {
        rays.radii[ray] = double{found.last_exit};
        rays.hits[ray] = 1;
      }
      if (std::isfinite(found.first_entry)) {
        rays.radii[opposite] = -double{found.first_entry};
        rays.hits[opposite] = 1;
      }
    }
  }
}

void cast_slice(const SectionSlice& slice, std::size_t section, std::span<const glm::dvec2> directions,
                SectionRays& rays) {
  const std::size_t half = rays.count / 2;
  std::vector<InsideInterval> intervals;
  for (std::size_t i = 0; i < half; ++i) {
    find_inside(slice, directions[i], intervals);
    const std::size_t ray = section * rays.count + i;
    const bool hit = !intervals.empty();
    rays.hits[ray] = rays.hits[ray + half] = hit ? 1 : 0;
    rays.radii[ray] = hit ? intervals.back().to : 0.0;
    rays.radii[ray + half] = hit ? -intervals.front().from : 0.0;
  }
}

}  // namespace fascicle::muscle
