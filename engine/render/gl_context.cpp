#include "engine/render/gl_context.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

namespace fascicle {
namespace {

constexpr std::size_t kMaxMessages = 64;

std::string gl_string(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}

void GLAPIENTRY on_debug_message(GLenum /*source*/, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                 const GLchar* message, const void* user) {
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION) return;
  const bool is_error = type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR;
  const std::string text = length > 0 ? std::string(message, static_cast<std::size_t>(length)) : std::string(message);
  auto* log = static_cast<GlDebugLog*>(const_cast<void*>(user));
  log->record(is_error, fmt::format("GL {}: {}", id, text));
}

}  // namespace

Result<GlInfo> check_context(const std::string& origin) {
  GlInfo info;
  info.version = gl_string(GL_VERSION);
  info.vendor = gl_string(GL_VENDOR);
  info.renderer = gl_string(GL_RENDERER);
  if (info.version.empty()) {
    return Diagnostic{origin, 0, 0, "OpenGL", "the context answers no version",
                      "install a driver with OpenGL 4.5 (Debian: libgl1-mesa-dri)"};
  }
  glGetIntegerv(GL_MAJOR_VERSION, &info.major);
  glGetIntegerv(GL_MINOR_VERSION, &info.minor);
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer"}) {
    if (info.renderer.find(name) != std::string::npos) info.software = true;
  }
  if (info.major < 4 || (info.major == 4 && info.minor < 5)) {
    return Diagnostic{origin, 0, 0, "OpenGL",
                      fmt::format("{} offers OpenGL {}.{}; 4.5 is needed", info.renderer, info.major, info.minor),
                      "update the graphics driver, or set LIBGL_ALWAYS_SOFTWARE=1 to draw with Mesa's llvmpipe"};
  }
  return info;
}

GlDebugLog::GlDebugLog() {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(on_debug_message, this);
}

GlDebugLog::~GlDebugLog() {
  glDebugMessageCallback(nullptr, nullptr);
  glDisable(GL_DEBUG_OUTPUT);
}

std::vector<std::string> GlDebugLog::take_errors() {
  const std::lock_guard lock(mutex_);
  return std::exchange(errors_, {});
}

std::vector<std::string> GlDebugLog::take_warnings() {
  const std::lock_guard lock(mutex_);
  return std::exchange(warnings_, {});
}

void GlDebugLog::record(bool is_error, std::string message) {
  const std::lock_guard lock(mutex_);
  auto& messages = is_error ? errors_ : warnings_;
  if (messages.size() < kMaxMessages) messages.push_back(std::move(message));
}

}  // namespace fascicle
