// A made-up leg, drawn from four sides with and without skin, as pictures to look at (in the build folder's pictures/).
#include <gtest/gtest.h>
#include <glm/ext/matrix_transform.hpp>

#include "engine/render/overlay.hpp"
#include "tests/engine/render/render_fixture.hpp"
#include "tests/engine/render/tube_surface.hpp"

namespace fascicle {
namespace {

class RenderDemo : public RenderFixture {
 protected:
  void SetUp() override {
    RenderFixture::SetUp();
    if (IsSkipped()) return;
    RendererOptions options;
    options.width = 1280;
    options.height = 720;
    make_renderer(options);
    add_muscles();
    add_bones();
    add_skin();
    view_.camera = {.target = {0.0f, 0.5f, 0.0f}, .distance = 1.9f, .yaw = 0.5f, .pitch = 0.12f, .fov = 0.6f};
  }

  // A spindle between two points, bulging away from the leg's axis, with tendons at both ends.
  void append_muscle(const glm::vec3& from, const glm::vec3& to, const glm::vec3& bulge, float radius, float tendon) {
    constexpr int kRows = 17;
    std::vector<glm::vec3> path;
    std::vector<float> radii, coordinates;
    const float length = glm::length(to - from);
    for (int k = 0; k < kRows; ++k) {
      const float s = static_cast<float>(k) / (kRows - 1);
      const float arch = std::sin(3.14159265f * s);
      path.push_back(glm::mix(from, to, s) + arch * bulge);
      const float belly = std::clamp((s - 0.04f) / (0.96f - tendon), 0.0f, 1.0f);
      radii.push_back(0.005f + radius * std::pow(std::max(std::sin(3.14159265f * belly), 0.0f), 1.4f));
      coordinates.push_back(std::min(s - 0.08f, 1.0f - tendon - s) * length);
    }
    append_tube(path, radii, coordinates, 16, muscles_);
  }

  void add_muscles() {
    for (int i = 0; i < 7; ++i) {
      const float angle = 0.9f * static_cast<float>(i);
      const glm::vec3 out(std::cos(angle), 0.0f, std::sin(angle));
      append_muscle(glm::vec3(0, 0.95f, 0) + 0.05f * out, glm::vec3(0, 0.46f, 0) + 0.03f * out, 0.035f * out,
                    0.022f + 0.004f * static_cast<float>(i % 3), 0.18f);
    }
    for (int i = 0; i < 5; ++i) {
      const float angle = 1.2566f * static_cast<float>(i) + 0.3f;
      const glm::vec3 out(std::cos(angle), 0.0f, std::sin(angle));
      append_muscle(glm::vec3(0, 0.52f, 0) + 0.03f * out, glm::vec3(0, 0.06f, 0) + 0.02f * out, 0.022f * out,
                    0.020f + 0.003f * static_cast<float>(i % 2), 0.42f);
    }
    strips_ = renderer_->add_strips(renderer_->add_strip_topology(muscles_.topology));
    auto items = renderer_->strip_items(strips_);
    for (std::size_t i = 0; i < items.size(); ++i) items[i].activation = static_cast<float>(i % 4) / 3.0f;
  }

  // A surface of revolution about y as a triangle mesh.
  static TriangleMesh make_lathe(const std::vector<glm::vec2>& outline, std::uint32_t around) {
    TriangleMesh mesh;
    for (const glm::vec2& point : outline) {
      for (std::uint32_t i = 0; i < around; ++i) {
        const float angle = 6.28318531f * static_cast<float>(i) / static_cast<float>(around);
        mesh.positions.emplace_back(point.x * std::sin(angle), point.y, point.x * std::cos(angle));
      }
    }
    for (std::uint32_t k = 0; k + 1 < outline.size(); ++k) {
      for (std::uint32_t i = 0; i < around; ++i) {
        const std::uint32_t a = k * around + i, b = k * around + (i + 1) % around;
        for (const std::uint32_t index : {a, b, a + around, b, b + around, a + around}) mesh.indices.push_back(index);
      }
    }
    return mesh;
  }

