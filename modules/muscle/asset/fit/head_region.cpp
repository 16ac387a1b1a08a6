#include "modules/muscle/asset/fit/head_region.hpp"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

constexpr double kOverlap = 0.1;
constexpr int kSteps = 64;        // along a line as long as the head
constexpr int kBisections = 30;

double distance_to(std::span<const glm::dvec3> line, const glm::dvec3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const glm::dvec3 along = line[i] - line[i - 1];
    const double squared = glm::dot(along, along);
    const double s = squared > 0.0 ? std::clamp(glm::dot(point - line[i - 1], along) / squared, 0.0, 1.0) : 0.0;
    least = std::min(least, glm::distance(point, line[i - 1] + s * along));
  }
  return least;
}

}  // namespace

HeadRegion::HeadRegion(std::span<const std::vector<glm::dvec3>> lines, std::size_t own)
    : own_(lines[own]) {
  double length = 0.0;
  for (std::size_t i = 1; i < own_.size(); ++i) length += glm::distance(own_[i - 1], own_[i]);
  step_ = length / kSteps;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i != own) others_.push_back(lines[i]);
  }
}

bool HeadRegion::contains(const glm::dvec3& point) const {
  const double distance = distance_to(own_, point);
  return std::ranges::all_of(others_, [&](const std::vector<glm::dvec3>& other) {
    return distance <= (1.0 + kOverlap) * distance_to(other, point);
  });
}

void HeadRegion::clip(const glm::dvec3& origin, const glm::dvec3& direction, std::size_t first,
                      std::vector<InsideInterval>& intervals) const {
  const auto mine = [&](double t) { return contains(origin + t * direction); };
  const std::vector<InsideInterval> whole(intervals.begin() + static_cast<std::ptrdiff_t>(first), intervals.end());
  intervals.resize(first);
  for (const InsideInterval& interval : whole) {
    const int steps = 1 + static_cast<int>((interval.to - interval.from) / step_);
    double last = interval.from;
    bool was_mine = mine(last);
    if (was_mine) intervals.push_back({last, last});
    for (int i = 1; i <= steps; ++i) {
      const double t = interval.from + (interval.to - interval.from) * i / steps;
      const bool is_mine = mine(t);
      if (is_mine != was_mine) {
        double low = last, high = t;
        for (int round = 0; round < kBisections; ++round) {
          const double middle = 0.5 * (low + high);
          (mine(middle) == was_mine ? low : high) = middle;
        }
        if (is_mine) intervals.push_back({high, high});
        else intervals.back().to = low;
      }
      last = t;
      was_mine = is_mine;
    }
    if (was_mine) intervals.back().to = interval.to;
  }
}

}  // namespace fascicle::muscle
