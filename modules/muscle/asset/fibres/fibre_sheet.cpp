#include "modules/muscle/asset/fibres/fibre_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

using Curve = std::vector<glm::dvec3>;

double mean_distance(const Curve& a, const Curve& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += glm::distance(a[i], b[i]);
  return sum / static_cast<double>(a.size());
}

// Runs all fibres the way of the longest one: fibres of one sheet are all but parallel, whatever ends they begin at.
void turn_alike(std::vector<Curve>& fibres) {
  const auto span_of = [](const Curve& c) { return c.back() - c.front(); };
  const Curve& longest = *std::ranges::max_element(
      fibres, [&](const Curve& a, const Curve& b) { return glm::length(span_of(a)) < glm::length(span_of(b)); });
  const glm::dvec3 along = span_of(longest);
  int against = 0;
  for (Curve& fibre : fibres) {
    if (glm::dot(span_of(fibre), along) >= 0.0) continue;
    std::ranges::reverse(fibre);
    ++against;
  }
  if (2 * against > static_cast<int>(fibres.size()))
    for (Curve& fibre : fibres) std::ranges::reverse(fibre);
}

// From the fibre that is furthest from all others to its nearest neighbour, and so on.
void put_side_by_side(std::vector<Curve>& fibres) {
  std::size_t first = 0;
  double furthest = -1.0;
  for (std::size_t i = 0; i < fibres.size(); ++i) {
    double sum = 0.0;
    for (const Curve& other : fibres) sum += mean_distance(fibres[i], other);
    if (sum <= furthest) continue;
    furthest = sum;
    first = i;
  }
  std::swap(fibres[0], fibres[first]);
  for (std::size_t i = 1; i + 1 < fibres.size(); ++i) {
    const auto nearest = std::ranges::min_element(
        fibres.begin() + static_cast<std::ptrdiff_t>(i), fibres.end(), [&](const Curve& a, const Curve& b) {
          return mean_distance(fibres[i - 1], a) < mean_distance(fibres[i - 1], b);
        });
    std::iter_swap(fibres.begin() + static_cast<std::ptrdiff_t>(i), nearest);
  }
}

}  // namespace

FibreSheet::FibreSheet(std::span<const std::vector<glm::dvec3>> fibres) {
  for (const Curve& fibre : fibres) fibres_.push_back(resample_curve(fibre, kStations));
  turn_alike(fibres_);
  put_side_by_side(fibres_);
  draw_curves();
}

void FibreSheet::draw_curves() {
  curves_.clear();
  std::vector<glm::dvec3> across(fibres_.size());
  for (std::size_t j = 0; j < kStations; ++j) {
    for (std::size_t i = 0; i < fibres_.size(); ++i) across[i] = fibres_[i][j];
    curves_.emplace_back(across);
  }
}

void FibreSheet::turn_round() {
  for (Curve& fibre : fibres_) std::ranges::reverse(fibre);
  std::ranges::reverse(curves_);
}

glm::dvec3 FibreSheet::at(double across, std::size_t station) const {
  const double place = glm::clamp(across, 0.0, 1.0) * static_cast<double>(fibres_.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), fibres_.size() - 2);
  const CentripetalCurve& curve = curves_[station];
  return curve.at(glm::mix(curve.knot(i), curve.knot(i + 1), place - static_cast<double>(i)));
}

}  // namespace fascicle::muscle
