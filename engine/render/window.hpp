// A window with an OpenGL 4.5 core context (GLFW) and the user's input in it. One window a program; main thread only.
#pragma once

#include <memory>
#include <string>

#include <glm/vec2.hpp>

#include "engine/content/result.hpp"
#include "engine/render/gl_context.hpp"
#include "engine/render/input.hpp"

struct GLFWwindow;

namespace fascicle {

struct WindowOptions {
  std::string title = "fascicle";
  int width = 1280;   // screen coordinates
  int height = 720;
  bool vsync = true;
  bool visible = true;
  bool debug = false;
};

class Window {
 public:
  // Opens the window and makes its context current. Errors: no display, no OpenGL 4.5.
  static Result<std::unique_ptr<Window>> create(const WindowOptions& options = {});
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  // Handles waiting events and returns what the user did since the last call. Valid until the next call.
  const InputState& poll();
  bool should_close() const;
  void request_close();
  void swap();
  glm::ivec2 framebuffer_size() const;  // pixels; (0, 0) while minimised
  void set_title(const std::string& title);
  const GlInfo& info() const { return info_; }
  GLFWwindow* glfw() const { return window_; }

 private:
  Window() = default;
  void install_callbacks();

  GLFWwindow* window_ = nullptr;
  GlInfo info_;
  InputState input_;
  bool first_poll_ = true;
};

}  // namespace fascicle