  void add_bones() {
    std::vector<glm::vec2> outline;
    for (int k = 0; k <= 40; ++k) {
      const float s = static_cast<float>(k) / 40.0f;
      const float ends = std::sqrt(std::max(0.0f, 1.0f - std::pow(2.0f * s - 1.0f, 8.0f)));
      const float knobs = 0.016f * (std::exp(-90.0f * s * s) + std::exp(-90.0f * (1 - s) * (1 - s)));
      outline.emplace_back(ends * (0.014f + knobs) + 1e-4f, s - 0.5f);
    }
    const MeshHandle mesh = renderer_->add_mesh(make_lathe(outline, 24));
    const MeshHandle meshes[] = {mesh, mesh};
    bones_ = renderer_->add_rigid(meshes);
  }

  void add_skin() {
    std::vector<glm::vec2> outline;
    for (int k = 0; k <= 60; ++k) {
      const float s = static_cast<float>(k) / 60.0f;
      const float ends = std::sqrt(std::max(0.0f, 1.0f - std::pow(2.0f * s - 1.0f, 16.0f)));
      outline.emplace_back(ends * (0.075f + 0.05f * s + 0.025f * std::sin(11.0f * s)), 1.02f * s);
    }
    skin_mesh_ = make_lathe(outline, 48);
    skin_ = renderer_->add_skin(static_cast<std::uint32_t>(skin_mesh_.positions.size()), skin_mesh_.indices);
  }

  void step() {
    renderer_->begin_step();
    std::copy(muscles_.vertices.begin(), muscles_.vertices.end(), renderer_->strip_vertices(strips_).begin());
    std::copy(muscles_.rows.begin(), muscles_.rows.end(), renderer_->strip_rows(strips_).begin());
    const auto bone = [](float y, float length) {
      return glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(0, y, 0)), glm::vec3(1.0f, length, 1.0f));
    };
    auto matrices = renderer_->rigid_matrices(bones_);
    matrices[0] = bone(0.74f, 0.46f);
    matrices[1] = bone(0.28f, 0.46f);
    std::vector<glm::vec3> normals(skin_mesh_.positions.size(), glm::vec3(0.0f));
    for (std::size_t i = 0; i < skin_mesh_.indices.size(); i += 3) {
      const std::uint32_t* t = &skin_mesh_.indices[i];
      const glm::vec3 area = glm::cross(skin_mesh_.positions[t[1]] - skin_mesh_.positions[t[0]],
                                        skin_mesh_.positions[t[2]] - skin_mesh_.positions[t[0]]);
      for (int corner = 0; corner < 3; ++corner) normals[t[corner]] += area;
    }
    pack_vertices(skin_mesh_.positions, normals, renderer_->skin_vertices(skin_));
  }

  // What an action line would look like, for one frame.
  void add_lines() {
    for (int i = 0; i < 7; ++i) {
      const float angle = 0.9f * static_cast<float>(i);
      const glm::vec3 out(std::cos(angle), 0.0f, std::sin(angle));
      const glm::vec3 from = glm::vec3(0, 0.95f, 0) + 0.05f * out, to = glm::vec3(0, 0.46f, 0) + 0.03f * out;
      const glm::vec3 middle = 0.5f * (from + to) + 0.035f * out;
      renderer_->add_line(from, middle, pack_colour({1.0f, 0.9f, 0.2f, 1.0f}));
      renderer_->add_line(middle, to, pack_colour({1.0f, 0.9f, 0.2f, 1.0f}));
      renderer_->add_point(middle, pack_colour({0.3f, 0.9f, 1.0f, 1.0f}), 7.0f);
    }
  }

  void save(const Image& image, const char* name) {
    const auto written = write_png(image, std::filesystem::path(FASCICLE_PICTURE_DIR) / name);
    ASSERT_TRUE(written.ok()) << to_text(written.diagnostics());
    EXPECT_GT(*written, 1000u);
  }

