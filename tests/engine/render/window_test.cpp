// The window needs an X server: the test starts an Xvfb of its own, and skips where there is none.
#include "engine/render/window.hpp"

#include <csignal>
#include <cstdlib>
#include <optional>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/engine/render/render_fixture.hpp"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

namespace fascicle {
namespace {

class VirtualDisplay {
 public:
  VirtualDisplay() {
    int ends[2] = {-1, -1};
    if (pipe(ends) != 0) return;
    child_ = fork();
    if (child_ == 0) {
      const std::string display_end = std::to_string(ends[1]);
      const int nowhere = open("/dev/null", O_WRONLY);
      dup2(nowhere, STDERR_FILENO);
      execlp("Xvfb", "Xvfb", "-displayfd", display_end.c_str(), "-screen", "0", "800x600x24", "-nolisten", "tcp",
             static_cast<char*>(nullptr));
      _exit(127);
    }
    close(ends[1]);
    char text[16] = {};
    const ssize_t length = read(ends[0], text, sizeof(text) - 1);
    close(ends[0]);
    if (length > 0) number_ = std::atoi(text);
  }
  ~VirtualDisplay() {
    if (child_ <= 0) return;
    kill(child_, SIGTERM);
    waitpid(child_, nullptr, 0);
  }
  std::optional<int> number() const { return number_; }

 private:
  pid_t child_ = -1;
  std::optional<int> number_;
};

// What X and GL libraries allocate while they open a window stays until they are unloaded, and then nobody can tell
// whose it was: the leak sanitizer leaves out what is allocated in the life of this.
struct LibrariesMayLeak {
#if defined(__SANITIZE_ADDRESS__)
  LibrariesMayLeak() { __lsan_disable(); }
  ~LibrariesMayLeak() { __lsan_enable(); }
#else
  LibrariesMayLeak() {}
#endif
};

TEST(Window, WithoutADisplayItSaysWhatToDo) {
  const LibrariesMayLeak exempt;
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  const auto window = Window::create();
  ASSERT_FALSE(window.ok());
  EXPECT_THAT(to_text(window.diagnostics()), testing::HasSubstr("--headless"));
}

TEST(Window, DrawsAndPresentsThroughTheSameRenderer) {
  const LibrariesMayLeak exempt;  // other tests look for the renderer's own leaks
  const VirtualDisplay display;
  if (!display.number()) GTEST_SKIP() << "Xvfb is not installed";
  setenv("DISPLAY", fmt::format(":{}", *display.number()).c_str(), 1);
  WindowOptions window_options;
  window_options.width = 320;
  window_options.height = 200;
  window_options.vsync = false;
  window_options.debug = true;
  auto made = Window::create(window_options);
  if (!made.ok()) GTEST_SKIP() << "no OpenGL 4.5 in Xvfb: " << to_text(made.diagnostics());
  Window& window = **made;
  GlDebugLog log;
  EXPECT_EQ(window.framebuffer_size(), glm::ivec2(320, 200));
  EXPECT_FALSE(window.should_close());
  {
    RendererOptions options = test_options();
    options.width = 320;
    options.height = 200;
    auto renderer = Renderer::create(options);
    ASSERT_TRUE(renderer.ok()) << to_text(renderer.diagnostics());
    for (int frame = 0; frame < 3; ++frame) {
      EXPECT_TRUE(window.poll().pressed.empty());
      (*renderer)->draw(test_view());
      (*renderer)->present(320, 200);
      window.swap();
    }
    EXPECT_TRUE(is_background((*renderer)->read_image().pixel(160, 100)));
  }
  window.request_close();
  EXPECT_TRUE(window.should_close());
  for (const std::string& error : log.take_errors()) ADD_FAILURE() << error;
}

}  // namespace
}  // namespace fascicle
