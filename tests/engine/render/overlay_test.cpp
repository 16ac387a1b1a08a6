#include "engine/render/overlay.hpp"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/render/render_fixture.hpp"

namespace fascicle {
namespace {

class OverlayTest : public RenderFixture {
 protected:
  void SetUp() override {
    RenderFixture::SetUp();
    if (IsSkipped()) return;
    RendererOptions options = test_options();
    options.width = 1000;
    options.height = 600;
    make_renderer(options);
    Result<std::unique_ptr<Overlay>> overlay = Overlay::create();
    ASSERT_TRUE(overlay.ok()) << to_text(overlay.diagnostics());
    overlay_ = std::move(*overlay);
  }
  void TearDown() override {
    overlay_.reset();
    RenderFixture::TearDown();
  }

  // A frame with the pointer at `mouse`, its left button held or not.
  OverlayActions frame(const OverlayModel& model, const glm::vec2& mouse, bool held) {
    InputState input;
    input.mouse = mouse;
    input.buttons[0] = held;
    renderer_->draw(test_view());
    return overlay_->draw(model, input, 1.0f / 60.0f, *renderer_);
  }
  // Presses and lets go at `mouse`; what came of the two frames.
  OverlayActions click(const OverlayModel& model, const glm::vec2& mouse) {
    frame(model, mouse, false);
    const OverlayActions pressed = frame(model, mouse, true);
    OverlayActions released = frame(model, mouse, false);
    released.toggle_pause |= pressed.toggle_pause;
    released.single_step |= pressed.single_step;
    released.switched = std::max(released.switched, pressed.switched);
    released.item_highlighted = std::max(released.item_highlighted, pressed.item_highlighted);
    released.item_visibility = std::max(released.item_visibility, pressed.item_visibility);
    return released;
  }