  TubeSurface muscles_;
  TriangleMesh skin_mesh_;
  StripHandle strips_;
  RigidHandle bones_;
  SkinHandle skin_;
  DrawView view_;
};

TEST_F(RenderDemo, LegFromFourSidesWithAndWithoutSkin) {
  step();
  std::vector<Image> images;
  for (const bool skin : {false, true}) {
    for (int side = 0; side < 4; ++side) {
      view_.skins = skin;
      view_.camera.yaw = 0.5f + 1.5708f * static_cast<float>(side);
      renderer_->draw(view_);
      images.push_back(shrink(renderer_->read_image(), 2));
    }
  }
  save(contact_sheet(images, 4), "leg_sides.png");
  view_.back_faces = true;
  view_.skins = false;
  renderer_->draw(view_);
  const Image faces = renderer_->read_image();
  EXPECT_EQ(count_back_faces(faces), 0) << "a surface shows its inside";
}

TEST_F(RenderDemo, CloseUpWithRingsLinesAndOverlay) {
  step();
  view_.camera = {.target = {0.0f, 0.62f, 0.0f}, .distance = 0.7f, .yaw = 0.7f, .pitch = 0.15f, .fov = 0.6f};
  view_.skins = false;
  renderer_->draw(view_);
  save(renderer_->read_image(), "leg_close.png");
  view_.skins = true;
  view_.skin_opacity = 0.35f;
  renderer_->draw(view_);
  save(renderer_->read_image(), "leg_close_skin.png");

  view_.skins = false;
  view_.rings = true;
  auto overlay = Overlay::create();
  ASSERT_TRUE(overlay.ok());
  const OverlayTiming systems[] = {{"advance_clips", 0.02f}, {"compose_bones", 0.11f}, {"place_sections", 0.42f}};
  const OverlaySwitch switches[] = {{"skin", false, "1"}, {"bones", true, "2"}, {"sections", true, "3"},
                                    {"action lines", true, "4"}};
  const OverlaySlider sliders[] = {{"skin opacity", 0.35f, 0.0f, 1.0f}};
  const OverlayItem items[] = {{"soleus_r", {312.5f, 431.0f, 3549.0f}, true, false, false},
                               {"gracilis_r", {400.0f, 101.0f, 162.0f}, true, true, false},
                               {"sartorius_r", {520.0f, 120.0f, 156.0f}, false, false, true}};
  const std::string errors[] = {"walker.character.json:3:5: /muscles/0/origin/bone: unknown bone 'tibea_r'; write "
                                "'tibia_r'"};
  std::vector<OverlayTiming> gpu;
  for (const GpuTime& time : renderer_->gpu_times()) {
    gpu.push_back({time.name, static_cast<float>(time.milliseconds)});
    RecordProperty(time.name, std::to_string(time.milliseconds));
  }
  OverlayModel model;
  model.title = "walker";
  model.subtitle = headless_->info().renderer;
  model.systems = systems;
  model.switches = switches;
  model.sliders = sliders;
  model.item_heading = "muscle";
  model.value_headings[0] = "length, mm";
  model.value_headings[1] = "volume, ml";
  model.value_headings[2] = "force, N";
  model.items = items;
  model.errors = errors;
  for (int frame = 0; frame < 150; ++frame) {
    model.frame_milliseconds = 9.0f + 5.0f * std::sin(0.2f * static_cast<float>(frame));
    model.frame = static_cast<std::uint64_t>(frame);
    (*overlay)->draw(model, InputState{}, 1.0f / 60.0f, *renderer_);
  }
  model.gpu = gpu;
  add_lines();
  renderer_->draw(view_);
  (*overlay)->draw(model, InputState{}, 1.0f / 60.0f, *renderer_);
  save(renderer_->read_image(), "overlay.png");
}

}  // namespace
}  // namespace fascicle
