// Rigid meshes, skins, lines and points as they come out of the renderer.
#include <gtest/gtest.h>
#include <glm/ext/matrix_transform.hpp>

#include "tests/engine/render/render_fixture.hpp"

namespace fascicle {
namespace {

class MeshDraw : public RenderFixture {
 protected:
  Image draw(const DrawView& view) {
    renderer_->draw(view);
    return renderer_->read_image();
  }
};

// A cube of side 1 about the origin, faces with their own corners.
TriangleMesh make_cube(bool with_normals) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 normal(0.0f), u(0.0f), v(0.0f);
      normal[axis] = side;
      u[(axis + 1) % 3] = 0.5f;
      v[(axis + 2) % 3] = 0.5f * side;
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
        mesh.positions.push_back(0.5f * normal + corner.x * u + corner.y * v);
        if (with_normals) mesh.normals.push_back(normal);
      }
      for (const std::uint32_t index : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + index);
    }
  }
  return mesh;
}

glm::mat4 place(float x, float y, float size) {
  return glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(x, y, 0.0f)), glm::vec3(size));
}

TEST_F(MeshDraw, CubeCoversItsSquareAndComputedNormalsMatchGivenOnes) {
  make_renderer(test_options());
  std::vector<Image> images;
  for (const bool with_normals : {true, false}) {
    const MeshHandle mesh = renderer_->add_mesh(make_cube(with_normals));
    const RigidHandle group = renderer_->add_rigid(std::span(&mesh, 1));
    renderer_->begin_step();
    renderer_->rigid_matrices(group)[0] = place(0.0f, 0.0f, 0.2f);
    DrawView view = test_view();
    view.back_faces = true;
    images.push_back(draw(view));
    renderer_->remove(group);
    renderer_->remove(mesh);
  }
  const Coverage coverage = measure(images[0]);
  EXPECT_NEAR(coverage.pixels, 40 * 40, 100);
  EXPECT_TRUE(coverage.gap_free);
  EXPECT_FALSE(is_magenta(images[0].pixel(100, 50)));
  EXPECT_EQ(images[0].rgb, images[1].rgb);
}

TEST_F(MeshDraw, MirroredAndStretchedMeshIsLitLikeAPlainOne) {
  make_renderer(test_options());
  const MeshHandle mesh = renderer_->add_mesh(make_cube(true));
  const RigidHandle group = renderer_->add_rigid(std::span(&mesh, 1));
  std::vector<int> brightness;
  for (const glm::vec3 scale : {glm::vec3(0.2f), glm::vec3(0.4f, 0.2f, 0.05f)}) {
    renderer_->begin_step();
    renderer_->rigid_matrices(group)[0] = glm::scale(glm::mat4(1.0f), scale);
    renderer_->mark_teleported(group);
    brightness.push_back(draw(test_view()).pixel(100, 50)[1]);
  }
  EXPECT_NEAR(brightness[0], brightness[1], 2);
}

TEST_F(MeshDraw, AllGroupsOfAllMeshesGoOutInOneCallAndAreInterpolated) {
  make_renderer(test_options());
  const MeshHandle meshes[2] = {renderer_->add_mesh(make_cube(true)), renderer_->add_mesh(make_cube(false))};
  std::vector<RigidHandle> groups;
  for (int i = 0; i < 5; ++i) groups.push_back(renderer_->add_rigid(meshes));
  const auto write = [&](float shift) {
    renderer_->begin_step();
    for (int i = 0; i < 5; ++i) {
      auto matrices = renderer_->rigid_matrices(groups[static_cast<std::size_t>(i)]);
      const float x = 0.15f * static_cast<float>(i - 2) + shift;
      matrices[0] = place(x, 0.1f, 0.05f);
      matrices[1] = place(x, -0.1f, 0.05f);
    }
  };
  DrawView view = test_view();
  view.alpha = 0.5f;
  write(-0.05f);
  write(0.05f);
  const Image image = draw(view);
  EXPECT_EQ(renderer_->stats().draw_calls, 1u);
  const Coverage coverage = measure(image);
  EXPECT_NEAR(coverage.pixels, 10 * 10 * 10, 150);
  EXPECT_NEAR(coverage.centre_x, 0.0, 0.3);
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(is_background(image.pixel(100 + 30 * (i - 2), 30)));
    EXPECT_FALSE(is_background(image.pixel(100 + 30 * (i - 2), 70)));
  }
  renderer_->set_visible(groups[0], false);
  EXPECT_TRUE(is_background(draw(view).pixel(40, 30)));
}

