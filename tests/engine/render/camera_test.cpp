#include "engine/render/camera.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/render/input.hpp"

namespace fascicle {
namespace {

constexpr float kPi = 3.14159265f;
const glm::vec2 kViewport(1280.0f, 720.0f);

glm::vec3 project(const OrbitCamera& camera, const glm::vec3& point) {
  const glm::vec4 clip = camera.projection(1.0f) * camera.view() * glm::vec4(point, 1.0f);
  return glm::vec3(clip) / clip.w;
}

TEST(OrbitCamera, YawZeroLooksAlongMinusZAndYawRightGoesToPlusX) {
  OrbitCamera camera{.target = {1, 2, 3}, .distance = 2.0f, .yaw = 0.0f, .pitch = 0.0f};
  EXPECT_LT(glm::length(camera.eye() - glm::vec3(1, 2, 5)), 1e-5f);
  camera.yaw = 0.5f * kPi;
  EXPECT_LT(glm::length(camera.eye() - glm::vec3(3, 2, 3)), 1e-5f);
  camera.pitch = 0.25f * kPi;
  EXPECT_GT(camera.eye().y, 2.0f) << "positive pitch looks down";
}

TEST(OrbitCamera, TargetIsAtTheCentreAndUpIsUp) {
  const OrbitCamera camera{.target = {1, 2, 3}, .distance = 3.0f, .yaw = 1.1f, .pitch = 0.3f};
  const glm::vec3 centre = project(camera, camera.target);
  EXPECT_NEAR(centre.x, 0.0f, 1e-5f);
  EXPECT_NEAR(centre.y, 0.0f, 1e-5f);
  EXPECT_GT(centre.z, -1.0f);
  EXPECT_LT(centre.z, 1.0f);
  EXPECT_GT(project(camera, camera.target + glm::vec3(0, 0.1f, 0)).y, 0.0f);
}

TEST(OrbitCamera, FovIsTheVerticalAngle) {
  const OrbitCamera camera{.target = {0, 0, 0}, .distance = 2.0f, .yaw = 0.0f, .pitch = 0.0f, .fov = 0.8f};
  EXPECT_NEAR(project(camera, {0.0f, 2.0f * std::tan(0.4f), 0.0f}).y, 1.0f, 1e-5f);
}

TEST(ApplyInput, EmptyViewportAndNoInputChangeNothing) {
  OrbitCamera camera;
  InputState input;
  apply_input(input, kViewport, camera);
  input.buttons[0] = true;
  input.mouse_delta = {100, 100};
  apply_input(input, glm::vec2(0.0f), camera);
  EXPECT_EQ(camera.yaw, OrbitCamera{}.yaw);
  EXPECT_EQ(camera.distance, OrbitCamera{}.distance);
}

TEST(ApplyInput, DragOrbitsPansAndZooms) {
  InputState input;
  input.mouse_delta = {72.0f, 36.0f};
  input.buttons[static_cast<std::size_t>(MouseButton::left)] = true;
  OrbitCamera camera;
  apply_input(input, kViewport, camera);
  EXPECT_NEAR(camera.yaw, 0.6f - 0.1f * kPi, 1e-5f) << "the scene follows the pointer";
  EXPECT_NEAR(camera.pitch, 0.1f + 0.05f * kPi, 1e-5f);

  OrbitCamera panned;
  panned.yaw = panned.pitch = 0.0f;
  input.shift = true;
  apply_input(input, kViewport, panned);
  const float view_height = 2.0f * 2.6f * std::tan(0.35f);
  EXPECT_NEAR(panned.target.x, -0.1f * view_height, 1e-5f);
  EXPECT_NEAR(panned.target.y, 0.7f + 0.05f * view_height, 1e-5f);
  EXPECT_EQ(panned.yaw, 0.0f);

  OrbitCamera zoomed;
  InputState wheel;
  wheel.scroll.y = 1.0f;
  apply_input(wheel, kViewport, zoomed);
  EXPECT_LT(zoomed.distance, 2.6f);
}

TEST(ApplyInput, StaysInRangeHoweverFarTheDrag) {
  OrbitCamera camera;
  InputState input;
  input.buttons[static_cast<std::size_t>(MouseButton::left)] = true;
  input.mouse_delta = {1e7f, 1e7f};
  input.scroll.y = -1e4f;
  apply_input(input, kViewport, camera);
  EXPECT_LE(camera.pitch, 0.5f * kPi);
  EXPECT_LE(std::abs(camera.yaw), kPi + 1e-4f);
  EXPECT_LE(camera.distance, 200.0f);
  EXPECT_TRUE(std::isfinite(camera.view()[0][0]));
}

TEST(FrameBox, BoxIsInsideTheView) {
  OrbitCamera camera{.yaw = 0.7f, .pitch = 0.2f};
  const glm::vec3 low(-1, 0, -1), high(2, 3, 1);
  frame_box(low, high, 1.0f, camera);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 point((corner & 1) != 0 ? low.x : high.x, (corner & 2) != 0 ? low.y : high.y,
                          (corner & 4) != 0 ? low.z : high.z);
    const glm::vec3 at = project(camera, point);
    EXPECT_LE(std::max(std::abs(at.x), std::abs(at.y)), 1.0f);
  }
}

}  // namespace
}  // namespace fascicle
