#include "modules/muscle/asset/fibres/isocontours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

constexpr double kFirstLevel = 1.0e-3;      // as near to the patches' borders as is safe from rounding
constexpr std::size_t kScoutLevels = 48;    // that say how far the levels are apart
constexpr std::size_t kFewestPoints = 3;

double sum_of_squares(const Loop& a, const Loop& b, std::size_t offset) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::dvec3 d = a[i] - b[(i + offset) % b.size()];
    sum += glm::dot(d, d);
  }
  return sum;
}

// How far (m) along `loop` to start so that it is least twisted against `before`. Places are compared about the loops'
// centres, so that a bend of the muscle turns nothing.
double align(const Loop& before, const Loop& loop) {
  const auto centred = [](const Loop& other) {
    Loop result = resample_loop(other, kContourPoints);
    const glm::dvec3 centre = loop_centre(other);
    for (glm::dvec3& p : result) p -= centre;
    return result;
  };
  const Loop a = centred(before), b = centred(loop);
  std::vector<double> costs(b.size());
  for (std::size_t k = 0; k < b.size(); ++k) costs[k] = sum_of_squares(a, b, k);
  const auto best = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
  // A parabola through the neighbours finds the place between two points.
  const double left = costs[(best + b.size() - 1) % b.size()], here = costs[best], right = costs[(best + 1) % b.size()];
  const double curve = left - 2.0 * here + right;
  const double shift = curve > 0.0 ? glm::clamp(0.5 * (left - right) / curve, -0.5, 0.5) : 0.0;
  return loop_length(loop) * (static_cast<double>(best) + shift) / static_cast<double>(b.size());
}

// Where (m along it) the narrowest width between opposite points of a loop begins.
double thin_start(const Loop& loop) {
  const Loop even = resample_loop(loop, kContourPoints);
  std::size_t best = 0;
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < even.size() / 2; ++i) {
    const double width = glm::distance(even[i], even[i + even.size() / 2]);
    if (width < least) {
      least = width;
      best = i;
    }
  }
  return loop_length(loop) * static_cast<double>(best) / static_cast<double>(even.size());
}

}  // namespace

std::vector<Loop> trace_level(std::span<const glm::vec3> positions, std::span<const std::uint32_t> triangles,
                              const MeshEdges& edges, std::span<const float> field, double level) {
  const auto above = [&](std::uint32_t v) { return static_cast<double>(field[v]) >= level; };
  // The side by which the level leaves a triangle: it goes from above to below, so that above stays on the right.
  const auto exit_of = [&](std::uint32_t triangle) {
    for (std::uint32_t side = 3 * triangle; side < 3 * triangle + 3; ++side)
      if (above(triangles[side]) && !above(triangles[next_side(side)])) return side;
    return kNoSide;
  };
  const auto point_on = [&](std::uint32_t side) {
    std::uint32_t a = triangles[side], b = triangles[next_side(side)];
    if (b < a) std::swap(a, b);  // the same point from both triangles
    const double fa = static_cast<double>(field[a]), fb = static_cast<double>(field[b]);
    const double t = glm::clamp((level - fa) / (fb - fa), 0.0, 1.0);
    return glm::mix(glm::dvec3(positions[a]), glm::dvec3(positions[b]), t);
  };
  std::vector<Loop> loops;
  std::vector<bool> seen(triangles.size() / 3, false);
  for (std::uint32_t first = 0; first < seen.size(); ++first) {
    if (seen[first] || exit_of(first) == kNoSide) continue;
    Loop loop;
    std::uint32_t triangle = first;
    while (!seen[triangle]) {
      seen[triangle] = true;
      const std::uint32_t side = exit_of(triangle);
      loop.push_back(point_on(side));
      if (edges.opposite[side] == kNoSide) break;  // the mesh is open here: the chain ends
      triangle = edges.opposite[side] / 3;
    }
    if (loop.size() >= kFewestPoints) loops.push_back(std::move(loop));
  }
  std::ranges::stable_sort(loops, [](const Loop& a, const Loop& b) { return loop_length(a) > loop_length(b); });
  return loops;
}

