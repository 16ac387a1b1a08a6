#include "engine/animation/motion.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <glm/vec3.hpp>

#include "engine/animation/joint_model.hpp"

namespace fascicle {
namespace {

constexpr double kTravelSpeed = 0.1;        // m/s, slower level drift is that of a treadmill
constexpr double kVelocityWeight = 0.1;     // s: how much a velocity's difference counts beside an angle's
constexpr std::size_t kCycleCandidates = 400;  // bounds the pairs compared in long records

// Slope at t1 of the parabola through three points.
double parabola_slope(double t0, double t1, double t2, double v0, double v1, double v2) {
  const double h0 = t1 - t0;
  const double h1 = t2 - t1;
  return ((v1 - v0) / h0 * h1 + (v2 - v1) / h1 * h0) / (h0 + h1);
}

void fill_slopes(Motion& motion) {
  const std::size_t n = motion.times.size();
  const std::size_t m = motion.coordinates;
  const auto& t = motion.times;
  motion.slopes.assign(n * m, 0.0);
  if (n < 2) return;
  for (std::size_t c = 0; c < m; ++c) {
    const auto v = [&](std::size_t i) { return motion.values[i * m + c]; };
    const auto secant = [&](std::size_t i) { return (v(i + 1) - v(i)) / (t[i + 1] - t[i]); };
    if (n == 2) {
      motion.slopes[c] = motion.slopes[m + c] = secant(0);
      continue;
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
      motion.slopes[i * m + c] = parabola_slope(t[i - 1], t[i], t[i + 1], v(i - 1), v(i), v(i + 1));
    }
    // The end slopes of the outermost parabolas: twice the secant less the slope at the inner point.
    motion.slopes[c] = 2.0 * secant(0) - motion.slopes[m + c];
    motion.slopes[(n - 1) * m + c] = 2.0 * secant(n - 2) - motion.slopes[(n - 2) * m + c];
  }
}

// 1 for each coordinate that moves a child of the ground along a level axis.
std::vector<std::uint8_t> find_horizontal(const JointModel& model) {
  std::vector<std::uint8_t> horizontal(model.coordinates.size(), 0);
  for (const Joint& joint : model.joints) {
    if (joint.parent != 0) continue;
    for (const JointAxis& axis : joint.translations) {
      if (axis.coordinate < 0) continue;
      const glm::dvec3 direction = joint.parent_frame.rotation * axis.direction;
      if (std::abs(direction.y) < 0.1) horizontal[static_cast<std::size_t>(axis.coordinate)] = 1;
    }
  }
  return horizontal;
}

void fill_cycle(Motion& motion) {
  const std::size_t m = motion.coordinates;
  std::vector<double> at_start(m);
  std::vector<double> at_end(m);
  sample_motion(motion, motion.cycle.start, at_start);
  sample_motion(motion, motion.cycle.end, at_end);
  motion.cycle_change.resize(m);
  motion.cycle_mean.assign(m, 0.0);
  for (std::size_t c = 0; c < m; ++c) motion.cycle_change[c] = at_end[c] - at_start[c];
  constexpr int kSamples = 64;
  std::vector<double> sample(m);
  for (int i = 0; i < kSamples; ++i) {
    sample_motion(motion, motion.cycle.start + motion.cycle.length() * (i + 0.5) / kSamples, sample);
    for (std::size_t c = 0; c < m; ++c) motion.cycle_mean[c] += sample[c] / kSamples;
  }
}

MotionCycle choose_cycle_among(const Motion& motion, const std::vector<std::size_t>& angles, double shortest) {
  const std::size_t n = motion.times.size();
  const std::size_t m = motion.coordinates;
  const std::size_t stride = (n + kCycleCandidates - 1) / kCycleCandidates;
  MotionCycle best{motion.times.front(), motion.times.back()};
  if (angles.empty()) return best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; i += stride) {
    for (std::size_t j = i + 2; j < n; j += stride) {
      if (motion.times[j] - motion.times[i] < shortest) continue;
      double difference = 0.0;
      for (const std::size_t c : angles) {
        const double value = motion.values[j * m + c] - motion.values[i * m + c];
        const double slope = kVelocityWeight * (motion.slopes[j * m + c] - motion.slopes[i * m + c]);
        difference += value * value + slope * slope;
      }
      if (difference < least) {
        least = difference;
        best = {motion.times[i], motion.times[j]};
      }
    }
  }
  return best;
}

}  // namespace

void finish_motion(Motion& motion, const JointModel& model) {
  assert(!motion.times.empty() && motion.coordinates == model.coordinates.size());
  assert(motion.values.size() == motion.times.size() * motion.coordinates);
  fill_slopes(motion);
  motion.horizontal = find_horizontal(model);
  std::vector<std::size_t> angles;
  for (std::size_t c = 0; c < motion.coordinates; ++c) {
    if (model.coordinates[c].kind == JointCoordinate::Kind::kRotation) angles.push_back(c);
  }
  motion.cycle = choose_cycle_among(motion, angles, 0.6);
  fill_cycle(motion);
}

void loop_whole_record(Motion& motion) {
  motion.cycle = {motion.times.front(), motion.times.back()};
  fill_cycle(motion);
  std::ranges::fill(motion.cycle_change, 0.0);
}

void sample_motion(const Motion& motion, double time, std::span<double> values) {
  const std::size_t m = motion.coordinates;
  assert(values.size() == m);
  const auto& t = motion.times;
  const auto copy_row = [&](std::size_t row) {
    std::copy_n(motion.values.begin() + static_cast<std::ptrdiff_t>(row * m), m, values.begin());
  };
  if (!(time > t.front())) return copy_row(0);
  if (time >= t.back()) return copy_row(t.size() - 1);
  const auto after = std::upper_bound(t.begin(), t.end(), time);
  const auto j = static_cast<std::size_t>(after - t.begin());
  const std::size_t i = j - 1;
  const double h = t[j] - t[i];
  const double u = (time - t[i]) / h;
  const double u2 = u * u;
  const double u3 = u2 * u;
  const double weight_to = 3.0 * u2 - 2.0 * u3;
  for (std::size_t c = 0; c < m; ++c) {
    const double from = motion.values[i * m + c];
    const double to = motion.values[j * m + c];
    values[c] = from + (to - from) * weight_to + h * ((u3 - 2.0 * u2 + u) * motion.slopes[i * m + c] +
                                                      (u3 - u2) * motion.slopes[j * m + c]);
  }
}

void sample_cycle(const Motion& motion, double time, bool in_place, std::span<double> values) {
  const double length = motion.cycle.length();
  if (!(length > 0.0) || !std::isfinite(time)) return sample_motion(motion, motion.cycle.start, values);
  const double cycles = std::floor(time / length);
  const double fraction = std::clamp(time / length - cycles, 0.0, 1.0);
  sample_motion(motion, motion.cycle.start + fraction * length, values);
  for (std::size_t c = 0; c < motion.coordinates; ++c) {
    const double change = motion.cycle_change[c];
    const bool level = motion.horizontal[c] != 0;
    if (level && !in_place && std::abs(change) > kTravelSpeed * length) {
      values[c] += cycles * change;
    } else {
      values[c] -= change * (fraction - 0.5);
      if (level && in_place) values[c] -= motion.cycle_mean[c];
    }
  }
}

}  // namespace fascicle
