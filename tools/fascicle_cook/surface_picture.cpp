#include "tools/fascicle_cook/surface_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "game/scene_view.hpp"
#include "game/screen.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "tools/fascicle_cook/surface_switches.hpp"

namespace fascicle::cook {
namespace {

constexpr int kGap = 4;              // pixels between pictures
constexpr float kRoom = 1.05f;       // round the muscles
constexpr float kTextSize = 15.0f;   // pixels

// The scene's, moved to where it sees all surface muscles and not much else.
OrbitCamera near_camera(const muscle::SceneAsset& scene, const ecs::World& world) {
  OrbitCamera camera = game::scene_camera(scene);
  glm::vec3 lower(std::numeric_limits<float>::max()), upper = -lower;
  world.view<const muscle::DrawnSurface>().each([&](const muscle::DrawnSurface& drawn) {
    for (const muscle::SurfaceVertex& vertex : drawn.vertices) {
      lower = glm::min(lower, vertex.position);
      upper = glm::max(upper, vertex.position);
    }
  });
  if (!(glm::distance(lower, upper) < 100.0f)) return camera;  // none, or not finite
  camera.target = 0.5f * (lower + upper);
  camera.distance = kRoom * 0.5f * glm::distance(lower, upper) / std::tan(0.5f * camera.fov);
  return camera;
}

// The scene at some of its steps, one after the other; from all sides each. `camera`: set at the first of them where it
// is not.
std::vector<std::vector<Image>> play(const BesidePicture& picture,
                                     const std::shared_ptr<const muscle::SceneAsset>& scene,
                                     const SurfaceRunOptions& options, const std::vector<std::uint64_t>& steps,
                                     std::optional<OrbitCamera>& camera, game::Screen& screen) {
  game::Simulation simulation(scene, simulation_options(options));
  switch_off(options, simulation.world());
  game::SceneView scene_view(simulation, *screen.renderer);
  DrawView view;
  view.lines = view.ground = view.shadow = false;
  view.back_faces = true;
  std::vector<std::vector<Image>> images(steps.size());
  for (std::uint64_t step = 1; step <= *std::max_element(steps.begin(), steps.end()); ++step) {
    scene_view.begin_step();
    simulation.step();
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (steps[i] != step) continue;
      if (!camera) camera = near_camera(*scene, simulation.world());
      for (int side = 0; side < picture.sides; ++side) {
        view.camera = *camera;
        view.camera.yaw += glm::two_pi<float>() * static_cast<float>(side) / static_cast<float>(picture.sides);
        images[i].push_back(screen.take_picture(view, picture.width, picture.height));
      }
    }
  }
  scene_view.release();  // the renderer shows another scene next
  return images;
}

// A line of text over each column.
Image draw_head(const BesidePicture& picture, int width, game::Screen& screen) {
  const int height = static_cast<int>(1.8f * kTextSize);
  std::vector<Caption> captions;
  for (std::size_t i = 0; i < picture.pairs.size(); ++i) {
    const auto place = [&](std::size_t column) {
      return glm::vec2(static_cast<float>(static_cast<int>(column) * (picture.width + kGap)) + 0.5f * kTextSize,
                       0.3f * kTextSize);
    };
    captions.push_back({place(2 * i), fmt::format("coarse hull, {:.2f} rad", picture.pairs[i].angle), 0xffffffffu, false});
    captions.push_back({place(2 * i + 1), fmt::format("dynamics, {:.2f} rad", picture.pairs[i].angle), 0xffffffffu, false});
  }
  DrawView empty;
  empty.strips = empty.meshes = empty.skins = empty.lines = empty.marks = empty.ground = empty.shadow = false;
  screen.renderer->resize(width, height);
  screen.renderer->draw(empty);
  screen.overlay->draw_captions(captions, kTextSize, *screen.renderer);
  return screen.renderer->read_image();
}

}  // namespace

std::vector<PosePair> spread_pairs(const std::vector<PosePair>& pairs, std::size_t count) {
  if (pairs.size() <= count || count < 2) return pairs;
  std::vector<PosePair> spread;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = pairs.front().angle + (pairs.back().angle - pairs.front().angle) * static_cast<double>(i) /
                                                   static_cast<double>(count - 1);
    spread.push_back(*std::min_element(pairs.begin(), pairs.end(), [&](const PosePair& one, const PosePair& other) {
      return std::abs(one.angle - angle) < std::abs(other.angle - angle);
    }));
  }
  return spread;
}

Diagnostics draw_beside(const BesidePicture& given, const std::filesystem::path& png) {
  BesidePicture picture = given;
  picture.pairs = spread_pairs(given.pairs, std::min<std::size_t>(given.pairs.size(), 4));
  if (picture.pairs.empty()) {
    return {{{png.string(), 0, 0, "", "no pose of the scene has one of the other motion's beside it",
              "name a motion that goes through the same poses"}},
            {}};
  }
  auto screen = game::open_headless(picture.width, picture.height);
  if (!screen) return screen.diagnostics();
  std::vector<std::uint64_t> steps, beside_steps;
  for (const PosePair& pair : picture.pairs) {
    steps.push_back(pair.step);
    beside_steps.push_back(pair.beside);
  }
  std::optional<OrbitCamera> camera;
  const auto hull = play(picture, picture.scene, picture.options, steps, camera, **screen);
  const auto dynamics = play(picture, picture.beside, picture.beside_options, beside_steps, camera, **screen);
  std::vector<Image> images;
  for (std::size_t side = 0; side < static_cast<std::size_t>(picture.sides); ++side) {
    for (std::size_t i = 0; i < hull.size(); ++i) {
      images.push_back(hull[i][side]);
      images.push_back(dynamics[i][side]);
    }
  }
  const Image sheet = contact_sheet(images, static_cast<int>(2 * hull.size()), kGap);
  Image whole = draw_head(picture, sheet.width, **screen);
  whole.height += sheet.height;
  whole.rgb.insert(whole.rgb.end(), sheet.rgb.begin(), sheet.rgb.end());
  return write_png(whole, png).diagnostics();
}

}  // namespace fascicle::cook
