// Curves after D. A. Winter, The Biomechanics and Motor Control of Human Gait (1991), and J. Perry, Gait Analysis
// (1992): degrees at percent of the cycle from heel strike, read off the mean curves of natural cadence, joined by a
// periodic cubic.
#include "tools/walker/gait.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include <glm/geometric.hpp>

namespace fascicle::walker {
namespace {

struct Key {
  double percent;
  double degrees;
};

constexpr std::array kHipFlexion{Key{0, 29},  Key{8, 27},  Key{16, 20},  Key{24, 12},   Key{32, 3.5},
                                 Key{40, -4}, Key{48, -9}, Key{53, -10}, Key{58, -7.5}, Key{64, 0},
                                 Key{70, 10}, Key{77, 21}, Key{84, 28},  Key{90, 31},   Key{95, 30.5}};
constexpr std::array kHipAdduction{Key{0, 0.5}, Key{8, 3.5}, Key{15, 5.5},  Key{24, 5},  Key{35, 3.5}, Key{46, 2},
                                   Key{54, -1}, Key{62, -5}, Key{68, -5.5}, Key{78, -3}, Key{90, -0.5}};
constexpr std::array kHipRotation{Key{0, -1}, Key{15, 3}, Key{40, 2}, Key{58, -2}, Key{75, -3}, Key{90, -2.5}};
constexpr std::array kKneeFlexion{Key{0, 4},   Key{5, 9},   Key{10, 15.5}, Key{15, 18}, Key{21, 16.5}, Key{30, 10.5},
                                  Key{38, 6},  Key{44, 5},  Key{50, 9},    Key{55, 18}, Key{60, 34},   Key{66, 52},
                                  Key{71, 60}, Key{75, 59}, Key{81, 46},   Key{88, 22}, Key{94, 6},    Key{97, 3}};
constexpr std::array kAnkle{Key{0, 0},    Key{4, -3.5}, Key{8, -4.5}, Key{14, -0.5}, Key{22, 4},   Key{32, 7},
                            Key{42, 9.5}, Key{47, 9},   Key{52, 4},   Key{57, -7},   Key{62, -17}, Key{65, -17.5},
                            Key{71, -9},  Key{78, -1},  Key{86, 2.5}, Key{94, 1}};
constexpr std::array kToes{Key{0, 12},  Key{7, 2},   Key{14, 0}, Key{36, 0}, Key{44, 6}, Key{51, 20},
                           Key{58, 28}, Key{63, 16}, Key{69, 6}, Key{78, 8}, Key{90, 14}};
constexpr std::array kPelvisTilt{Key{0, 1.2}, Key{12, 0}, Key{25, -1}, Key{38, 0.2}};  // twice a cycle
// Right side up.
constexpr std::array kPelvisObliquity{Key{0, 0},  Key{10, 3.5},  Key{18, 4},  Key{30, 1.5},
                                      Key{50, 0}, Key{60, -3.5}, Key{68, -4}, Key{80, -1.5}};
// Right side forward.
constexpr std::array kPelvisRotation{Key{0, 4.5},   Key{12, 3.5},  Key{30, -0.5},
                                     Key{50, -4.5}, Key{62, -3.5}, Key{80, 0.5}};

// Catmull-Rom over uneven keys, periodic in `period` percent; radians.
double curve(std::span<const Key> keys, double phase, double period = 100.0) {
  const auto n = static_cast<int>(keys.size());
  const double at = (phase * 100.0) - period * std::floor(phase * 100.0 / period);
  const auto key = [&](int i) {
    const int wraps = i < 0 ? -1 : (i >= n ? 1 : 0);
    const Key k = keys[static_cast<std::size_t>(i - wraps * n)];
    return Key{k.percent + wraps * period, k.degrees};
  };
  int k = 0;
  while (k + 1 < n && keys[static_cast<std::size_t>(k + 1)].percent <= at) ++k;
  const Key a = key(k - 1), b = key(k), c = key(k + 1), d = key(k + 2);
  const double h = c.percent - b.percent, t = (at - b.percent) / h;
  const double slope_b = h * (c.degrees - a.degrees) / (c.percent - a.percent);
  const double slope_c = h * (d.degrees - b.degrees) / (d.percent - b.percent);
  const double t2 = t * t, t3 = t2 * t;
  const double degrees = (2 * t3 - 3 * t2 + 1) * b.degrees + (t3 - 2 * t2 + t) * slope_b +
                         (3 * t2 - 2 * t3) * c.degrees + (t3 - t2) * slope_c;
  return degrees * std::numbers::pi / 180.0;
}

glm::quat turn(const glm::vec3& opensim_axis, double angle) {
  const glm::vec3 axis = glm::normalize(from_opensim(opensim_axis));
  const auto half = static_cast<float>(0.5 * angle);
  return {std::cos(half), std::sin(half) * axis};
}

void pose_leg(Pose& pose, const char* side, double phase) {
  const std::string s = side;
  // Turns about x and y change sign from one side to the other, turns about the lateral axis do not.
  const float sign = s == "_r" ? 1.0f : -1.0f;
  const auto at = [](const std::string& bone) { return static_cast<std::size_t>(find_bone(bone)); };
  const double knee = -curve(kKneeFlexion, phase);
  pose.rotation[at("femur" + s)] = turn({0, 0, 1}, curve(kHipFlexion, phase)) *
                                   turn({sign, 0, 0}, curve(kHipAdduction, phase)) *
                                   turn({0, sign, 0}, curve(kHipRotation, phase));
  pose.rotation[at("tibia" + s)] = turn({0, 0, 1}, knee);
  pose.translation[at("tibia" + s)] = tibia_in_femur(static_cast<float>(knee));
  glm::vec3 pole = patella_pole_in_tibia(static_cast<float>(knee));
  pole.x *= sign;
  pose.translation[at("patella" + s)] = pole;
  // The patella turns about half as far against the tibia as the knee does, the other way.
  pose.rotation[at("patella" + s)] = turn({0, 0, 1}, -0.45 * knee);
  pose.rotation[at("talus" + s)] = turn({-0.105f * sign, -0.174f * sign, 0.979f}, curve(kAnkle, phase));
  pose.rotation[at("toes" + s)] = turn({-0.18f * sign, 0.0f, 0.98f}, curve(kToes, phase));
}

}  // namespace

Pose gait_pose(double phase) {
  Pose pose = rest_pose();
  pose.rotation[0] = turn({0, 1, 0}, curve(kPelvisRotation, phase)) * turn({-1, 0, 0}, curve(kPelvisObliquity, phase)) *
                     turn({0, 0, 1}, curve(kPelvisTilt, phase, 50.0));
  // The trunk stays nearly level: its stump undoes half of the pelvis's turns.
  const auto torso = static_cast<std::size_t>(find_bone("torso"));
  pose.rotation[torso] =
      turn({1, 0, 0}, 0.4 * curve(kPelvisObliquity, phase)) * turn({0, 1, 0}, -0.4 * curve(kPelvisRotation, phase));
  pose_leg(pose, "_r", phase);
  pose_leg(pose, "_l", phase + 0.5);
  return pose;
}

std::vector<float> pelvis_heights(const std::vector<float>& lowest, float floor) {
  // The mean and the first even harmonics of what would put the lowest point on the floor: the two sides are alike.
  const auto n = static_cast<double>(lowest.size());
  std::vector<float> heights(lowest.size(), 0.0f);
  for (int harmonic = 0; harmonic <= 10; harmonic += 2) {
    double a = 0.0, b = 0.0;
    for (std::size_t i = 0; i < lowest.size(); ++i) {
      const double angle = 2.0 * std::numbers::pi * harmonic * static_cast<double>(i) / n;
      a += (floor - lowest[i]) * std::cos(angle) / n;
      b += (floor - lowest[i]) * std::sin(angle) / n;
    }
    const double weight = harmonic == 0 ? 1.0 : 2.0;
    for (std::size_t i = 0; i < lowest.size(); ++i) {
      const double angle = 2.0 * std::numbers::pi * harmonic * static_cast<double>(i) / n;
      heights[i] += static_cast<float>(weight * (a * std::cos(angle) + b * std::sin(angle)));
    }
  }
  return heights;
}

}  // namespace fascicle::walker
