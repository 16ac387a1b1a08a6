#include "engine/render/window.hpp"

#include <array>
#include <optional>
#include <utility>

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace fascicle {
namespace {

Diagnostic window_error(const std::string& what, const std::string& remedy) {
  const char* message = nullptr;
  glfwGetError(&message);
  return {"window", 0, 0, "", message == nullptr ? what : fmt::format("{}: {}", what, message), remedy};
}

std::optional<Key> to_key(int glfw_key) {
  const auto offset = [](Key first, int by) { return static_cast<Key>(static_cast<int>(first) + by); };
  if (glfw_key >= GLFW_KEY_A && glfw_key <= GLFW_KEY_Z) return offset(Key::a, glfw_key - GLFW_KEY_A);
  if (glfw_key >= GLFW_KEY_F1 && glfw_key <= GLFW_KEY_F12) return offset(Key::f1, glfw_key - GLFW_KEY_F1);
  switch (glfw_key) {
    case GLFW_KEY_SPACE: return Key::space;
    case GLFW_KEY_ESCAPE: return Key::escape;
    case GLFW_KEY_ENTER: return Key::enter;
    case GLFW_KEY_TAB: return Key::tab;
    case GLFW_KEY_BACKSPACE: return Key::backspace;
    case GLFW_KEY_DELETE: return Key::remove;
    case GLFW_KEY_HOME: return Key::home;
    case GLFW_KEY_END: return Key::end;
    case GLFW_KEY_LEFT: return Key::left;
    case GLFW_KEY_RIGHT: return Key::right;
    case GLFW_KEY_UP: return Key::up;
    case GLFW_KEY_DOWN: return Key::down;
    case GLFW_KEY_PAGE_UP: return Key::page_up;
    case GLFW_KEY_PAGE_DOWN: return Key::page_down;
    case GLFW_KEY_PERIOD: return Key::period;
    case GLFW_KEY_COMMA: return Key::comma;
    default: return std::nullopt;
  }
}

InputState& input_of(GLFWwindow* window) { return *static_cast<InputState*>(glfwGetWindowUserPointer(window)); }

void on_key(GLFWwindow* window, int glfw_key, int /*scancode*/, int action, int modifiers) {
  InputState& input = input_of(window);
  input.shift = (modifiers & GLFW_MOD_SHIFT) != 0;
  input.control = (modifiers & GLFW_MOD_CONTROL) != 0;
  input.alt = (modifiers & GLFW_MOD_ALT) != 0;
  const std::optional<Key> key = to_key(glfw_key);
  if (!key) return;
  if (action == GLFW_PRESS) input.pressed.push_back(*key);
  input.keys[static_cast<std::size_t>(*key)] = action != GLFW_RELEASE;
}

void on_character(GLFWwindow* window, unsigned int code_point) { input_of(window).text.push_back(code_point); }

void on_scroll(GLFWwindow* window, double x, double y) {
  input_of(window).scroll += glm::vec2(static_cast<float>(x), static_cast<float>(y));
}

}  // namespace

Result<std::unique_ptr<Window>> Window::create(const WindowOptions& options) {
  if (glfwInit() != GLFW_TRUE) {
    return window_error("no window system", "start it in a desktop session, under xvfb-run, or with --headless");
  }
  glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, options.debug ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_VISIBLE, options.visible ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);  // the renderer draws into its own framebuffer
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  GLFWwindow* glfw_window = glfwCreateWindow(options.width, options.height, options.title.c_str(), nullptr, nullptr);
  if (glfw_window == nullptr) {
    Diagnostic error = window_error("no window with an OpenGL 4.5 core context",
                                    "update the graphics driver, set LIBGL_ALWAYS_SOFTWARE=1, or use --headless");
    glfwTerminate();
    return error;
  }
  std::unique_ptr<Window> window(new Window());
  window->window_ = glfw_window;
  glfwMakeContextCurrent(glfw_window);
  glfwSwapInterval(options.vsync ? 1 : 0);
  Result<GlInfo> info = check_context("window");
  if (!info.ok()) return std::move(info.diagnostics());
  window->info_ = *info;
  window->install_callbacks();
  return window;
}

Window::~Window() {
  if (window_ != nullptr) glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::install_callbacks() {
  glfwSetWindowUserPointer(window_, &input_);
  glfwSetKeyCallback(window_, on_key);
  glfwSetCharCallback(window_, on_character);
  glfwSetScrollCallback(window_, on_scroll);
}

const InputState& Window::poll() {
  input_.pressed.clear();
  input_.text.clear();
  input_.scroll = glm::vec2(0.0f);
  glfwPollEvents();

  constexpr std::array<std::pair<int, MouseButton>, 3> kButtons{{{GLFW_MOUSE_BUTTON_LEFT, MouseButton::left},
                                                                 {GLFW_MOUSE_BUTTON_RIGHT, MouseButton::right},
                                                                 {GLFW_MOUSE_BUTTON_MIDDLE, MouseButton::middle}}};
  for (const auto& [glfw_button, button] : kButtons) {
    input_.buttons[static_cast<std::size_t>(button)] = glfwGetMouseButton(window_, glfw_button) == GLFW_PRESS;
  }
  // The cursor comes in screen coordinates; pixels differ from them on high-density displays.
  int width = 1, height = 1;
  glfwGetWindowSize(window_, &width, &height);
  const glm::vec2 pixels(framebuffer_size());
  double x = 0.0, y = 0.0;
  glfwGetCursorPos(window_, &x, &y);
  const glm::vec2 mouse(static_cast<float>(x) * pixels.x / static_cast<float>(width > 0 ? width : 1),
                        static_cast<float>(y) * pixels.y / static_cast<float>(height > 0 ? height : 1));
  input_.mouse_delta = first_poll_ ? glm::vec2(0.0f) : mouse - input_.mouse;
  input_.mouse = mouse;
  first_poll_ = false;
  return input_;
}

bool Window::should_close() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

void Window::request_close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

void Window::swap() { glfwSwapBuffers(window_); }

glm::ivec2 Window::framebuffer_size() const {
  glm::ivec2 size(0);
  glfwGetFramebufferSize(window_, &size.x, &size.y);
  return size;
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

}  // namespace fascicle
