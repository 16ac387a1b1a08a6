// The overlay's panels: what an OverlayModel looks like. Internal to the overlay.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/render/overlay.hpp"

namespace fascicle {

// The last values of one timing, oldest at `next`.
struct TimingHistory {
  static constexpr int kLength = 120;
  std::string name;
  std::array<float, kLength> values{};  // ms
  int next = 0;
  float average = 0.0f;  // ms, over about the last half second

  void push(float milliseconds);
};

struct OverlayHistory {
  TimingHistory frame;
  std::vector<TimingHistory> systems, gpu;

  // Appends the model's values. Lists that changed their names start anew.
  void push(const OverlayModel& model);
};

struct OverlayMemory {
  OverlayHistory history;
  std::array<char, 64> filter{};  // of the item list
};

// Lays out all panels in the current ImGui frame; `width` and `height` of the picture in pixels.
OverlayActions lay_out_overlay(const OverlayModel& model, float width, float height, OverlayMemory& memory);

}  // namespace fascicle
