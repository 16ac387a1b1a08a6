// Owners of GL objects, and the count of what they hold. Everything here needs the context current, destruction too.
// Includes GL: for the renderer's own sources only.
#pragma once

#include <cstdint>
#include <utility>

#include <epoxy/gl.h>

namespace fascicle {

// Buffers made since the start and bytes held now, for RenderStats.
struct GpuMemory {
  std::uint64_t allocations = 0;
  std::uint64_t bytes = 0;
};

// Owns one GL name; Traits::destroy(GLuint) frees it.
template <class Traits>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(GLuint name) : name_(name) {}
  GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlObject() {
    if (name_ != 0) Traits::destroy(name_);
  }
  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

struct VertexArrayTraits {
  static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct TextureTraits {
  static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct RenderbufferTraits {
  static void destroy(GLuint name) { glDeleteRenderbuffers(1, &name); }
};
struct FramebufferTraits {
  static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};
struct ProgramTraits {
  static void destroy(GLuint name) { glDeleteProgram(name); }
};
using GlVertexArray = GlObject<VertexArrayTraits>;
using GlTexture = GlObject<TextureTraits>;
using GlRenderbuffer = GlObject<RenderbufferTraits>;
using GlFramebuffer = GlObject<FramebufferTraits>;
using GlProgram = GlObject<ProgramTraits>;

inline GlVertexArray make_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return GlVertexArray(name);
}

// A command of glMultiDrawElementsIndirect.
struct DrawCommand {
  GLuint count = 0;
  GLuint instance_count = 0;
  GLuint first_index = 0;
  GLint base_vertex = 0;
  GLuint base_instance = 0;
};

}  // namespace fascicle
