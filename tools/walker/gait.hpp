// One gait cycle in place: joint angles of normal level walking as published, sampled into poses.
#pragma once

#include <string>
#include <vector>

#include "tools/walker/skeleton.hpp"

namespace fascicle::walker {

inline constexpr float kCycleSeconds = 1.1f;
inline constexpr int kGaitKeys = 66;  // plus a last one equal to the first

// The pose at a fraction of the cycle, right heel strike at 0; the pelvis at its rest height.
Pose gait_pose(double phase);

struct Gait {
  std::vector<float> times;  // s
  std::vector<Pose> poses;
};
// kGaitKeys + 1 poses, the last equal to the first. `lowest` gives the height (m) of the lowest point of the feet in a
// pose: the pelvis is lowered or raised smoothly so that the standing foot stays near `floor`.
template <class F>
Gait make_gait(F&& lowest, float floor);
// The smooth pelvis heights (m to add) whose lowest points are `lowest`.
std::vector<float> pelvis_heights(const std::vector<float>& lowest, float floor);

template <class F>
Gait make_gait(F&& lowest, float floor) {
  Gait gait;
  std::vector<float> low;
  for (int i = 0; i < kGaitKeys; ++i) {
    gait.poses.push_back(gait_pose(static_cast<double>(i) / kGaitKeys));
    low.push_back(lowest(gait.poses.back()));
  }
  const std::vector<float> rise = pelvis_heights(low, floor);
  for (int i = 0; i < kGaitKeys; ++i)
    gait.poses[static_cast<std::size_t>(i)].translation[0].y += rise[static_cast<std::size_t>(i)];
  gait.poses.push_back(gait.poses.front());
  for (int i = 0; i <= kGaitKeys; ++i) gait.times.push_back(kCycleSeconds * static_cast<float>(i) / kGaitKeys);
  return gait;
}

}  // namespace fascicle::walker
