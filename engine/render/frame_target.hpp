// The framebuffers that a frame is drawn into: multisampled colour and depth, the resolved picture, and the ground's
// shadow map. Colour is sRGB; blending and resolving happen in linear light.
#pragma once

#include <memory>

#include "engine/content/result.hpp"
#include "engine/render/gl_objects.hpp"
#include "engine/render/screenshot.hpp"

namespace fascicle {

class FrameTarget {
 public:
  // `samples` is lowered to what the driver offers. Errors: a framebuffer that the driver doesn't accept.
  static Result<FrameTarget> create(int width, int height, int samples, int shadow_size);

  void begin_shadow();                // binds and clears the shadow map
  void begin_scene(const float* linear_background);  // binds and clears colour and depth
  void resolve();                     // to the single-sample picture
  void bind_picture();                // for drawing over it without sRGB conversion
  void present(int width, int height);
  Image read();

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }
  GLuint shadow_map() const { return shadow_map_.name(); }

 private:
  int width_ = 0, height_ = 0, samples_ = 0, shadow_size_ = 0;
  GlTexture picture_;
  GlTexture shadow_map_;
  GlRenderbuffer samples_colour_, depth_;
  GlFramebuffer scene_, resolved_, shadow_;  // scene_ is resolved_'s picture itself where samples_ is 0
};

}  // namespace fascicle
