// Levels of detail in the picture: one level is drawn at a time, and an exchange is interpolated through.
#include <cstdlib>
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

constexpr int kWidth = 320, kHeight = 360;

class LevelDrawing : public testing::Test {
 protected:
  void SetUp() override {
    auto opened = open_headless(kWidth, kHeight);
    if (!opened) GTEST_SKIP() << "nothing can be drawn here: " << to_text(opened.diagnostics());
    screen_ = std::move(*opened);
    const auto scene = muscle::load_scene(std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "scenes" /
                                          "walker.scene.json");
    ASSERT_TRUE(scene.ok()) << to_text(scene.diagnostics());
    simulation_.emplace(*scene, SimulationOptions{.workers = 1});
    view_.emplace(*simulation_, *screen_->renderer);
    draw_.camera = scene_camera(**scene);
    draw_.skins = draw_.meshes = draw_.ground = draw_.shadow = draw_.lines = false;
  }

  // A step with the muscles at `level`, and its picture.
  Image step(std::uint32_t level) {
    simulation_->set_viewer(make_viewer(draw_.camera, kHeight, level));
    view_->begin_step();
    simulation_->step();
    return picture(1.0f);
  }
  Image picture(float alpha) {
    draw_.alpha = alpha;
    screen_->renderer->draw(draw_);
    return screen_->renderer->read_image();
  }
  const muscle::MuscleDetail& detail() {
    return simulation_->world().get<muscle::MuscleDetail>(simulation_->characters()[0].musculature);
  }
  std::uint64_t drawn() { return screen_->renderer->stats().strip_vertices; }

  std::unique_ptr<Screen> screen_;
  std::optional<Simulation> simulation_;
  std::optional<SceneView> view_;
  DrawView draw_;
};

// The part of pixels that differ by more than a shade.
double difference(const Image& a, const Image& b) {
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    differ += std::abs(int{a.rgb[i]} - int{b.rgb[i]}) > 24 ? 1 : 0;
  }
  return static_cast<double>(differ) / static_cast<double>(a.rgb.size());
}

TEST_F(LevelDrawing, OneLevelIsDrawnAtATimeAndNothingIsAllocated) {
  const muscle::MuscleLevels& levels = *simulation_->characters()[0].asset->levels;
  const auto last = static_cast<std::uint32_t>(levels.assets.size() - 1);
  ASSERT_GE(last, 1u);
  for (int i = 0; i < 4; ++i) step(0);
  const std::uint64_t buffers = screen_->renderer->stats().buffer_allocations;
  for (const std::uint32_t level : {0u, 1u, 1u, last, last, 1u, 0u, 0u, 1u, 0u, last, 0u, 0u, 0u}) {
    step(level);
    EXPECT_EQ(drawn(), levels.assets[detail().level]->vertex_count);
  }
  EXPECT_EQ(detail().level, 0u);
  EXPECT_GE(detail().switches, 2u);
  EXPECT_EQ(screen_->renderer->stats().buffer_allocations, buffers);
}

// At the start of the interval in which a level is exchanged stands what the step before it ended with.
TEST_F(LevelDrawing, AnExchangeIsInterpolatedThrough) {
  for (int i = 0; i < 8; ++i) step(0);
  for (const std::uint32_t level : {1u, 0u}) {
    const Image before = step(level);
    ASSERT_NE(detail().next, detail().level);
    const Image after = step(level);
    ASSERT_EQ(detail().level, level);
    const Image start = picture(0.0f);
    EXPECT_GT(difference(before, after), 0.01) << level;  // it walks
    EXPECT_LT(difference(before, start), 0.2 * difference(before, after)) << level;
    for (int i = 0; i < 3; ++i) step(level);
  }
}

// What the user hides stays hidden at every level.
TEST_F(LevelDrawing, HiddenMusclesStayHidden) {
  const std::size_t muscles = simulation_->characters()[0].asset->muscles->size();
  for (std::uint32_t m = 0; m < muscles; ++m) view_->set_muscle_flags(0, m, kItemHidden);
  for (int i = 0; i < 3; ++i) step(0);
  const Image empty = picture(1.0f);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(difference(step(1), empty), 0.0);
}

}  // namespace
}  // namespace fascicle::game
