#include "engine/render/frame_target.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace fascicle {
namespace {

GlFramebuffer make_framebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return GlFramebuffer(name);
}

GlRenderbuffer make_renderbuffer(GLenum format, int width, int height, int samples) {
  GLuint name = 0;
  glCreateRenderbuffers(1, &name);
  glNamedRenderbufferStorageMultisample(name, samples, format, width, height);
  return GlRenderbuffer(name);
}

GlTexture make_texture(GLenum format, int width, int height) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  glTextureStorage2D(name, 1, format, width, height);
  return GlTexture(name);
}

int most_samples() {
  GLint colour = 0, depth = 0;
  glGetInternalformativ(GL_RENDERBUFFER, GL_SRGB8_ALPHA8, GL_SAMPLES, 1, &colour);  // the largest comes first
  glGetInternalformativ(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, GL_SAMPLES, 1, &depth);
  return std::min(colour, depth);
}

void check_complete(const GlFramebuffer& framebuffer, const char* name, Diagnostics& problems) {
  const GLenum status = glCheckNamedFramebufferStatus(framebuffer.name(), GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return;
  problems.errors.push_back({"OpenGL", 0, 0, name, fmt::format("the framebuffer is not complete (0x{:x})", status),
                             "lower the picture's size or the number of samples"});
}

}  // namespace

Result<FrameTarget> FrameTarget::create(int width, int height, int samples, int shadow_size) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &limit);
  if (width < 1 || height < 1 || width > limit || height > limit) {
    return Diagnostic{"OpenGL", 0, 0, "picture", fmt::format("{} x {} pixels", width, height),
                      fmt::format("each side takes 1 to {} pixels", limit)};
  }
  FrameTarget target;
  target.width_ = width;
  target.height_ = height;
  target.samples_ = samples > 1 ? std::min(samples, most_samples()) : 0;
  if (target.samples_ < 2) target.samples_ = 0;
  target.shadow_size_ = std::clamp(shadow_size, 0, static_cast<int>(limit));

  target.picture_ = make_texture(GL_SRGB8_ALPHA8, width, height);
  target.resolved_ = make_framebuffer();
  glNamedFramebufferTexture(target.resolved_.name(), GL_COLOR_ATTACHMENT0, target.picture_.name(), 0);
  target.scene_ = make_framebuffer();
  target.depth_ = make_renderbuffer(GL_DEPTH_COMPONENT32F, width, height, target.samples_);
  glNamedFramebufferRenderbuffer(target.scene_.name(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target.depth_.name());
  if (target.samples_ > 0) {
    target.samples_colour_ = make_renderbuffer(GL_SRGB8_ALPHA8, width, height, target.samples_);
    glNamedFramebufferRenderbuffer(target.scene_.name(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                   target.samples_colour_.name());
  } else {
    glNamedFramebufferTexture(target.scene_.name(), GL_COLOR_ATTACHMENT0, target.picture_.name(), 0);
  }
  Diagnostics problems;
  check_complete(target.resolved_, "picture", problems);
  check_complete(target.scene_, "scene", problems);
  if (target.shadow_size_ > 0) {
    target.shadow_map_ = make_texture(GL_DEPTH_COMPONENT24, target.shadow_size_, target.shadow_size_);
    const GLuint map = target.shadow_map_.name();
    glTextureParameteri(map, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(map, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(map, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(map, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTextureParameteri(map, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTextureParameteri(map, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    target.shadow_ = make_framebuffer();
    glNamedFramebufferTexture(target.shadow_.name(), GL_DEPTH_ATTACHMENT, map, 0);
    glNamedFramebufferDrawBuffer(target.shadow_.name(), GL_NONE);
    check_complete(target.shadow_, "shadow map", problems);
  }
  if (!problems.ok()) return problems;
  return target;
}

void FrameTarget::begin_shadow() {
  const float far_depth = 1.0f;
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_.name());
  glViewport(0, 0, shadow_size_, shadow_size_);
  glClearNamedFramebufferfv(shadow_.name(), GL_DEPTH, 0, &far_depth);
}

void FrameTarget::begin_scene(const float* linear_background) {
  const float far_depth = 1.0f;
  const float colour[4] = {linear_background[0], linear_background[1], linear_background[2], 1.0f};
  glBindFramebuffer(GL_FRAMEBUFFER, scene_.name());
  glViewport(0, 0, width_, height_);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glClearNamedFramebufferfv(scene_.name(), GL_COLOR, 0, colour);
  glClearNamedFramebufferfv(scene_.name(), GL_DEPTH, 0, &far_depth);
}

void FrameTarget::resolve() {
  if (samples_ == 0) return;
  glBlitNamedFramebuffer(scene_.name(), resolved_.name(), 0, 0, width_, height_, 0, 0, width_, height_,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void FrameTarget::bind_picture() {
  glBindFramebuffer(GL_FRAMEBUFFER, resolved_.name());
  glViewport(0, 0, width_, height_);
  glDisable(GL_FRAMEBUFFER_SRGB);
}

void FrameTarget::present(int width, int height) {
  glDisable(GL_FRAMEBUFFER_SRGB);  // the bytes are already what the screen expects
  const GLenum filter = width == width_ && height == height_ ? GL_NEAREST : GL_LINEAR;
  glBlitNamedFramebuffer(resolved_.name(), 0, 0, 0, width_, height_, 0, 0, width, height, GL_COLOR_BUFFER_BIT, filter);
}

Image FrameTarget::read() {
  const std::size_t row = 3 * static_cast<std::size_t>(width_);
  std::vector<std::uint8_t> upward(row * static_cast<std::size_t>(height_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.name());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, upward.data());
  Image image;
  image.width = width_;
  image.height = height_;
  image.rgb.resize(upward.size());
  for (int y = 0; y < height_; ++y) {
    std::copy_n(upward.data() + static_cast<std::size_t>(height_ - 1 - y) * row, row, image.pixel(0, y));
  }
  return image;
}

}  // namespace fascicle