// Two squares, one behind the other, as one skin.
TEST_F(MeshDraw, SkinShowsOneLayerOverWhatIsInside) {
  make_renderer(test_options());
  const std::uint32_t indices[] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
  const auto write = [&](SkinHandle skin, std::size_t layers) {
    auto vertices = renderer_->skin_vertices(skin);
    for (std::size_t i = 0; i < 4 * layers; ++i) {
      const std::size_t corner = i % 4;
      const float x = corner == 1 || corner == 2 ? 0.2f : -0.2f, y = corner >= 2 ? 0.2f : -0.2f;
      vertices[i] = {{x, y, i < 4 ? -0.1f : 0.1f}, pack_normal({0, 0, 1})};
    }
  };
  DrawView view = test_view();
  view.skin_opacity = 0.5f;
  std::vector<Image> images;
  for (const std::size_t layers : {1u, 2u}) {
    const SkinHandle skin = renderer_->add_skin(static_cast<std::uint32_t>(4 * layers),
                                                std::span(indices).first(6 * layers));
    renderer_->begin_step();
    write(skin, layers);
    images.push_back(draw(view));
    EXPECT_EQ(renderer_->stats().draw_calls, 2u);
    renderer_->remove(skin);
  }
  const std::uint8_t* one = images[0].pixel(100, 50);
  const std::uint8_t* two = images[1].pixel(100, 50);
  EXPECT_GT(one[0], 60) << "skin over blue";
  EXPECT_GT(one[2], 140) << "blue through skin";
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(one[c], two[c], 2) << "the hind layer must not add up";

  const SkinHandle skin = renderer_->add_skin(4, std::span(indices).first(6));
  renderer_->begin_step();
  write(skin, 1);
  view.skin_opacity = 0.0f;
  EXPECT_EQ(measure(draw(view)).pixels, 0);
  EXPECT_EQ(renderer_->stats().draw_calls, 0u);
  view.skin_opacity = 1.0f;
  EXPECT_LT(draw(view).pixel(100, 50)[2], 200) << "nothing shines through at opacity 1";
}

TEST_F(MeshDraw, LineSetsFollowTheStepsAndImmediateLinesLastOneFrame) {
  make_renderer(test_options());
  const std::uint32_t indices[] = {0, 1, kPrimitiveRestart, 2, 3, kPrimitiveRestart};
  const LineHandle lines = renderer_->add_lines(4, indices);
  const std::uint32_t white = pack_colour({1, 1, 1, 1});
  const auto write = [&](float y) {
    renderer_->begin_step();
    auto vertices = renderer_->line_vertices(lines);
    vertices[0] = {{-0.4f, y, 0.0f}, white};
    vertices[1] = {{-0.1f, y, 0.0f}, white};
    vertices[2] = {{0.1f, y, 0.0f}, white};
    vertices[3] = {{0.4f, y, 0.0f}, white};
  };
  DrawView view = test_view();
  view.line_width = 1.0f;
  view.lines_through = 0.0f;
  view.alpha = 0.5f;
  write(-0.0975f);
  write(0.1025f);  // half way: row 49
  const Image image = draw(view);
  EXPECT_EQ(renderer_->stats().draw_calls, 1u);
  EXPECT_GT(image.pixel(50, 49)[0], 250);
  EXPECT_GT(image.pixel(150, 49)[0], 250);
  EXPECT_TRUE(is_background(image.pixel(100, 49))) << "primitive restart parts the lines";

  renderer_->set_visible(lines, false);
  renderer_->add_line({0.0025f, -0.2f, 0.0f}, {0.0025f, 0.2f, 0.0f}, pack_colour({0, 1, 0, 1}));
  renderer_->add_point({-0.2f, 0.0f, 0.0f}, pack_colour({1, 0, 0, 1}), 9.0f);
  const Image immediate = draw(view);
  EXPECT_EQ(renderer_->stats().draw_calls, 2u);
  EXPECT_GT(immediate.pixel(100, 50)[1], 250);
  EXPECT_GT(immediate.pixel(60, 50)[0], 250);
  EXPECT_TRUE(is_background(immediate.pixel(66, 50)));
  EXPECT_EQ(measure(draw(view)).pixels, 0);
}

TEST_F(MeshDraw, MarksAreSwitchedApartFromLineSetsAndPointsScale) {
  make_renderer(test_options());
  DrawView view = test_view();
  view.lines_through = 0.0f;
  const auto mark = [&] {
    renderer_->add_line({0.0025f, -0.2f, 0.0f}, {0.0025f, 0.2f, 0.0f}, pack_colour({0, 1, 0, 1}));
    renderer_->add_point({-0.2f, 0.0f, 0.0f}, pack_colour({1, 0, 0, 1}), 9.0f);
  };
  view.lines = false;
  mark();
  const int shown = measure(draw(view)).pixels;
  EXPECT_GT(shown, 80);
  view.point_scale = 3.0f;
  mark();
  EXPECT_NEAR(measure(draw(view)).pixels - shown, 8.0 * 0.785 * 81.0, 60.0) << "a disc of 27 pixels, not of 9";
  view.lines = true;
  view.marks = false;
  mark();
  EXPECT_EQ(measure(draw(view)).pixels, 0);
  view.marks = true;
  EXPECT_EQ(measure(draw(view)).pixels, 0) << "they were of the picture that did not show them";
}

TEST_F(MeshDraw, HiddenLinesShowFaintly) {
  make_renderer(test_options());
  const MeshHandle mesh = renderer_->add_mesh(make_cube(true));
  const RigidHandle group = renderer_->add_rigid(std::span(&mesh, 1));
  renderer_->begin_step();
  renderer_->rigid_matrices(group)[0] = place(0.0f, 0.0f, 0.2f);
  DrawView view = test_view();
  view.line_width = 1.0f;
  std::vector<int> green;
  for (const float through : {0.0f, 0.4f}) {
    view.lines_through = through;
    renderer_->add_line({-0.4f, 0.0025f, 0.0f}, {0.4f, 0.0025f, 0.0f}, pack_colour({0, 1, 0, 1}));
    const Image image = draw(view);
    EXPECT_GT(image.pixel(20, 49)[1], 250) << "free part";
    green.push_back(image.pixel(100, 49)[1] - image.pixel(100, 49)[0]);
  }
  EXPECT_LT(green[0], 20);
  EXPECT_GT(green[1], green[0] + 20);
}

}  // namespace
}  // namespace fascicle
