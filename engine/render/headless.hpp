// An OpenGL 4.5 core context without any display, window or X server, through EGL: on a graphics card where one can be
// had, else on Mesa's software rasteriser. The same renderer runs on it as in a window.
#pragma once

#include <memory>

#include "engine/content/result.hpp"
#include "engine/render/gl_context.hpp"

namespace fascicle {

struct HeadlessOptions {
  bool prefer_hardware = true;  // try EGL devices (graphics cards) before the surfaceless platform
  bool debug = true;            // ask for a debug context
};

class Headless {
 public:
  // Makes the context and makes it current on the calling thread. Errors name what EGL said and what to install.
  static Result<std::unique_ptr<Headless>> create(const HeadlessOptions& options = {});
  ~Headless();
  Headless(const Headless&) = delete;
  Headless& operator=(const Headless&) = delete;

  const GlInfo& info() const { return info_; }
  const std::string& platform() const { return platform_; }  // "device 0", "surfaceless"
  void make_current();
  void release();  // no context current afterwards on this thread

 private:
  Headless() = default;

  void* display_ = nullptr;  // EGLDisplay
  void* context_ = nullptr;  // EGLContext
  std::string platform_;
  GlInfo info_;
};

}  // namespace fascicle
