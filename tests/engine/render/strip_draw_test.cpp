// Strip surfaces as they come out of the renderer: shape, closedness, colours, interpolation, and how they are sent.
#include <gtest/gtest.h>

#include "tests/engine/render/render_fixture.hpp"
#include "tests/engine/render/tube_surface.hpp"

namespace fascicle {
namespace {

class StripDraw : public RenderFixture {
 protected:
  void write(StripHandle strips, const TubeSurface& tube, const glm::vec3& offset = glm::vec3(0.0f)) {
    auto vertices = renderer_->strip_vertices(strips);
    ASSERT_EQ(vertices.size(), tube.vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      vertices[i] = {tube.vertices[i].position + offset, tube.vertices[i].normal};
    }
    std::copy(tube.rows.begin(), tube.rows.end(), renderer_->strip_rows(strips).begin());
  }
  StripHandle add(const TubeSurface& tube) {
    return renderer_->add_strips(renderer_->add_strip_topology(tube.topology));
  }
  Image draw(const DrawView& view) {
    renderer_->draw(view);
    return renderer_->read_image();
  }
};

TEST_F(StripDraw, NothingIsDrawnBeforeItIsWritten) {
  make_renderer(test_options());
  const TubeSurface tube = make_cylinder(0.6f, 0.1f, 24, 10.0f);
  const StripHandle strips = add(tube);
  EXPECT_EQ(measure(draw(test_view())).pixels, 0);
  renderer_->begin_step();
  EXPECT_EQ(measure(draw(test_view())).pixels, 0);
  write(strips, tube);
  EXPECT_GT(measure(draw(test_view())).pixels, 0);
}

TEST_F(StripDraw, CylinderCoversWhatGeometrySays) {
  make_renderer(test_options());
  const TubeSurface tube = make_cylinder(0.6f, 0.1f, 36, 10.0f);
  const StripHandle strips = add(tube);
  renderer_->begin_step();
  write(strips, tube);
  const Coverage coverage = measure(draw(test_view()));
  const double expected = 0.6 * 0.2 / (kMetresPerPixel * kMetresPerPixel);
  EXPECT_NEAR(coverage.pixels, expected, 0.02 * expected);
  EXPECT_NEAR(coverage.centre_x, 0.0, 0.3);
  EXPECT_NEAR(coverage.centre_y, 0.0, 0.3);
  EXPECT_NEAR(coverage.right - coverage.left + 1, 120, 1);
  EXPECT_NEAR(coverage.bottom - coverage.top + 1, 40, 1);
  EXPECT_TRUE(coverage.gap_free);
}

TEST_F(StripDraw, ClosedFromAllSidesWithNoBackFaceInSight) {
  make_renderer(test_options());
  const TubeSurface tube = make_cylinder(0.3f, 0.1f, 8, 10.0f, 5);
  const StripHandle strips = add(tube);
  renderer_->begin_step();
  write(strips, tube);
  DrawView view = test_view();
  view.back_faces = true;
  for (int i = 0; i < 24; ++i) {
    view.camera.yaw = 0.2618f * static_cast<float>(i);
    view.camera.pitch = 0.9f * std::sin(1.3f * static_cast<float>(i));
    const Image image = draw(view);
    const Coverage coverage = measure(image);
    EXPECT_TRUE(coverage.gap_free) << "background shows through a convex shape, view " << i;
    EXPECT_GT(coverage.pixels, 500);
    EXPECT_EQ(count_back_faces(image), 0) << "view " << i;
  }
}

TEST_F(StripDraw, InvertedSurfaceShowsItsBackFaces) {
  make_renderer(test_options());
  TubeSurface tube = make_cylinder(0.6f, 0.1f, 24, 10.0f);
  const StripHandle strips = add(tube);
  renderer_->begin_step();
  for (DrawVertex& vertex : tube.vertices) vertex.position.z = -vertex.position.z;
  write(strips, tube);
  DrawView view = test_view();
  view.back_faces = true;
  EXPECT_TRUE(is_magenta(draw(view).pixel(100, 50)));
}

TEST_F(StripDraw, TendonBeginsWhereItsCoordinateChangesSign) {
  make_renderer(test_options());
  const TubeSurface tube = make_cylinder(0.6f, 0.1f, 24, 0.13f, 5);  // the border lies inside a segment
  const StripHandle strips = add(tube);
  renderer_->begin_step();
  write(strips, tube);
  DrawView view = test_view();
  const Image image = draw(view);
  const auto is_tendon = [&](int x) { return image.pixel(x, 50)[1] > image.pixel(x, 50)[0] / 2; };
  const int border = 100 + static_cast<int>(0.13f / kMetresPerPixel);
  for (int x = 45; x < border - 2; ++x) EXPECT_FALSE(is_tendon(x)) << x;
  for (int x = border + 2; x < 155; ++x) EXPECT_TRUE(is_tendon(x)) << x;
  // Between the two the colour changes over a few pixels, not at once.
  const int before = image.pixel(border - 2, 50)[1], at = image.pixel(border, 50)[1],
            after = image.pixel(border + 2, 50)[1];
  EXPECT_LT(before, at + 1);
  EXPECT_LT(at, after + 1);

  view.tendons = false;
  const Image plain = draw(view);
  EXPECT_LT(plain.pixel(150, 50)[1], plain.pixel(150, 50)[0] / 2) << "belly everywhere";
}

TEST_F(StripDraw, ItemsAreHiddenHighlightedAndColoured) {
  make_renderer(test_options());
  TubeSurface tubes = make_cylinder(0.3f, 0.05f, 12, 10.0f, 3);
  append_tube({{-0.15f, 0.15f, 0.0f}, {0.15f, 0.15f, 0.0f}}, {0.05f, 0.05f}, {1.0f, 1.0f}, 12, tubes);
  const StripHandle strips = add(tubes);
  renderer_->begin_step();
  write(strips, tubes);
  const Image plain = draw(test_view());
  EXPECT_FALSE(is_background(plain.pixel(100, 50)));
  EXPECT_FALSE(is_background(plain.pixel(100, 20)));
  renderer_->strip_items(strips)[0].flags = kItemHidden;
  renderer_->strip_items(strips)[1].belly_colour = pack_colour({0.1f, 0.9f, 0.1f, 1.0f});
  const Image changed = draw(test_view());
  EXPECT_TRUE(is_background(changed.pixel(100, 50)));
  EXPECT_GT(changed.pixel(100, 20)[1], 2 * changed.pixel(100, 20)[0]);
  renderer_->strip_items(strips)[0].flags = kItemHighlighted;
  const Image highlighted = draw(test_view());
  EXPECT_GT(highlighted.pixel(100, 50)[1], plain.pixel(100, 50)[1] + 30);
  renderer_->strip_items(strips)[0] = StripItem{.activation = 1.0f};
  EXPECT_GT(draw(test_view()).pixel(100, 50)[0], plain.pixel(100, 50)[0] + 20);
}

TEST_F(StripDraw, InterpolatesBetweenTheLastTwoSteps) {
  make_renderer(test_options());
  const TubeSurface tube = make_cylinder(0.2f, 0.1f, 24, 10.0f);
  const StripHandle strips = add(tube);
  DrawView view = test_view();
  view.alpha = 0.0f;
  renderer_->begin_step();
  write(strips, tube, {-0.1f, 0.0f, 0.0f});
  EXPECT_NEAR(measure(draw(view)).centre_x, -20.0, 0.3) << "one step: drawn where it is, whatever alpha";
  renderer_->begin_step();
  write(strips, tube, {0.1f, 0.0f, 0.0f});
  for (const float alpha : {0.0f, 0.25f, 0.5f, 1.0f}) {
    view.alpha = alpha;
    EXPECT_NEAR(measure(draw(view)).centre_x, -20.0 + 40.0 * static_cast<double>(alpha), 0.3);
  }
  view.alpha = 0.5f;
  for (int step = 0; step < 7; ++step) {  // through all slots, and around again
    renderer_->begin_step();
    write(strips, tube, {0.1f + 0.02f * static_cast<float>(step + 1), 0.0f, 0.0f});
    EXPECT_NEAR(measure(draw(view)).centre_x, 20.0 + 4.0 * step + 2.0, 0.3);
  }
}

TEST_F(StripDraw, TeleportIsNotInterpolated) {
  make_renderer(test_options());
  const TubeSurface tube = make_cylinder(0.2f, 0.1f, 24, 10.0f);
  const StripHandle whole = add(tube), item = add(tube);
  DrawView view = test_view();
  view.alpha = 0.5f;
  renderer_->set_visible(item, false);
  renderer_->begin_step();
  write(whole, tube, {-0.2f, 0.0f, 0.0f});
  write(item, tube, {-0.2f, 0.0f, 0.0f});
  renderer_->begin_step();
  write(whole, tube, {0.2f, 0.0f, 0.0f});
  write(item, tube, {0.2f, 0.0f, 0.0f});
  renderer_->mark_teleported(whole);
  EXPECT_NEAR(measure(draw(view)).centre_x, 40.0, 0.3);
  renderer_->set_visible(whole, false);
  renderer_->set_visible(item, true);
  EXPECT_NEAR(measure(draw(view)).centre_x, 0.0, 0.3);
  renderer_->strip_items(item)[0].flags = kItemTeleported;
  EXPECT_NEAR(measure(draw(view)).centre_x, 40.0, 0.3);

  renderer_->set_visible(item, false);
  renderer_->set_visible(whole, true);
  renderer_->begin_step();
  write(whole, tube, {0.1f, 0.0f, 0.0f});
  EXPECT_NEAR(measure(draw(view)).centre_x, 30.0, 0.3) << "the step after a jump is interpolated again";
}

TEST_F(StripDraw, WhatAStepDoesNotWriteStaysWhereItWas) {
  make_renderer(test_options());
  const TubeSurface tube = make_cylinder(0.2f, 0.1f, 24, 10.0f);
  const StripHandle strips = add(tube);
  DrawView view = test_view();
  view.alpha = 0.3f;
  renderer_->begin_step();
  write(strips, tube, {0.1f, 0.0f, 0.0f});
  for (int step = 0; step < 7; ++step) {
    renderer_->begin_step();
    if (step % 2 == 0) {
      EXPECT_NEAR(measure(draw(view)).centre_x, 20.0, 0.3) << step;
    }
  }
}

TEST_F(StripDraw, ManyInstancesGoOutInTwoCallsWithoutReallocation) {
  make_renderer(test_options());
  const TubeSurface tube = make_cylinder(0.03f, 0.02f, 8, 10.0f, 3);
  const StripTopologyHandle topology = renderer_->add_strip_topology(tube.topology);
  std::vector<StripHandle> instances;
  for (int i = 0; i < 200; ++i) instances.push_back(renderer_->add_strips(topology));
  const auto offset = [](int i) {
    const auto column = static_cast<float>(i % 20 - 10), row = static_cast<float>(i / 20 - 5);
    return glm::vec3(0.045f * column + 0.02f, 0.045f * row + 0.02f, 0.0f);
  };
  std::uint64_t allocations = 0;
  for (int step = 0; step < 12; ++step) {
    renderer_->begin_step();
    for (int i = 0; i < 200; ++i) write(instances[static_cast<std::size_t>(i)], tube, offset(i));
    renderer_->draw(test_view());
    EXPECT_EQ(renderer_->stats().strip_draw_calls, 2u);
    if (step == 3) allocations = renderer_->stats().buffer_allocations;
  }
  EXPECT_EQ(renderer_->stats().draw_calls, 2u);
  EXPECT_EQ(renderer_->stats().strip_vertices, 200u * tube.vertices.size());
  EXPECT_EQ(renderer_->stats().buffer_allocations, allocations);
  const Image image = renderer_->read_image();
  for (int i = 0; i < 200; ++i) {
    const glm::vec3 at = offset(i) / kMetresPerPixel;
    const int x = 100 + static_cast<int>(std::floor(at.x)), y = 50 - static_cast<int>(std::floor(at.y));
    EXPECT_FALSE(is_background(image.pixel(x, y))) << i;
  }
}

TEST_F(StripDraw, AddingAndRemovingLeavesTheOthersAlone) {
  make_renderer(test_options());
  const TubeSurface left_tube = make_cylinder(0.2f, 0.1f, 24, 10.0f);
  const TubeSurface right_tube = make_cylinder(0.1f, 0.1f, 300, 10.0f, 40);
  const StripHandle left = add(left_tube);
  renderer_->begin_step();
  write(left, left_tube, {-0.2f, 0.0f, 0.0f});
  renderer_->strip_items(left)[0].belly_colour = pack_colour({0.1f, 0.9f, 0.1f, 1.0f});
  const Image before = draw(test_view());

  // Grows every buffer; the left tube isn't written again.
  const StripTopologyHandle topology = renderer_->add_strip_topology(right_tube.topology);
  const StripHandle right = renderer_->add_strips(topology);
  renderer_->begin_step();
  write(right, right_tube, {0.3f, 0.0f, 0.0f});
  const Image both = draw(test_view());
  EXPECT_FALSE(is_background(both.pixel(160, 50)));
  EXPECT_EQ(std::vector<std::uint8_t>(both.pixel(20, 50), both.pixel(100, 50)),
            std::vector<std::uint8_t>(before.pixel(20, 50), before.pixel(100, 50)));

  renderer_->remove(right);
  renderer_->remove(topology);
  renderer_->begin_step();
  EXPECT_EQ(draw(test_view()).rgb, before.rgb);
  const std::uint64_t allocations = renderer_->stats().buffer_allocations;
  const StripHandle again = add(right_tube);
  renderer_->begin_step();
  write(again, right_tube, {0.3f, 0.0f, 0.0f});
  EXPECT_EQ(draw(test_view()).rgb, both.rgb);
  EXPECT_EQ(renderer_->stats().buffer_allocations, allocations) << "freed ranges are used again";
}

TEST_F(StripDraw, RingsAreOneMoreCall) {
  make_renderer(test_options());
  const TubeSurface tube = make_cylinder(0.6f, 0.1f, 24, 10.0f, 5);
  const StripHandle strips = add(tube);
  renderer_->begin_step();
  write(strips, tube);
  DrawView view = test_view();
  const Image plain = draw(view);
  view.rings = true;
  const Image ringed = draw(view);
  EXPECT_EQ(renderer_->stats().draw_calls, 3u);
  // The middle row's outline stands dark at x = 0.
  int darkest = 255;
  for (int x = 98; x <= 102; ++x) darkest = std::min<int>(darkest, ringed.pixel(x, 50)[0]);
  EXPECT_LT(darkest, plain.pixel(100, 50)[0] / 2);
}

}  // namespace
}  // namespace fascicle
