// Where pictures go: a window, or a context without any display. Both give the same renderer and overlay.
#pragma once

#include <memory>

#include "engine/render/headless.hpp"
#include "engine/render/overlay.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/window.hpp"

namespace fascicle::game {

struct Screen {
  std::unique_ptr<Window> window;      // one of these two
  std::unique_ptr<Headless> headless;
  std::unique_ptr<Renderer> renderer;
  std::unique_ptr<Overlay> overlay;
  GlInfo info;

  ~Screen();  // the context goes last

  // A finished picture of `width` by `height` pixels; the renderer keeps its own size. Without a graphics card frames
  // are drawn with one sample a pixel, because more would cost several times as much, and pictures with four.
  Image take_picture(const DrawView& view, int width, int height);
};

Result<std::unique_ptr<Screen>> open_window(const std::string& title, int width, int height);
Result<std::unique_ptr<Screen>> open_headless(int width, int height);

}  // namespace fascicle::game
