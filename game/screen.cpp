#include "game/screen.hpp"

namespace fascicle::game {
namespace {

Result<std::unique_ptr<Screen>> finish(std::unique_ptr<Screen> screen, int width, int height) {
  RendererOptions options;
  options.width = width;
  options.height = height;
  if (screen->info.software) options.samples = 0;
  auto renderer = Renderer::create(options);
  if (!renderer) return renderer.diagnostics();
  screen->renderer = std::move(*renderer);
  auto overlay = Overlay::create();
  if (!overlay) return overlay.diagnostics();
  screen->overlay = std::move(*overlay);
  return screen;
}

}  // namespace

Screen::~Screen() {
  overlay.reset();
  renderer.reset();
}

Image Screen::take_picture(const DrawView& view, int width, int height) {
  const int own_width = renderer->width(), own_height = renderer->height();
  const int factor = info.software ? 2 : 1;
  renderer->resize(factor * width, factor * height);
  DrawView scaled = view;
  scaled.line_width *= static_cast<float>(factor);
  scaled.point_scale *= static_cast<float>(factor);
  renderer->draw(scaled);
  Image image = renderer->read_image();
  renderer->resize(own_width, own_height);
  return factor == 1 ? image : shrink(image, factor);
}

Result<std::unique_ptr<Screen>> open_window(const std::string& title, int width, int height) {
  auto screen = std::make_unique<Screen>();
  WindowOptions options;
  options.title = title;
  options.width = width;
  options.height = height;
  auto window = Window::create(options);
  if (!window) return window.diagnostics();
  screen->window = std::move(*window);
  screen->info = screen->window->info();
  const glm::ivec2 size = screen->window->framebuffer_size();
  return finish(std::move(screen), size.x, size.y);
}

Result<std::unique_ptr<Screen>> open_headless(int width, int height) {
  auto screen = std::make_unique<Screen>();
  auto headless = Headless::create();
  if (!headless) return headless.diagnostics();
  screen->headless = std::move(*headless);
  screen->info = screen->headless->info();
  return finish(std::move(screen), width, height);
}

}  // namespace fascicle::game
