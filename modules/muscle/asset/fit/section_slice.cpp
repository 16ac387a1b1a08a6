#include "modules/muscle/asset/fit/section_slice.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

constexpr int kGrid = 20;          // points along each axis of the first search for the deepest point
constexpr int kRefinements = 6;    // each halves the step

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// f(from, to) for each side.
template <class F>
void for_each_side(const SliceLoop& loop, F f) {
  for (std::size_t i = 0; i < loop.points.size(); ++i) f(loop.points[i], loop.points[(i + 1) % loop.points.size()]);
}
template <class F>
void for_each_side(const SectionSlice& slice, F f) {
  for (const SliceLoop& loop : slice.loops) for_each_side(loop, f);
}

// How often a slice or a loop winds round a point.
template <class Loops>
int winding_of(const Loops& loops, const glm::dvec2& point) {
  int winding = 0;
  for_each_side(loops, [&](const glm::dvec2& a, const glm::dvec2& b) {
    if ((a.y > point.y) == (b.y > point.y)) return;
    if (a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x) > point.x) winding += b.y > a.y ? 1 : -1;
  });
  return winding;
}

// Of shells that run through each other.
bool overlap(const SectionSlice& a, const SectionSlice& b) {
  const auto reaches_into = [](const SectionSlice& from, const SectionSlice& into) {
    return std::ranges::any_of(from.loops[0].points, [&](const glm::dvec2& p) { return into.contains(p); });
  };
  return reaches_into(a, b) || reaches_into(b, a);
}

double side_distance_squared(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& point) {
  const glm::dvec2 along = b - a;
  const double squared = glm::dot(along, along);
  const double s = squared > 0.0 ? std::clamp(glm::dot(point - a, along) / squared, 0.0, 1.0) : 0.0;
  const glm::dvec2 off = point - a - s * along;
  return glm::dot(off, off);
}

}  // namespace

bool SectionSlice::contains(const glm::dvec2& point) const { return winding_of(*this, point) > 0; }

double SectionSlice::distance(const glm::dvec2& point) const {
  double least = std::numeric_limits<double>::infinity();
  for_each_side(*this, [&](const glm::dvec2& a, const glm::dvec2& b) {
    least = std::min(least, side_distance_squared(a, b, point));
  });
  return std::sqrt(least);
}

SectionSlice slice_of(std::vector<glm::dvec2> points) {
  SliceLoop loop;
  loop.points = std::move(points);
  measure_loop(loop);
  SectionSlice slice{.loops = {}, .area = std::abs(loop.area), .centroid = loop.centroid};
  slice.loops.push_back(std::move(loop));
  return slice;
}

