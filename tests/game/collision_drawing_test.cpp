// Collision in the picture: its marks are in the picture they were made for, and in no other.
#include <filesystem>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "game/scene_view.hpp"
#include "game/screen.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/muscle.hpp"

namespace fascicle::game {
namespace {

class CollisionDrawing : public testing::Test {
 protected:
  void SetUp() override {
    auto opened = open_headless(320, 360);
    if (!opened) GTEST_SKIP() << "nothing can be drawn here: " << to_text(opened.diagnostics());
    screen_ = std::move(*opened);
    const auto scene = muscle::load_scene(std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "scenes" /
                                          "walker.scene.json");
    ASSERT_TRUE(scene.ok()) << to_text(scene.diagnostics());
    simulation_.emplace(*scene, SimulationOptions{.workers = 1, .skin_meshes = false});
    view_.emplace(*simulation_, *screen_->renderer);
    draw_.camera = scene_camera(**scene);
    draw_.skins = draw_.meshes = draw_.ground = draw_.shadow = draw_.lines = draw_.strips = false;
    for (int i = 0; i < 12; ++i) {
      view_->begin_step();
      simulation_->step();
    }
  }
  // Pixels that are no background.
  int drawn() {
    screen_->renderer->draw(draw_);
    const Image image = screen_->renderer->read_image();
    int count = 0;
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
      count += image.rgb[i] != image.rgb[0] || image.rgb[i + 1] != image.rgb[1] || image.rgb[i + 2] != image.rgb[2];
    }
    return count;
  }

  std::unique_ptr<Screen> screen_;
  std::optional<Simulation> simulation_;
  std::optional<SceneView> view_;
  DrawView draw_;
};

TEST_F(CollisionDrawing, MarksAreInTheirPictureOnly) {
  EXPECT_EQ(drawn(), 0);
  view_->mark_collision();
  EXPECT_GT(drawn(), 100);
  EXPECT_EQ(drawn(), 0);
  view_->mark_collision();
  draw_.marks = false;
  EXPECT_EQ(drawn(), 0);
}

TEST_F(CollisionDrawing, APickedSectionIsMarkedAndWhatDoesNotExistIsNot) {
  view_->mark_place(0, {0, 0.5f, 0.0f}, 0xffffffffu);
  EXPECT_GT(drawn(), 10);
  view_->mark_place(7, {0, 0.5f, 0.0f}, 0xffffffffu);
  view_->mark_place(0, {10000, 0.5f, 0.0f}, 0xffffffffu);
  EXPECT_EQ(drawn(), 0);
}

}  // namespace
}  // namespace fascicle::game
