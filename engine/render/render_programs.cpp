#include "engine/render/render_programs.hpp"

namespace fascicle {

Result<RenderPrograms> RenderPrograms::create() {
  RenderPrograms programs;
  Diagnostics problems;
  const auto build = [&problems](GlProgram& program, std::string_view vertex, std::string_view fragment,
                                 std::initializer_list<std::string_view> defines) {
    Result<GlProgram> built = build_program(vertex, fragment, defines);
    if (built.ok()) {
      program = std::move(*built);
    } else {
      problems.append(std::move(built.diagnostics()));
    }
  };
  build(programs.strip, "strip.vert", "strip.frag", {});
  build(programs.strip_ring, "strip.vert", "strip.frag", {"RING"});
  build(programs.strip_shadow, "strip.vert", "depth.frag", {"DEPTH_ONLY"});
  build(programs.rigid, "rigid.vert", "rigid.frag", {});
  build(programs.rigid_shadow, "rigid.vert", "depth.frag", {"DEPTH_ONLY"});
  build(programs.skin, "skin.vert", "skin.frag", {});
  build(programs.skin_depth, "skin.vert", "depth.frag", {});
  build(programs.skin_shadow, "skin.vert", "depth.frag", {"DEPTH_ONLY"});
  build(programs.surface, "skin.vert", "surface.frag", {});
  build(programs.line, "line.vert", "line.frag", {});
  build(programs.line_through, "line.vert", "line.frag", {"THROUGH"});
  build(programs.point, "line.vert", "line.frag", {"POINT"});
  build(programs.point_through, "line.vert", "line.frag", {"POINT", "THROUGH"});
  build(programs.ground, "ground.vert", "ground.frag", {});
  if (!problems.ok()) return problems;
  return programs;
}

}  // namespace fascicle
