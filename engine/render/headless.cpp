#include "engine/render/headless.hpp"

#include <cstring>
#include <vector>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

namespace fascicle {
namespace {

constexpr const char* kRemedy =
    "install Mesa's EGL (Debian: libegl1 libegl-mesa0 libgl1-mesa-dri) or a graphics driver with EGL";

const char* egl_error_name(EGLint error) {
  switch (error) {
    case EGL_SUCCESS: return "no error given";
    case EGL_NOT_INITIALIZED: return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS: return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC: return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE: return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG: return "EGL_BAD_CONFIG";
    case EGL_BAD_CONTEXT: return "EGL_BAD_CONTEXT";
    case EGL_BAD_DISPLAY: return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH: return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER: return "EGL_BAD_PARAMETER";
    default: return "unknown EGL error";
  }
}

bool client_has(const char* extension) {
  const char* all = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  return all != nullptr && std::strstr(all, extension) != nullptr;
}

struct Candidate {
  std::string name;
  EGLDisplay display = EGL_NO_DISPLAY;
};

// Graphics cards that EGL can open, without the software device.
void append_devices(std::vector<Candidate>& candidates) {
  if (!client_has("EGL_EXT_device_enumeration") && !client_has("EGL_EXT_device_base")) return;
  EGLDeviceEXT devices[16];
  EGLint count = 0;
  if (eglQueryDevicesEXT(16, devices, &count) != EGL_TRUE) return;
  for (EGLint i = 0; i < count; ++i) {
    const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
    if (extensions != nullptr && std::strstr(extensions, "EGL_MESA_device_software") != nullptr) continue;
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
    if (display != EGL_NO_DISPLAY) candidates.push_back({fmt::format("device {}", i), display});
  }
}

void append_surfaceless(std::vector<Candidate>& candidates) {
  if (!client_has("EGL_MESA_platform_surfaceless")) return;
  const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display != EGL_NO_DISPLAY) candidates.push_back({"surfaceless", display});
}

// Opens a 4.5 core context on the display and makes it current; on failure returns what went wrong.
std::string open_context(EGLDisplay display, bool debug, EGLContext& context) {
  const auto failed = [](const char* call) { return fmt::format("{}: {}", call, egl_error_name(eglGetError())); };
  if (eglInitialize(display, nullptr, nullptr) != EGL_TRUE) return failed("eglInitialize");
  std::string problem;
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  if (extensions == nullptr || std::strstr(extensions, "EGL_KHR_surfaceless_context") == nullptr) {
    problem = "EGL_KHR_surfaceless_context is missing";
  } else if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) {
    problem = failed("eglBindAPI(OpenGL)");
  } else {
    const EGLint config_attributes[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = EGL_NO_CONFIG_KHR;
    EGLint count = 0;
    if (eglChooseConfig(display, config_attributes, &config, 1, &count) != EGL_TRUE || count == 0) {
      config = EGL_NO_CONFIG_KHR;
    }
    const EGLint context_attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                         EGL_CONTEXT_OPENGL_DEBUG, debug ? EGL_TRUE : EGL_FALSE, EGL_NONE};
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_attributes);
    if (context == EGL_NO_CONTEXT) {
      problem = failed("eglCreateContext(OpenGL 4.5 core)");
    } else if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
      problem = failed("eglMakeCurrent");
      eglDestroyContext(display, context);
      context = EGL_NO_CONTEXT;
    }
  }
  return problem;
}

}  // namespace

Result<std::unique_ptr<Headless>> Headless::create(const HeadlessOptions& options) {
  std::vector<Candidate> candidates;
  if (options.prefer_hardware) append_devices(candidates);
  append_surfaceless(candidates);
  if (!options.prefer_hardware) append_devices(candidates);
  if (candidates.empty()) {
    return Diagnostic{"EGL", 0, 0, "", "neither the surfaceless platform nor a device is offered", kRemedy};
  }
  Diagnostics problems;
  for (const Candidate& candidate : candidates) {
    EGLContext context = EGL_NO_CONTEXT;
    const std::string problem = open_context(candidate.display, options.debug, context);
    if (!problem.empty()) {
      problems.errors.push_back({"EGL " + candidate.name, 0, 0, "", problem, kRemedy});
      continue;
    }
    std::unique_ptr<Headless> headless(new Headless());
    headless->display_ = candidate.display;
    headless->context_ = context;
    headless->platform_ = candidate.name;
    Result<GlInfo> info = check_context("EGL " + candidate.name);
    if (!info.ok()) {
      problems.append(std::move(info.diagnostics()));
      continue;
    }
    headless->info_ = *info;
    return headless;
  }
  return problems;
}

Headless::~Headless() {
  // The display is the process's and may hold other contexts, so it isn't terminated.
  release();
  if (context_ != nullptr) eglDestroyContext(display_, context_);
}

void Headless::make_current() { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_); }

void Headless::release() {
  if (display_ != nullptr) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace fascicle