  std::unique_ptr<Overlay> overlay_;
};

OverlayModel make_model() {
  static const OverlayTiming systems[] = {{"advance_clips", 0.02f}, {"place_sections", 0.31f}};
  static const OverlaySwitch switches[] = {{"skin", true, "1"}, {"bones", false, "2"}, {"sections", false, "3"}};
  static const OverlayItem items[] = {{"soleus_r", {312.5f, 431.0f, 0.0f}, true, false, false},
                                      {"gracilis_r", {400.0f, 101.0f, 0.0f}, true, false, false}};
  OverlayModel model;
  model.title = "walker";
  model.subtitle = "test";
  model.frame_milliseconds = 8.0f;
  model.systems = systems;
  model.switches = switches;
  model.items = items;
  model.value_headings[0] = "length, mm";
  model.value_headings[1] = "volume, ml";
  return model;
}

TEST_F(OverlayTest, CaptionsStandWhereTheyAreSaid) {
  const float width = overlay_->text_width("fitted", 26.0f);
  EXPECT_GT(width, 40.0f);
  EXPECT_NEAR(overlay_->text_width("fittedfitted", 26.0f), 2.0f * width, 2.0f);
  EXPECT_EQ(overlay_->text_width("", 26.0f), 0.0f);
  renderer_->draw(test_view());
  const Caption captions[] = {{{100.0f, 50.0f}, "fitted", 0xff00ff00u, true}};
  overlay_->draw_captions(captions, 26.0f, *renderer_);
  const Image picture = renderer_->read_image();
  const std::uint8_t* swatch = picture.pixel(113, 63);
  EXPECT_TRUE(swatch[0] == 0 && swatch[1] == 255 && swatch[2] == 0);
  const Coverage covered = measure(picture);  // all of it within swatch and text
  EXPECT_GE(covered.left, 99);
  EXPECT_LE(covered.right, 100 + 40 + static_cast<int>(width));
  EXPECT_GT(covered.right, 140);
  EXPECT_GE(covered.top, 49);
  EXPECT_LE(covered.bottom, 77);
}

TEST_F(OverlayTest, OnlyOneAtATime) { EXPECT_FALSE(Overlay::create().ok()); }

TEST_F(OverlayTest, DrawsPanelsAndLeavesTheRestAlone) {
  frame(make_model(), {-1, -1}, false);
  frame(make_model(), {-1, -1}, false);
  const Image image = renderer_->read_image();
  EXPECT_FALSE(is_background(image.pixel(20, 20)));
  EXPECT_FALSE(is_background(image.pixel(980, 30)));
  EXPECT_TRUE(is_background(image.pixel(500, 300)));
  EXPECT_FALSE(overlay_->wants_mouse());
}

TEST_F(OverlayTest, MessagesAppearAtTheBottomAndGo) {
  const std::string errors[] = {"walker.character.json:3:5: /muscles/0: unknown bone 'tibea_r'; write 'tibia_r'"};
  OverlayModel model = make_model();
  model.errors = errors;
  for (int i = 0; i < 3; ++i) frame(model, {-1, -1}, false);
  const Image with = renderer_->read_image();
  int red = 0;
  for (int y = 480; y < 600; ++y) {
    for (int x = 200; x < 800; ++x) {
      const std::uint8_t* pixel = with.pixel(x, y);
      red += pixel[0] > 180 && pixel[1] < 160 && pixel[2] < 160;
    }
  }
  EXPECT_GT(red, 200);
  model.errors = {};
  for (int i = 0; i < 2; ++i) frame(model, {-1, -1}, false);
  EXPECT_TRUE(is_background(renderer_->read_image().pixel(500, 580)));
}

TEST_F(OverlayTest, ClicksBecomeActions) {
  const OverlayModel model = make_model();
  bool paused = false, stepped = false, switched[3] = {}, highlighted[2] = {}, hidden[2] = {};
  for (float y = 20.0f; y < 300.0f; y += 9.0f) {
    for (const float x : {25.0f, 122.0f, 544.0f, 600.0f}) {
      const OverlayActions actions = click(model, {x, y});
      paused |= actions.toggle_pause;
      stepped |= actions.single_step;
      if (actions.switched >= 0) switched[actions.switched] = true;
      if (actions.item_highlighted >= 0) highlighted[actions.item_highlighted] = true;
      if (actions.item_visibility >= 0) hidden[actions.item_visibility] = true;
    }
  }
  EXPECT_TRUE(paused);
  EXPECT_TRUE(stepped);
  EXPECT_THAT(switched, testing::Each(true));
  EXPECT_THAT(highlighted, testing::Each(true));
  EXPECT_THAT(hidden, testing::Each(true));
}

TEST_F(OverlayTest, ATasksEnabledButtonsAreActions) {
  OverlayModel model = make_model();
  OverlayTask task;
  task.lines = {"1  soleus_r", "2  click another"};
  task.buttons = {{"Save", "Enter", false}, {"Forget", "Backspace"}, {"Leave", "Escape"}};
  model.task = &task;
  for (int i = 0; i < 2; ++i) frame(model, {-1, -1}, false);
  EXPECT_TRUE(is_background(renderer_->read_image().pixel(980, 580))) << "a task without a title isn't shown";
  task.title = "Tag";
  const auto press_all = [&] {
    std::vector<bool> pressed(task.buttons.size(), false);
    for (float y = 520.0f; y < 590.0f; y += 11.0f) {
      for (const float x : {700.0f, 710.0f, 790.0f, 800.0f, 810.0f}) {
        frame(model, {x, y}, false);
        frame(model, {x, y}, true);
        const int button = frame(model, {x, y}, false).task_button;
        if (button >= 0) pressed[static_cast<std::size_t>(button)] = true;
      }
    }
    return pressed;
  };
  EXPECT_THAT(press_all(), testing::ElementsAre(false, true, true));
  task.buttons[0].enabled = true;
  EXPECT_THAT(press_all(), testing::ElementsAre(true, true, true));
}

TEST_F(OverlayTest, ValuesThatAreNoNumbersAreLeftOut) {
  OverlayModel model = make_model();
  OverlayItem items[] = {{"soleus_r", {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f}}};
  model.items = items;
  model.value_headings = {"a", "b", "c", "d", "e", "f"};
  const auto text_pixels = [&] {  // in the last column's first row
    for (int i = 0; i < 3; ++i) frame(model, {-1, -1}, false);
    const Image image = renderer_->read_image();
    int bright = 0;
    for (int y = 60; y < 90; ++y) {
      for (int x = 910; x < 980; ++x) bright += image.pixel(x, y)[0] > 180;
    }
    return bright;
  };
  EXPECT_GT(text_pixels(), 10);
  items[0].values[5] = std::nanf("");
  EXPECT_EQ(text_pixels(), 0);
}

TEST_F(OverlayTest, TakesTheMouseOverItsPanelsOnly) {
  for (int i = 0; i < 3; ++i) frame(make_model(), {100, 30}, false);
  EXPECT_TRUE(overlay_->wants_mouse());
  frame(make_model(), {500, 300}, false);
  frame(make_model(), {500, 300}, false);
  EXPECT_FALSE(overlay_->wants_mouse());
}

}  // namespace
}  // namespace fascicle