double loop_length(const Loop& loop) {
  double length = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) length += glm::distance(loop[i], loop[(i + 1) % loop.size()]);
  return length;
}

glm::dvec3 loop_centre(const Loop& loop) {
  glm::dvec3 sum(0.0);
  double length = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const glm::dvec3& a = loop[i];
    const glm::dvec3& b = loop[(i + 1) % loop.size()];
    const double one = glm::distance(a, b);
    sum += 0.5 * one * (a + b);
    length += one;
  }
  return length > 0.0 ? sum / length : loop.front();
}

Loop resample_loop(const Loop& loop, std::size_t count, double start) {
  const double length = loop_length(loop);
  Loop even(count, loop.front());
  if (!(length > 0.0)) return even;
  start -= length * std::floor(start / length);
  std::size_t segment = 0;
  double begin = 0.0, size = glm::distance(loop[0], loop[1 % loop.size()]);
  for (std::size_t i = 0, turns = 0; i < count; ++i) {
    const double at = start + length * static_cast<double>(i) / static_cast<double>(count);
    while (begin + size < at && turns < 2 * loop.size() + 1) {
      begin += size;
      ++turns;
      segment = (segment + 1) % loop.size();
      size = glm::distance(loop[segment], loop[(segment + 1) % loop.size()]);
    }
    const double t = size > 0.0 ? glm::clamp((at - begin) / size, 0.0, 1.0) : 0.0;
    even[i] = glm::mix(loop[segment], loop[(segment + 1) % loop.size()], t);
  }
  return even;
}

Contours trace_contours(std::span<const glm::vec3> positions, std::span<const std::uint32_t> triangles,
                        std::span<const float> field, std::size_t count) {
  const MeshEdges edges = find_edges(triangles, positions.size());
  Contours contours;
  const auto longest = [&](double level) {
    std::vector<Loop> loops = trace_level(positions, triangles, edges, field, level);
    return loops.empty() ? Loop{} : std::move(loops.front());
  };
  // Scouts first: equal steps of the field are not equal steps along the muscle.
  std::vector<double> levels, arcs;
  glm::dvec3 before(0.0);
  for (std::size_t i = 0; i < kScoutLevels; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kScoutLevels - 1);
    const double level = glm::mix(kFirstLevel, 1.0 - kFirstLevel, share);
    const Loop loop = longest(level);
    if (loop.empty()) return {};
    const glm::dvec3 centre = loop_centre(loop);
    arcs.push_back(levels.empty() ? 0.0 : arcs.back() + glm::distance(before, centre));
    levels.push_back(level);
    before = centre;
  }
  contours.length = arcs.back();
  for (std::size_t i = 0; i < count; ++i) {
    const double arc = contours.length * static_cast<double>(i) / static_cast<double>(count - 1);
    const auto end = static_cast<std::size_t>(std::ranges::lower_bound(arcs, arc) - arcs.begin());
    double level = levels[std::min(end, levels.size() - 1)];
    if (end > 0 && end < arcs.size()) {
      const double step = arcs[end] - arcs[end - 1];
      level = glm::mix(levels[end - 1], levels[end], step > 0.0 ? (arc - arcs[end - 1]) / step : 0.0);
    }
    std::vector<Loop> loops = trace_level(positions, triangles, edges, field, level);
    if (loops.empty()) return {};
    if (loops.size() > 1) ++contours.split_levels;
    contours.loops.push_back(std::move(loops.front()));
  }
  // From the middle to both ends.
  const std::size_t middle = count / 2;
  const auto settle = [&](std::size_t i, double start) {
    contours.loops[i] = resample_loop(contours.loops[i], kContourPoints, start);
  };
  settle(middle, thin_start(contours.loops[middle]));
  for (std::size_t i = middle; i-- > 0;) settle(i, align(contours.loops[i + 1], contours.loops[i]));
  for (std::size_t i = middle + 1; i < count; ++i) settle(i, align(contours.loops[i - 1], contours.loops[i]));
  return contours;
}

}  // namespace fascicle::muscle
