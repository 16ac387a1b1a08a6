// A headless context for a test, whose end fails where GL reported an error. Skips where EGL can make no context.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "engine/render/headless.hpp"
#include "engine/render/renderer.hpp"

namespace fascicle {

class RenderFixture : public testing::Test {
 protected:
  void SetUp() override {
    Result<std::unique_ptr<Headless>> headless = Headless::create();
    if (!headless.ok()) GTEST_SKIP() << "no EGL context: " << to_text(headless.diagnostics());
    headless_ = std::move(*headless);
    log_ = std::make_unique<GlDebugLog>();
  }

  void TearDown() override {
    renderer_.reset();
    if (log_ == nullptr) return;
    for (const std::string& error : log_->take_errors()) ADD_FAILURE() << error;
    log_.reset();
  }

  Renderer& make_renderer(const RendererOptions& options) {
    Result<std::unique_ptr<Renderer>> made = Renderer::create(options);
    if (!made.ok()) throw std::runtime_error(to_text(made.diagnostics()));
    renderer_ = std::move(*made);
    return *renderer_;
  }

  std::unique_ptr<Headless> headless_;
  std::unique_ptr<GlDebugLog> log_;
  std::unique_ptr<Renderer> renderer_;
};

// A picture of 200 x 100 without multisampling, and a view along -z that is nearly parallel: one pixel is
// kMetresPerPixel at the target.
inline constexpr int kTestWidth = 200, kTestHeight = 100;
inline constexpr float kMetresPerPixel = 0.005f;

inline RendererOptions test_options() {
  RendererOptions options;
  options.width = kTestWidth;
  options.height = kTestHeight;
  options.samples = 0;
  options.shadow_size = 0;
  return options;
}

inline DrawView test_view() {
  DrawView view;
  view.camera.target = glm::vec3(0.0f);
  view.camera.distance = 25.0f;
  view.camera.yaw = 0.0f;
  view.camera.pitch = 0.0f;
  view.camera.fov = 2.0f * std::atan(0.5f * kTestHeight * kMetresPerPixel / view.camera.distance);
  view.ground = false;
  view.shadow = false;
  view.background = glm::vec3(0.0f, 0.0f, 1.0f);
  return view;
}

inline bool is_background(const std::uint8_t* pixel) { return pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 255; }
inline bool is_magenta(const std::uint8_t* pixel) { return pixel[0] > 250 && pixel[1] < 5 && pixel[2] > 250; }

// Magenta pixels all of whose neighbours are magenta too. Single ones occur on outlines, where a face seen edge-on may
// win a pixel by rounding; a hole or an inverted face shows more.
inline int count_back_faces(const Image& image) {
  int count = 0;
  for (int y = 1; y + 1 < image.height; ++y) {
    for (int x = 1; x + 1 < image.width; ++x) {
      const auto at = [&](int dx, int dy) { return is_magenta(image.pixel(x + dx, y + dy)); };
      count += at(0, 0) && at(-1, 0) && at(1, 0) && at(0, -1) && at(0, 1);
    }
  }
  return count;
}

struct Coverage {
  int pixels = 0;
  double centre_x = 0.0, centre_y = 0.0;  // pixels from the picture's centre, y up
  int left = 0, right = 0, top = 0, bottom = 0;  // first and last covered column and row
  bool gap_free = true;  // each row's covered pixels are one run
};

inline Coverage measure(const Image& image) {
  Coverage coverage;
  coverage.left = image.width;
  coverage.top = image.height;
  coverage.right = coverage.bottom = -1;
  for (int y = 0; y < image.height; ++y) {
    int first = -1, last = -1, count = 0;
    for (int x = 0; x < image.width; ++x) {
      if (is_background(image.pixel(x, y))) continue;
      if (first < 0) first = x;
      last = x;
      ++count;
      coverage.centre_x += x + 0.5 - 0.5 * image.width;
      coverage.centre_y += 0.5 * image.height - (y + 0.5);
    }
    if (count == 0) continue;
    coverage.pixels += count;
    coverage.left = std::min(coverage.left, first);
    coverage.right = std::max(coverage.right, last);
    coverage.top = std::min(coverage.top, y);
    coverage.bottom = y;
    if (last - first + 1 != count) coverage.gap_free = false;
  }
  if (coverage.pixels > 0) {
    coverage.centre_x /= coverage.pixels;
    coverage.centre_y /= coverage.pixels;
  }
  return coverage;
}

}  // namespace fascicle
