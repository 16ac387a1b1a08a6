#include "modules/muscle/kernels/inflate_section.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "modules/muscle/kernels/kernel_data.hpp"

namespace fascicle::muscle {
namespace {

std::array<double, kMaxSectionVertices + 1> make_area_factors() {
  std::array<double, kMaxSectionVertices + 1> factors{};
  for (std::size_t n = 3; n < factors.size(); ++n) {
    factors[n] = 0.5 * std::sin(2.0 * std::numbers::pi / static_cast<double>(n));
  }
  return factors;
}

// Sums of r_i r_{i+1} by how many of the two are free.
struct ProductSums {
  double free_free = 0.0, mixed = 0.0, fixed_fixed = 0.0;
  bool any_free = false;
};

ProductSums sum_products(std::span<const float> radii, std::span<const std::uint8_t> fixed) {
  ProductSums sums;
  // A radius counts in one of two rows and is zero in the other: no branches over pairs.
  std::size_t free_count = 0;
  const double last = radii.back();
  double last_free = fixed.back() != 0 ? 0.0 : last, last_held = fixed.back() != 0 ? last : 0.0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double radius = radii[i];
    const double free = fixed[i] != 0 ? 0.0 : radius, held = fixed[i] != 0 ? radius : 0.0;
    sums.free_free += last_free * free;
    sums.mixed += last_free * held + last_held * free;
    sums.fixed_fixed += last_held * held;
    last_free = free;
    last_held = held;
    free_count += fixed[i] != 0 ? 0 : 1;
  }
  sums.any_free = free_count > 0;
  return sums;
}

// The positive root of a s^2 + b s + c nearest to 1; 0 where there is none.
double scale_nearest_one(double a, double b, double c) {
  if (a >= 0.0 && b >= 0.0 && c < 0.0) {  // nearly always: radii are positive, and free ones have area to fill
    return -2.0 * c / (b + std::sqrt(b * b - 4.0 * a * c));
  }
  if (a == 0.0) return b != 0.0 ? std::max(0.0, -c / b) : 0.0;
  const double discriminant = b * b - 4.0 * a * c;
  if (!(discriminant >= 0.0)) return 0.0;
  // The root with the larger magnitude first, the other by their product: no digits cancel.
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  const double first = q / a, second = q != 0.0 ? c / q : 0.0;
  if (!(first > 0.0)) return std::max(0.0, second);
  if (!(second > 0.0)) return first;
  return std::abs(first - 1.0) <= std::abs(second - 1.0) ? first : second;
}

// (4.8) with (4.9): the triangle between the axis and two neighbouring vertices at these radii, half its base times its
// height over it.
double triangle_area(double radius, double next, double cosine, double sine) {
  const double x = next * cosine - radius, y = next * sine;  // c_{i+1} - c_i, where c_i = (r_i, 0)
  const double base = std::sqrt(x * x + y * y);
  if (base == 0.0) return 0.0;
  const double along = -radius * x / base;  // (a_k - c_i) on the base's direction
  const double foot_x = radius + along * x / base, foot_y = along * y / base;
  return 0.5 * base * std::sqrt(foot_x * foot_x + foot_y * foot_y);
}

struct SplitArea {
  double fixed = 0.0, free = 0.0;  // m^2, (4.6) and (4.7): a triangle counts with its first vertex
};

SplitArea measure_triangles(std::span<const float> radii, std::span<const std::uint8_t> fixed) {
  const double step = 2.0 * std::numbers::pi / static_cast<double>(radii.size());
  const double cosine = std::cos(step), sine = std::sin(step);
  SplitArea area;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double triangle = triangle_area(radii[i], radii[(i + 1) % radii.size()], cosine, sine);
    (fixed[i] != 0 ? area.fixed : area.free) += triangle;
  }
  return area;
}

}  // namespace

double section_area_factor(std::size_t section_vertices) {
  static const std::array<double, kMaxSectionVertices + 1> factors = make_area_factors();
  assert(section_vertices < factors.size());
  return factors[section_vertices];
}

float section_area(std::span<const float> radii) {
  if (radii.empty()) return 0.0f;
  double sum = 0.0, last = radii.back();
  for (const float radius : radii) {
    sum += last * radius;
    last = radius;
  }
  return static_cast<float>(section_area_factor(radii.size()) * sum);
}

InflateOutcome inflate_section(std::span<float> radii, std::span<const std::uint8_t> fixed, float target_area,
                               float largest_scale) {
  assert(radii.size() == fixed.size() && largest_scale >= 1.0f);
  if (radii.size() < 3) return {};
  const ProductSums sums = sum_products(radii, fixed);
  if (!sums.any_free) return {.kind = Inflation::kAllFixed};
  const double factor = section_area_factor(radii.size());
  const double a = factor * sums.free_free, b = factor * sums.mixed, c = factor * sums.fixed_fixed - target_area;
  // A radius that is not finite spoils at least one of the sums.
  if (!std::isfinite(a + b + c) || (a == 0.0 && b == 0.0)) return {};

  const double most = largest_scale, least = 1.0 / most;
  const double wanted = scale_nearest_one(a, b, c);
  // Where the fixed radii alone have all the area there should be, the least of the free ones comes nearest.
  if (wanted == 0.0 && !(a >= 0.0 && b >= 0.0 && c >= 0.0)) return {};
  const float scale = static_cast<float>(std::clamp(wanted, least, most));
  for (std::size_t i = 0; i < radii.size(); ++i) radii[i] *= fixed[i] != 0 ? 1.0f : scale;
  return {wanted < least || wanted > most ? Inflation::kCapped : Inflation::kReached, scale};
}

IterativeInflation inflate_iteratively(std::span<float> radii, std::span<const std::uint8_t> fixed, float target_area,
                                       float tolerance, std::uint32_t most_iterations) {
  assert(radii.size() == fixed.size() && radii.size() <= kMaxSectionVertices);
  IterativeInflation result;
  const auto is_free = [&](std::size_t i) { return fixed[i] == 0 && radii[i] > 0.0f; };
  std::size_t first = 0;
  while (first < radii.size() && !is_free(first)) ++first;
  if (radii.size() < 3 || first == radii.size()) return result;

  // (4.5): what each free radius is of the first one.
  std::array<double, kMaxSectionVertices> factors;
  for (std::size_t i = 0; i < radii.size(); ++i) factors[i] = is_free(i) ? double{radii[i]} / radii[first] : 0.0;
  std::array<float, kMaxSectionVertices> tried;
  const std::span<float> trial = std::span(tried).first(radii.size());
  std::copy(radii.begin(), radii.end(), trial.begin());

  const auto missing_area = [&](std::span<const float> of) {
    const SplitArea area = measure_triangles(of, fixed);
    return target_area - area.fixed - area.free;
  };
  const double allowed = double{tolerance} * target_area;
  double reference = radii[first], growth = kIterativeGrowth;
  double missing = missing_area(radii);
  for (; missing > allowed && result.iterations < most_iterations; ++result.iterations) {
    const double grown = reference * (1.0 + growth);
    for (std::size_t i = 0; i < trial.size(); ++i) {
      if (factors[i] != 0.0) trial[i] = static_cast<float>(grown * factors[i]);
    }
    const double left = missing_area(trial);
    if (!(left >= 0.0)) {
      growth *= 0.5;
      continue;
    }
    reference = grown;
    missing = left;
    std::copy(trial.begin(), trial.end(), radii.begin());
  }
  result.converged = std::abs(missing) <= allowed;
  return result;
}

}  // namespace fascicle::muscle
