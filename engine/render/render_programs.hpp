// The renderer's shader programs.
#pragma once

#include "engine/render/shader_program.hpp"

namespace fascicle {

struct RenderPrograms {
  GlProgram strip, strip_ring, strip_shadow;
  GlProgram rigid, rigid_shadow;
  GlProgram skin, skin_depth, skin_shadow;
  GlProgram surface;  // its depth and shadow are drawn as the skins'
  GlProgram line, line_through, point, point_through;
  GlProgram ground;

  // All errors of all programs in one go.
  static Result<RenderPrograms> create();
};

}  // namespace fascicle
