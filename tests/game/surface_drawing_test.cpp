// Surface muscles in the picture: they move with their points, stand for the unit that drives them, hide on request,
// show what is inside, and go and come back with their character.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "game/contact_sheet.hpp"
#include "game/scene_view.hpp"
#include "game/screen.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/muscle.hpp"
#include "modules/muscle/spawn_surface_muscles.hpp"
#include "tests/engine/content/temporary_folder.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::game {
namespace {

constexpr int kWidth = 320, kHeight = 360;
constexpr std::uint32_t kDriver = 3;

class SurfaceDrawing : public testing::Test {
 protected:
  // The walker with a ball in front of it, fixed to its pelvis, for one of its muscles.
  void SetUp() override {
    auto opened = open_headless(kWidth, kHeight);
    if (!opened) GTEST_SKIP() << "nothing can be drawn here: " << to_text(opened.diagnostics());
    screen_ = std::move(*opened);
    const auto scene = muscle::load_scene(std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "scenes" /
                                          "walker.scene.json");
    ASSERT_TRUE(scene.ok()) << to_text(scene.diagnostics());
    auto changed = std::make_shared<muscle::SceneAsset>(**scene);
    auto character = std::make_shared<muscle::CharacterAsset>(*changed->characters[0].character);
    character->hidden_muscles.assign(character->muscles->size(), 0);
    character->hidden_muscles[kDriver] = 1;
    changed->characters[0].character = std::move(character);
    simulation_.emplace(changed, SimulationOptions{.workers = 1});
    spawn_ball(simulation_->characters()[0]);
    view_.emplace(*simulation_, *screen_->renderer);
    draw_.camera = scene_camera(**scene);
    draw_.skins = draw_.meshes = draw_.ground = draw_.shadow = draw_.lines = draw_.marks = false;
  }

  void spawn_ball(const SpawnedCharacter& character) {
    const auto& rest = character.asset->skeleton->rest_world;
    muscle::SurfaceMuscleDescription description;
    description.name = "ball";
    centre_ = glm::vec3(rest[1][3]) + glm::vec3(0.0f, 0.0f, 0.4f);
    description.mesh = test::make_sphere(0.1f, 12, 16, centre_);
    description.attachments.resize(1);
    description.attachments[0].bone = 1;
    for (std::uint32_t v = 0; v < 60; ++v) description.attachments[0].vertices.push_back(v);
    description.frame_bone = 1;
    description.driver = character.asset->muscles->muscles[kDriver].name;
    const auto asset = muscle::build_surface_asset(description, static_cast<std::uint32_t>(rest.size()),
                                                   character.asset->muscles.get());
    ASSERT_TRUE(asset.ok()) << to_text(asset.diagnostics());
    ball_ = muscle::spawn_surface_muscle(simulation_->world(), character.entity, *asset, rest, {},
                                         character.musculature);
    // One fibre from side to side, half a diameter beyond the vertices there.
    const auto& points = (*asset)->rest;
    const auto end = points.begin() + (*asset)->vertex_count;
    const auto [left, right] = std::minmax_element(points.begin(), end, [](const auto& a, const auto& b) {
      return a.x < b.x;
    });
    const auto index = [&](auto point) { return static_cast<std::uint32_t>(point - points.begin()); };
    auto bundle = std::make_shared<muscle::FibreBundleAsset>();
    bundle->surface_vertices = (*asset)->vertex_count;
    bundle->count = 1;
    bundle->points_per_fibre = 2;
    bundle->bindings = {{{index(left), index(right)}, {1.5f, -0.5f}}, {{index(left), index(right)}, {-0.5f, 1.5f}}};
    bundle->rest_length = {0.4f};
    muscle::FibreBundle fibres;
    fibres.asset = bundle;
    fibres.points.resize(2);
    fibres.length.resize(1);
    simulation_->world().add(ball_, std::move(fibres));
  }

