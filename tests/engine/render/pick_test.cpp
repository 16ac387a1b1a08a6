#include "engine/render/pick.hpp"

#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace fascicle {
namespace {

const glm::vec2 kViewport(1280.0f, 720.0f);

// The pixel that shows a point.
glm::vec2 pixel_of(const OrbitCamera& camera, const glm::vec3& point) {
  const glm::vec4 clip = camera.projection(kViewport.x / kViewport.y) * camera.view() * glm::vec4(point, 1.0f);
  return {0.5f * (clip.x / clip.w + 1.0f) * kViewport.x, 0.5f * (1.0f - clip.y / clip.w) * kViewport.y};
}

TEST(Pick, WithoutAPictureTheRayGoesThroughTheMiddle) {
  const OrbitCamera camera{.target = {1, 2, 3}, .distance = 2.0f, .yaw = 0.7f, .pitch = 0.3f};
  const glm::vec3 forward = glm::normalize(camera.target - camera.eye());
  for (const glm::vec2 viewport : {glm::vec2(0.0f), glm::vec2(0.0f, 720.0f), glm::vec2(-1.0f, 3.0f)}) {
    const Ray ray = ray_through(camera, {10.0f, 20.0f}, viewport);
    EXPECT_LT(glm::length(ray.direction - forward), 1e-5f);
    EXPECT_EQ(ray.origin, camera.eye());
  }
}

TEST(Pick, TheRayThroughAPointsPixelMeetsThePoint) {
  const OrbitCamera camera{.target = {0.1f, 0.9f, -0.2f}, .distance = 1.7f, .yaw = -2.1f, .pitch = 0.4f};
  const glm::vec3 points[] = {{0.1f, 0.9f, -0.2f}, {0.4f, 1.1f, 0.0f}, {-0.2f, 0.6f, 0.1f}};
  for (const glm::vec3& point : points) {
    const Ray ray = ray_through(camera, pixel_of(camera, point), kViewport);
    EXPECT_NEAR(glm::length(ray.direction), 1.0f, 1e-5f);
    const float along = glm::dot(point - ray.origin, ray.direction);
    EXPECT_GT(along, 0.0f);
    EXPECT_LT(glm::length(ray.origin + along * ray.direction - point), 1e-4f);
  }
}

TEST(Pick, TrianglesAreHitFromBothSidesButNotBehindOrBeside) {
  const glm::vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  for (const float side : {2.0f, -2.0f}) {
    const glm::vec3 towards(0, 0, side > 0 ? -1 : 1);
    const auto hit = hit_triangle({{0.25f, 0.25f, side}, towards}, a, b, c);
    ASSERT_TRUE(hit.has_value());
    EXPECT_FLOAT_EQ(*hit, 2.0f);
    EXPECT_FALSE(hit_triangle({{0.25f, 0.25f, side}, -towards}, a, b, c).has_value());
    EXPECT_FALSE(hit_triangle({{0.6f, 0.6f, side}, towards}, a, b, c).has_value());
    EXPECT_FALSE(hit_triangle({{-0.1f, 0.5f, side}, towards}, a, b, c).has_value());
    EXPECT_FALSE(hit_triangle({{0.25f, 0.25f, side}, towards}, a, b, b).has_value());
    EXPECT_FALSE(hit_triangle({{0.25f, 0.25f, side}, towards}, a, a, a).has_value());
  }
  EXPECT_FALSE(hit_triangle({{0.2f, 0.2f, 1.0f}, {1, 0, 0}}, a, b, c).has_value()) << "beside it";
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(hit_triangle({{0.25f, 0.25f, nan}, {0, 0, -1}}, a, b, c).has_value());
  EXPECT_FALSE(hit_triangle({{0.25f, 0.25f, 1.0f}, {0, 0, -1}}, a, glm::vec3(nan), c).has_value());
}

TEST(Pick, AMeshIsHitWhereItStandsAndAsFarAwayAsInTheWorld) {
  TriangleMesh mesh;  // two squares, the nearer one second
  for (const float z : {-1.0f, 1.0f}) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec2 at : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
      mesh.positions.push_back({at, z});
    }
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
  }
  const glm::mat4 place = glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(5, 0, 0)), glm::vec3(0.5f));
  const auto hit = hit_mesh({{5.2f, 0.1f, 4.0f}, {0, 0, -1}}, mesh, place);
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(*hit, 3.5f, 1e-5f);
  EXPECT_FALSE(hit_mesh({{5.7f, 0.1f, 4.0f}, {0, 0, -1}}, mesh, place).has_value());
  EXPECT_FALSE(hit_mesh({{5.0f, 0.0f, 4.0f}, {0, 0, -1}}, TriangleMesh{}, place).has_value());
}

class Clicks : public testing::Test {
 protected:
  bool frame(glm::vec2 mouse, bool held, bool blocked = false, bool shift = false) {
    InputState input;
    input.mouse = mouse;
    input.buttons[0] = held;
    input.shift = shift;
    const auto click = tracker_.update(input, blocked);
    if (click) {
      EXPECT_EQ(*click, mouse);
    }
    return click.has_value();
  }
  ClickTracker tracker_;
};

TEST_F(Clicks, APressThatEndsWhereItBeganIsAClickOnce) {
  EXPECT_FALSE(frame({50, 50}, false));
  EXPECT_FALSE(frame({50, 50}, true));
  EXPECT_FALSE(frame({52, 51}, true));
  EXPECT_TRUE(frame({52, 51}, false));
  EXPECT_FALSE(frame({52, 51}, false));
}

TEST_F(Clicks, DragsPansAndPressesOnTheOverlayAreNone) {
  frame({50, 50}, true);
  frame({90, 50}, true);
  EXPECT_FALSE(frame({50, 50}, false)) << "it came back";
  frame({50, 50}, true);
  EXPECT_FALSE(frame({90, 50}, false));
  frame({50, 50}, true, true);
  EXPECT_FALSE(frame({50, 50}, false));
  frame({50, 50}, true, false, true);
  EXPECT_FALSE(frame({50, 50}, false));
  frame({50, 50}, true);
  EXPECT_TRUE(frame({50, 50}, false));
}

}  // namespace
}  // namespace fascicle
