// Surfaces that deform each step, and the fibres inside them, as they come out of the renderer.
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/render/render_fixture.hpp"

namespace fascicle {
namespace {

const std::uint32_t kSquare[] = {0, 1, 2, 0, 2, 3};
constexpr std::uint32_t kGreen = 0xff00ff00u;

class SurfaceDraw : public RenderFixture {
 protected:
  void SetUp() override {
    RenderFixture::SetUp();
    if (headless_ != nullptr) make_renderer(test_options());
  }
  Image draw(const DrawView& view) {
    renderer_->draw(view);
    return renderer_->read_image();
  }
  // A square of 40 by 40 pixels about (x, 0), 0.1 m before the picture's plane; `flag` on its two right corners.
  void write(SurfaceHandle surface, float x, std::uint32_t flag = 0) {
    const auto vertices = renderer_->surface_vertices(surface);
    for (std::size_t i = 0; i < 4; ++i) {
      const bool right = i == 1 || i == 2;
      vertices[i] = {{x + (right ? 0.1f : -0.1f), i >= 2 ? 0.1f : -0.1f, 0.1f},
                     pack_normal({0, 0, 1}) | (right ? flag : 0u)};
    }
  }
  // A line from left to right through the middle of row 49, in the picture's plane.
  FibreHandle write_fibre(FibreHandle fibre) {
    const auto vertices = renderer_->fibre_vertices(fibre);
    vertices[0] = {{-0.4f, 0.0025f, 0.0f}, kGreen};
    vertices[1] = {{0.4f, 0.0025f, 0.0f}, kGreen};
    return fibre;
  }
};

// Of two pixels, whether the first is more like tendon: less red beside the other colours.
bool paler(const std::uint8_t* a, const std::uint8_t* b) { return a[1] > b[1] + 20 && a[2] > b[2] + 20; }

TEST_F(SurfaceDraw, NothingIsDrawnBeforeItIsWrittenNorWhenSwitchedOffHiddenOrRemoved) {
  const SurfaceHandle surface = renderer_->add_surface(4, kSquare);
  DrawView view = test_view();
  EXPECT_EQ(measure(draw(view)).pixels, 0);
  renderer_->begin_step();
  write(surface, 0.0f);
  EXPECT_NEAR(measure(draw(view)).pixels, 1600, 60);
  EXPECT_EQ(renderer_->stats().surface_vertices, 4u);
  view.strips = false;
  EXPECT_EQ(measure(draw(view)).pixels, 0);
  EXPECT_EQ(renderer_->stats().surface_vertices, 0u);
  view.strips = true;
  renderer_->set_visible(surface, false);
  EXPECT_EQ(measure(draw(view)).pixels, 0);
  renderer_->set_visible(surface, true);
  EXPECT_NEAR(measure(draw(view)).pixels, 1600, 60);
  renderer_->remove(surface);
  EXPECT_EQ(measure(draw(view)).pixels, 0);
}

TEST_F(SurfaceDraw, FollowsTheStepsInOneCallAndAllocatesNothing) {
  const SurfaceHandle first = renderer_->add_surface(4, kSquare), second = renderer_->add_surface(4, kSquare);
  DrawView view = test_view();
  std::uint64_t buffers = 0;
  for (int step = 0; step < 6; ++step) {
    renderer_->begin_step();
    write(first, -0.3f);
    write(second, step % 2 == 0 ? 0.0f : 0.2f);
    view.alpha = step % 2 == 0 ? 1.0f : 0.5f;
    const Image image = draw(view);
    EXPECT_EQ(renderer_->stats().draw_calls, 1u);
    EXPECT_FALSE(is_background(image.pixel(40, 50)));
    // Half way it reaches from 0 to 40 pixels right of the middle.
    EXPECT_EQ(is_background(image.pixel(100 - 10, 50)), step % 2 != 0) << step;
    EXPECT_EQ(is_background(image.pixel(100 + 30, 50)), step % 2 == 0) << step;
    if (step == 3) buffers = renderer_->stats().buffer_allocations;
  }
  EXPECT_EQ(renderer_->stats().buffer_allocations, buffers);
  renderer_->begin_step();
  write(second, 0.2f);
  renderer_->mark_teleported(second);
  view.alpha = 0.0f;
  EXPECT_TRUE(is_background(draw(view).pixel(90, 50))) << "a jump is drawn where it ends";
}

TEST_F(SurfaceDraw, TendonVerticesAreTendonAndHighlightsShow) {
  const SurfaceHandle surface = renderer_->add_surface(4, kSquare);
  renderer_->begin_step();
  write(surface, 0.0f, kTendonVertex);
  DrawView view = test_view();
  const Image plain = draw(view);
  EXPECT_TRUE(paler(plain.pixel(118, 50), plain.pixel(82, 50)));
  view.tendons = false;
  const Image belly = draw(view);
  EXPECT_FALSE(paler(belly.pixel(118, 50), belly.pixel(82, 50)));
  renderer_->set_highlighted(surface, true);
  const Image highlighted = draw(view);
  EXPECT_GT(highlighted.pixel(82, 50)[1], belly.pixel(82, 50)[1] + 30);
  renderer_->set_highlighted(surface, false);
  EXPECT_EQ(draw(view).rgb, belly.rgb);
}

TEST_F(SurfaceDraw, FibresShowThroughASurfaceThatIsOpaqueWithoutThem) {
  const SurfaceHandle surface = renderer_->add_surface(4, kSquare);
  DrawView view = test_view();
  view.line_width = 1.0f;
  view.fibres = true;
  renderer_->begin_step();
  write(surface, 0.0f);
  const Image none = draw(view);
  EXPECT_FALSE(is_background(none.pixel(100, 40)));
  EXPECT_LT(none.pixel(100, 40)[2], 200) << "there are none to be seen through it";

  const std::uint32_t line[] = {0, 1};
  const FibreHandle fibre = renderer_->add_fibres(2, line);
  renderer_->begin_step();
  write(surface, 0.0f);
  write_fibre(fibre);
  const Image seen = draw(view);
  EXPECT_GT(seen.pixel(20, 49)[1], 250) << "outside";
  EXPECT_GT(seen.pixel(100, 49)[1], seen.pixel(100, 40)[1] + 60) << "through the surface";
  EXPECT_GT(seen.pixel(100, 40)[2], none.pixel(100, 40)[2] + 40) << "so is the background";

  view.fibres = false;
  const Image off = draw(view);
  EXPECT_EQ(off.rgb, none.rgb);
  view.fibres = true;
  renderer_->set_visible(fibre, false);
  EXPECT_EQ(draw(view).rgb, none.rgb);
  renderer_->set_visible(fibre, true);
  EXPECT_EQ(draw(view).rgb, seen.rgb);
  renderer_->remove(fibre);
  EXPECT_EQ(draw(view).rgb, none.rgb);
}

// Fibres are switched apart from the action lines.
TEST_F(SurfaceDraw, FibresAreNoLineSets) {
  const std::uint32_t line[] = {0, 1};
  const FibreHandle fibre = renderer_->add_fibres(2, line);
  renderer_->begin_step();
  write_fibre(fibre);
  DrawView view = test_view();
  view.line_width = 1.0f;
  EXPECT_EQ(measure(draw(view)).pixels, 0);
  view.fibres = true;
  view.lines = false;
  EXPECT_NEAR(measure(draw(view)).pixels, 160, 4);
}

}  // namespace
}  // namespace fascicle
