#include "engine/render/renderer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/render/render_fixture.hpp"
#include "tests/engine/render/tube_surface.hpp"

namespace fascicle {
namespace {

using testing::HasSubstr;

class RendererTest : public RenderFixture {};

TEST_F(RendererTest, ContextIsAtLeastFourFive) {
  EXPECT_GE(headless_->info().major * 10 + headless_->info().minor, 45) << headless_->info().version;
  EXPECT_FALSE(headless_->info().renderer.empty());
}

TEST_F(RendererTest, RefusesImpossibleSizes) {
  for (const auto& [width, height] : {std::pair{0, 100}, std::pair{100, -1}, std::pair{1 << 20, 100}}) {
    RendererOptions options;
    options.width = width;
    options.height = height;
    const auto made = Renderer::create(options);
    ASSERT_FALSE(made.ok());
    EXPECT_THAT(to_text(made.diagnostics()), HasSubstr("each side takes 1 to"));
  }
}

TEST_F(RendererTest, EmptySceneIsTheBackgroundExactly) {
  Renderer& renderer = make_renderer(test_options());
  DrawView view = test_view();
  view.background = glm::vec3(0.21404f, 0.0f, 1.0f);  // 0.21404 linear is 127.5 of 255 in sRGB
  renderer.draw(view);
  const Image image = renderer.read_image();
  EXPECT_EQ(image.width, kTestWidth);
  EXPECT_EQ(image.height, kTestHeight);
  EXPECT_NEAR(image.pixel(100, 50)[0], 127.5, 1.0);
  EXPECT_EQ(image.pixel(100, 50)[1], 0);
  EXPECT_EQ(image.pixel(100, 50)[2], 255);
  EXPECT_EQ(renderer.stats().draw_calls, 0u);
}

TEST_F(RendererTest, MultisamplingSmoothsEdgesAndKeepsTheRest) {
  const TubeSurface tube = make_cylinder(0.6f, 0.1f, 24, 10.0f);
  std::vector<Image> images;
  for (const int samples : {0, 4}) {
    RendererOptions options = test_options();
    options.samples = samples;
    Renderer& renderer = make_renderer(options);
    const StripHandle strips = renderer.add_strips(renderer.add_strip_topology(tube.topology));
    renderer.begin_step();
    std::copy(tube.vertices.begin(), tube.vertices.end(), renderer.strip_vertices(strips).begin());
    std::copy(tube.rows.begin(), tube.rows.end(), renderer.strip_rows(strips).begin());
    DrawView view = test_view();
    view.camera.target.y = 0.0012f;  // edges between pixels
    renderer.draw(view);
    images.push_back(renderer.read_image());
  }
  int mixed = 0;
  for (int x = 60; x < 140; ++x) {
    const std::uint8_t* inside = images[1].pixel(x, 50);
    EXPECT_NEAR(inside[0], images[0].pixel(x, 50)[0], 6);
    for (int y = 20; y < 80; ++y) {
      const std::uint8_t* pixel = images[1].pixel(x, y);
      if (!is_background(pixel) && pixel[2] > 120) ++mixed;  // part tube, part blue background
    }
  }
  EXPECT_GE(mixed, 80);
  EXPECT_FALSE(is_background(images[1].pixel(100, 50)));
}

TEST_F(RendererTest, ResizeChangesThePicture) {
  Renderer& renderer = make_renderer(test_options());
  renderer.resize(64, 32);
  renderer.draw(test_view());
  EXPECT_EQ(renderer.read_image().width, 64);
  renderer.resize(0, 0);
  EXPECT_EQ(renderer.height(), 32);
}

TEST_F(RendererTest, GroundHasGridAndShadow) {
  const TubeSurface tube = make_cylinder(0.6f, 0.1f, 24, 10.0f);
  RendererOptions options = test_options();
  options.shadow_size = 512;
  Renderer& renderer = make_renderer(options);
  const StripHandle strips = renderer.add_strips(renderer.add_strip_topology(tube.topology));
  renderer.begin_step();
  auto vertices = renderer.strip_vertices(strips);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i] = {tube.vertices[i].position + glm::vec3(0, 0.4f, 0), tube.vertices[i].normal};
  }
  std::copy(tube.rows.begin(), tube.rows.end(), renderer.strip_rows(strips).begin());
  DrawView view;
  view.camera = {.target = {0, 0.3f, 0}, .distance = 2.0f, .yaw = 0.0f, .pitch = 0.6f, .fov = 0.9f};
  view.strips = true;
  renderer.draw(view);
  const Image shadowed = renderer.read_image();
  EXPECT_EQ(renderer.stats().draw_calls, 5u) << "strips and fans twice, ground";
  view.shadow = false;
  renderer.draw(view);
  const Image unshadowed = renderer.read_image();
  int darker = 0, brighter = 0;
  for (int y = 0; y < kTestHeight; ++y) {
    for (int x = 0; x < kTestWidth; ++x) {
      const int difference = shadowed.pixel(x, y)[1] - unshadowed.pixel(x, y)[1];
      darker += difference < -8;
      brighter += difference > 0;
    }
  }
  EXPECT_GT(darker, 150);
  EXPECT_LT(darker, 3000);
  EXPECT_EQ(brighter, 0);
}

TEST_F(RendererTest, PassesAreTimedFramesLater) {
  Renderer& renderer = make_renderer(test_options());
  for (int frame = 0; frame < 8; ++frame) {
    renderer.draw(test_view());
    (void)renderer.read_image();
  }
  ASSERT_FALSE(renderer.gpu_times().empty());
  EXPECT_GT(renderer.timer().measured_frame(), 0u);
  bool strips_timed = false;
  for (const GpuTime& time : renderer.gpu_times()) {
    EXPECT_GE(time.milliseconds, 0.0);
    EXPECT_TRUE(std::isfinite(time.milliseconds));
    if (time.name == "strips") strips_timed = true;
  }
  EXPECT_TRUE(strips_timed);
}

}  // namespace
}  // namespace fascicle