  Image step() {
    view_->begin_step();
    simulation_->step();
    return picture();
  }
  Image picture() {
    screen_->renderer->draw(draw_);
    return screen_->renderer->read_image();
  }
  // Of what is not the ball nothing is left.
  void hide_units() {
    for (std::uint32_t m = 0; m < simulation_->characters()[0].asset->muscles->size(); ++m) {
      view_->set_muscle_flags(0, m, kItemHidden);
    }
  }
  std::uint32_t unit_flags(std::uint32_t unit) {
    const auto& world = simulation_->world();
    const auto& drawn = world.get<muscle::DrawnMuscles>(simulation_->characters()[0].musculature);
    const std::uint32_t flags = screen_->renderer->strip_items(drawn.levels.front().strips)[unit].flags;
    for (const auto& level : drawn.levels) EXPECT_EQ(screen_->renderer->strip_items(level.strips)[unit].flags, flags);
    return flags;
  }
  static int drawn(const Image& image) {
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
  ecs::Entity ball_;
  glm::vec3 centre_{0.0f};
};

TEST_F(SurfaceDrawing, ThePictureChangesAsTheMuscleMoves) {
  hide_units();
  for (int i = 0; i < 3; ++i) step();
  const Image before = picture();
  EXPECT_GT(drawn(before), 300);
  EXPECT_EQ(screen_->renderer->stats().surface_vertices,
            simulation_->world().get<muscle::SurfaceMuscle>(ball_).asset->vertex_count);
  EXPECT_EQ(picture().rgb, before.rgb);
  const std::uint64_t buffers = screen_->renderer->stats().buffer_allocations;
  for (int i = 0; i < 20; ++i) step();  // it walks
  EXPECT_NE(picture().rgb, before.rgb);
  EXPECT_EQ(screen_->renderer->stats().buffer_allocations, buffers);
  draw_.strips = false;
  EXPECT_EQ(drawn(picture()), 0) << "the switch for muscles is theirs, too";
}

TEST_F(SurfaceDrawing, TheUnitThatDrivesItIsNotDrawnBesideIt) {
  EXPECT_EQ(unit_flags(kDriver), kItemHidden);
  EXPECT_EQ(unit_flags(kDriver + 1), 0u);
  view_->set_muscle_flags(0, kDriver, kItemHighlighted);
  EXPECT_EQ(unit_flags(kDriver), kItemHidden | kItemHighlighted);
  view_->set_muscle_flags(0, kDriver + 1, kItemHighlighted);
  EXPECT_EQ(unit_flags(kDriver + 1), kItemHighlighted);
}

TEST_F(SurfaceDrawing, IsHiddenAndHighlightedByItsName) {
  hide_units();
  for (int i = 0; i < 2; ++i) step();
  const Image plain = picture();
  view_->set_surface_flags(0, "another", kItemHidden);
  view_->set_surface_flags(1, "ball", kItemHidden);
  EXPECT_EQ(picture().rgb, plain.rgb);
  view_->set_surface_flags(0, "ball", kItemHighlighted);
  EXPECT_NE(picture().rgb, plain.rgb);
  view_->set_surface_flags(0, "ball", kItemHidden);
  EXPECT_EQ(drawn(picture()), 0);
  view_->set_surface_flags(0, "ball", 0);
  EXPECT_EQ(picture().rgb, plain.rgb);
}

TEST_F(SurfaceDrawing, FibresShowOnRequestAndWithItsSurface) {
  hide_units();
  for (int i = 0; i < 2; ++i) step();
  const int without = drawn(picture());
  draw_.fibres = true;
  const int with = drawn(picture());
  EXPECT_GT(with, without + 20) << "it sticks out on both sides";
  view_->set_surface_flags(0, "ball", kItemHidden);
  EXPECT_EQ(drawn(picture()), 0);
}

TEST_F(SurfaceDrawing, AttachedVerticesAndContactsAreMarkedInOnePicture) {
  for (int i = 0; i < 2; ++i) step();
  draw_.strips = false;
  draw_.marks = true;
  simulation_->world().remove<muscle::MuscleContacts>(simulation_->characters()[0].musculature);
  view_->mark_collision();
  const int attached = drawn(picture());
  EXPECT_GT(attached, 20);
  EXPECT_EQ(drawn(picture()), 0);
  const glm::vec3 place = centre_ - glm::vec3(0, 0.3f, 0);
  simulation_->world().get<muscle::SurfaceContacts>(ball_).now.push_back({2, 5, 0.001f, place});
  view_->mark_collision();
  EXPECT_GT(drawn(picture()), attached + 20);
}

TEST_F(SurfaceDrawing, ReleasedAndAttachedAgainItIsThereAsBefore) {
  hide_units();
  for (int i = 0; i < 2; ++i) step();
  const Image before = picture();
  view_->release();
  EXPECT_EQ(drawn(picture()), 0);
  EXPECT_FALSE(simulation_->world().has<muscle::DrawnSurfaceMuscle>(ball_));
  view_->attach();
  hide_units();
  view_->begin_step();
  simulation_->refresh();
  EXPECT_EQ(picture().rgb, before.rgb);

  view_->release();
  muscle::despawn_surface_muscle(simulation_->world(), ball_);
  view_->attach();
  hide_units();
  view_->begin_step();
  simulation_->refresh();
  EXPECT_EQ(drawn(picture()), 0);
}

// A PNG's width and height stand in its first bytes.
glm::ivec2 size_of_png(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  unsigned char head[24] = {};
  stream.read(reinterpret_cast<char*>(head), sizeof(head));
  const auto number = [&head](int at) {
    return head[at] << 24 | head[at + 1] << 16 | head[at + 2] << 8 | head[at + 3];
  };
  return {number(16), number(20)};
}

TEST_F(SurfaceDrawing, ASheetHasAColumnAFrameAndARowASideTwiceWithTheSkin) {
  const test::TemporaryFolder folder;
  std::vector<glm::ivec2> sizes;
  ContactSheet plain(draw_, {.frames = {1, 4}, .sides = 3, .width = 90, .height = 60});
  ContactSheet skinned(draw_, {.frames = {4}, .sides = 3, .with_skin = true, .width = 90, .height = 60});
  for (std::uint64_t frame = 1; frame <= 5; ++frame) {
    step();
    EXPECT_EQ(plain.wants(frame), frame == 1 || frame == 4) << frame;
    EXPECT_EQ(skinned.wants(frame), frame == 4) << frame;
    for (ContactSheet* sheet : {&plain, &skinned}) {
      if (sheet->wants(frame)) sheet->take(*screen_, glm::vec3(0.0f), [] {});
    }
  }
  for (const ContactSheet* sheet : {&plain, &skinned}) {
    const auto written = sheet->write(folder / "sheet.png");
    ASSERT_TRUE(written.ok()) << to_text(written.diagnostics());
    sizes.push_back(size_of_png(folder / "sheet.png"));
  }
  EXPECT_NEAR(sizes[0].x, 2 * 90, 12);
  EXPECT_NEAR(sizes[0].y, 3 * 60, 16);
  EXPECT_NEAR(sizes[1].x, 90, 8);
  EXPECT_NEAR(sizes[1].y, 6 * 60, 28);
}

TEST(SpreadFrames, EndWithTheLastAndAreAllWhereThereAreFew) {
  EXPECT_EQ(spread_frames(300, 3), (std::vector<std::uint64_t>{100, 200, 300}));
  EXPECT_EQ(spread_frames(2), (std::vector<std::uint64_t>{1, 2}));
}

}  // namespace
}  // namespace fascicle::game