std::vector<SectionSlice> slice_section(const TriangleMesh& mesh, const SectionFrame& frame) {
  std::vector<SectionSlice> slices;
  std::vector<SliceLoop> holes;
  for (SliceLoop& loop : slice_mesh(mesh, {frame.centre, frame.u, frame.v})) {
    if (!loop.closed) continue;
    if (loop.area <= 0.0) {
      holes.push_back(std::move(loop));
      continue;
    }
    SectionSlice& slice = slices.emplace_back();
    slice.area = loop.area;
    slice.centroid = loop.centroid;
    slice.loops.push_back(std::move(loop));
  }
  std::ranges::stable_sort(slices, [](const SectionSlice& a, const SectionSlice& b) { return a.area > b.area; });
  for (SliceLoop& hole : holes) {  // of the smallest outline round it
    for (std::size_t i = slices.size(); i-- > 0;) {
      if (winding_of(slices[i].loops[0], hole.points[0]) <= 0) continue;
      slices[i].area += hole.area;
      slices[i].loops.push_back(std::move(hole));
      break;
    }
  }
  for (std::size_t i = 0; i < slices.size(); ++i) {
    for (std::size_t j = i + 1; j < slices.size();) {
      if (!overlap(slices[i], slices[j])) {
        ++j;
        continue;
      }
      slices[i].area += slices[j].area;
      std::ranges::move(slices[j].loops, std::back_inserter(slices[i].loops));
      slices.erase(slices.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;  // what did not reach the one may reach the other
    }
  }
  return slices;
}

void find_inside(const SectionSlice& slice, const glm::dvec2& direction, std::vector<InsideInterval>& intervals) {
  struct Crossing {
    double t;
    int change;
  };
  std::vector<Crossing> crossings;
  for_each_side(slice, [&](const glm::dvec2& a, const glm::dvec2& b) {
    // A corner on the line counts as to its left, so that loops cross it as often one way as the other.
    const double side_a = cross(direction, a), side_b = cross(direction, b);
    if ((side_a < 0.0) == (side_b < 0.0)) return;
    const double t = glm::dot(direction, a + side_a / (side_a - side_b) * (b - a));
    crossings.push_back({t, side_a < 0.0 ? -1 : 1});  // anticlockwise outlines rise from right to left behind
  });
  std::ranges::stable_sort(crossings, {}, &Crossing::t);
  intervals.clear();
  int winding = 0;
  for (const Crossing& crossing : crossings) {
    winding += crossing.change;
    if (winding == 1 && crossing.change > 0) intervals.push_back({crossing.t, crossing.t});
    if (winding == 0 && crossing.change < 0 && !intervals.empty()) intervals.back().to = crossing.t;
  }
}

glm::dvec2 deepest_point(const SectionSlice& slice) {
  glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const glm::dvec2& p : slice.loops[0].points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  glm::dvec2 best = slice.centroid;
  double depth = slice.contains(best) ? slice.distance(best) : -1.0;
  const auto consider = [&](const glm::dvec2& point) {
    if (!slice.contains(point)) return;
    const double here = slice.distance(point);
    if (here <= depth) return;
    depth = here;
    best = point;
  };
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      consider(low + (high - low) * glm::dvec2((i + 0.5) / kGrid, (j + 0.5) / kGrid));
    }
  }
  // A slice thinner than the grid: the middles of the longest stretches along lines through it.
  for (int i = 0; depth < 0.0 && i < kGrid; ++i) {
    const std::vector<glm::dvec2>& outline = slice.loops[0].points;
    const glm::dvec2 from = outline[outline.size() * static_cast<std::size_t>(i) / kGrid];
    const glm::dvec2 inward = slice.centroid - from;
    if (glm::length(inward) == 0.0) continue;
    SectionSlice seen = slice;
    for (SliceLoop& loop : seen.loops) {
      for (glm::dvec2& p : loop.points) p -= from;
    }
    std::vector<InsideInterval> stretches;
    find_inside(seen, glm::normalize(inward), stretches);
    for (const InsideInterval& s : stretches) consider(from + 0.5 * (s.from + s.to) * glm::normalize(inward));
  }
  glm::dvec2 step = (high - low) / (2.0 * kGrid);
  for (int round = 0; round < kRefinements; ++round, step *= 0.5) {
    const glm::dvec2 centre = best;
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) consider(centre + step * glm::dvec2(i, j));
    }
  }
  return best;
}

std::vector<int> choose_slices(std::span<const SectionFrame> frames,
                               std::span<const std::vector<SectionSlice>> candidates) {
  struct Choice {
    glm::dvec3 centroid{0.0};
    double size = 0.0, cost = 0.0;
    int before = -1;
  };
  std::vector<std::vector<Choice>> choices(frames.size());
  std::vector<int> chosen(frames.size(), -1);
  std::ptrdiff_t last = -1;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (const SectionSlice& slice : candidates[k]) {
      Choice choice;
      const glm::dvec2& c = slice.centroid;
      choice.centroid = frames[k].centre + c.x * frames[k].u + c.y * frames[k].v;
      choice.size = std::sqrt(slice.area);
      const double off = slice.contains(glm::dvec2(0.0)) ? 0.0 : slice.distance(glm::dvec2(0.0));
      choice.cost = off * off;
      if (last >= 0) {
        double least = std::numeric_limits<double>::infinity();
        const std::vector<Choice>& previous = choices[static_cast<std::size_t>(last)];
        for (std::size_t j = 0; j < previous.size(); ++j) {
          const glm::dvec3 step = choice.centroid - previous[j].centroid;
          const double growth = choice.size - previous[j].size;
          const double cost = previous[j].cost + glm::dot(step, step) + growth * growth;
          if (cost >= least) continue;
          least = cost;
          choice.before = static_cast<int>(j);
        }
        choice.cost += least;
      }
      choices[k].push_back(choice);
    }
    if (!choices[k].empty()) last = static_cast<std::ptrdiff_t>(k);
  }
  if (last < 0) return chosen;
  std::size_t k = static_cast<std::size_t>(last);
  const auto least = std::ranges::min_element(choices[k], {}, &Choice::cost);
  int i = static_cast<int>(least - choices[k].begin());
  while (true) {
    chosen[k] = i;
    i = choices[k][static_cast<std::size_t>(i)].before;
    if (i < 0) return chosen;
    do --k;
    while (choices[k].empty());
  }
}

}  // namespace fascicle::muscle
