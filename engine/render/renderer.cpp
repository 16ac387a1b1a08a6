#include "engine/render/renderer.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "engine/render/deforming_batch.hpp"
#include "engine/render/frame_target.hpp"
#include "engine/render/frame_uniforms.hpp"
#include "engine/render/line_batch.hpp"
#include "engine/render/pool_buffer.hpp"
#include "engine/render/render_programs.hpp"
#include "engine/render/rigid_batch.hpp"
#include "engine/render/strip_batch.hpp"

namespace fascicle {

struct Renderer::State {
  State(const RendererOptions& wanted, FrameTarget made_target, RenderPrograms made_programs)
      : options(wanted), target(std::move(made_target)), programs(std::move(made_programs)) {
    glGetFloatv(GL_ALIASED_LINE_WIDTH_RANGE, line_widths);
  }

  void finish_step();
  void draw_shadow(const DrawView& view);
  void draw_opaque(const DrawView& view);
  void draw_ground(const DrawView& view);
  void draw_lines(const DrawView& view);
  template <class Handle>
  void draw_translucent(DeformingBatch<Handle>& batch, const GlProgram& program);
  void draw_translucent(const DrawView& view);
  bool shows_fibres(const DrawView& view) const { return view.fibres && lines.has_fibres(); }

  RendererOptions options;
  GpuMemory memory;
  FrameTarget target;
  RenderPrograms programs;
  StepClock clock;
  StreamBuffer uniforms{memory};
  StripBatch strips{memory};
  RigidBatch rigids{memory};
  DeformingBatch<SkinHandle> skins{memory};
  DeformingBatch<SurfaceHandle> surfaces{memory};
  LineBatch lines{memory};
  GlVertexArray skin_array = make_skin_vertex_array();
  GlVertexArray empty_array = make_vertex_array();
  GpuTimer timer;
  RenderStats stats;
  float line_widths[2] = {1.0f, 1.0f};  // pixels, what the driver offers
};

Result<std::unique_ptr<Renderer>> Renderer::create(const RendererOptions& options) {
  Result<FrameTarget> target = FrameTarget::create(options.width, options.height, options.samples,
                                                   options.shadow_size);
  Result<RenderPrograms> programs = RenderPrograms::create();
  if (!target.ok() || !programs.ok()) {
    Diagnostics problems = std::move(target.diagnostics());
    problems.append(std::move(programs.diagnostics()));
    return problems;
  }
  auto state = std::make_unique<State>(options, std::move(*target), std::move(*programs));
  return std::unique_ptr<Renderer>(new Renderer(std::move(state)));
}

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::~Renderer() = default;

// --- Structure

StripTopologyHandle Renderer::add_strip_topology(const StripTopology& topology) {
  return state_->strips.add_topology(topology);
}
StripHandle Renderer::add_strips(StripTopologyHandle topology) { return state_->strips.add(topology); }
MeshHandle Renderer::add_mesh(const TriangleMesh& mesh) { return state_->rigids.add_mesh(mesh); }
RigidHandle Renderer::add_rigid(std::span<const MeshHandle> meshes) { return state_->rigids.add(meshes); }
SkinHandle Renderer::add_skin(std::uint32_t vertex_count, std::span<const std::uint32_t> triangle_indices) {
  return state_->skins.add(vertex_count, triangle_indices);
}
SurfaceHandle Renderer::add_surface(std::uint32_t vertex_count, std::span<const std::uint32_t> triangle_indices) {
  return state_->surfaces.add(vertex_count, triangle_indices);
}
LineHandle Renderer::add_lines(std::uint32_t vertex_count, std::span<const std::uint32_t> line_strip_indices) {
  return state_->lines.sets().add(vertex_count, line_strip_indices);
}
FibreHandle Renderer::add_fibres(std::uint32_t vertex_count, std::span<const std::uint32_t> line_strip_indices) {
  return state_->lines.fibres().add(vertex_count, line_strip_indices);
}
// A removed thing's memory may be handed out again at once, so the GPU must be done with it.
void Renderer::remove(StripTopologyHandle topology) {
  glFinish();
  state_->strips.remove_topology(topology);
}
void Renderer::remove(StripHandle strips) {
  glFinish();
  state_->strips.remove(strips);
}
void Renderer::remove(MeshHandle mesh) {
  glFinish();
  state_->rigids.remove_mesh(mesh);
}
void Renderer::remove(RigidHandle group) {
  glFinish();
  state_->rigids.remove(group);
}
void Renderer::remove(SkinHandle skin) {
  glFinish();
  state_->skins.remove(skin);
}
void Renderer::remove(SurfaceHandle surface) {
  glFinish();
  state_->surfaces.remove(surface);
}
void Renderer::remove(LineHandle lines) {
  glFinish();
  state_->lines.sets().remove(lines);
}
void Renderer::remove(FibreHandle fibres) {
  glFinish();
  state_->lines.fibres().remove(fibres);
}

// --- Contents

void Renderer::begin_step() {
  state_->finish_step();
  if (state_->clock.advance()) state_->stats.step_waits += 1;
}

void Renderer::State::finish_step() {
  if (clock.step() == 0) return;
  bool copied = strips.finish_step(clock);
  copied |= rigids.finish_step(clock);
  copied |= skins.finish_step(clock);
  copied |= surfaces.finish_step(clock);
  copied |= lines.sets().finish_step(clock);
  copied |= lines.fibres().finish_step(clock);
  if (copied) clock.guard();
}

std::span<DrawVertex> Renderer::strip_vertices(StripHandle strips) {
  assert(state_->clock.step() > 0 && "call begin_step first");
  return state_->strips.write_vertices(strips, state_->clock);
}
std::span<StripRow> Renderer::strip_rows(StripHandle strips) {
  assert(state_->clock.step() > 0 && "call begin_step first");
  return state_->strips.write_rows(strips, state_->clock);
}
std::span<glm::mat4> Renderer::rigid_matrices(RigidHandle group) {
  assert(state_->clock.step() > 0 && "call begin_step first");
  return state_->rigids.write_matrices(group, state_->clock);
}
std::span<DrawVertex> Renderer::skin_vertices(SkinHandle skin) {
  assert(state_->clock.step() > 0 && "call begin_step first");
  const std::span<std::byte> bytes = state_->skins.write(skin, state_->clock);
  return {reinterpret_cast<DrawVertex*>(bytes.data()), bytes.size() / sizeof(DrawVertex)};
}
std::span<DrawVertex> Renderer::surface_vertices(SurfaceHandle surface) {
  assert(state_->clock.step() > 0 && "call begin_step first");
  const std::span<std::byte> bytes = state_->surfaces.write(surface, state_->clock);
  return {reinterpret_cast<DrawVertex*>(bytes.data()), bytes.size() / sizeof(DrawVertex)};
}
std::span<LineVertex> Renderer::line_vertices(LineHandle lines) {
  assert(state_->clock.step() > 0 && "call begin_step first");
  const std::span<std::byte> bytes = state_->lines.sets().write(lines, state_->clock);
  return {reinterpret_cast<LineVertex*>(bytes.data()), bytes.size() / sizeof(LineVertex)};
}
std::span<LineVertex> Renderer::fibre_vertices(FibreHandle fibres) {
  assert(state_->clock.step() > 0 && "call begin_step first");
  const std::span<std::byte> bytes = state_->lines.fibres().write(fibres, state_->clock);
  return {reinterpret_cast<LineVertex*>(bytes.data()), bytes.size() / sizeof(LineVertex)};
}

void Renderer::mark_teleported(StripHandle strips) {
  state_->strips.state(strips).teleported = state_->clock.step();
}
void Renderer::mark_teleported(RigidHandle group) { state_->rigids.state(group).teleported = state_->clock.step(); }
void Renderer::mark_teleported(SkinHandle skin) { state_->skins.state(skin).teleported = state_->clock.step(); }
void Renderer::mark_teleported(SurfaceHandle surface) {
  state_->surfaces.state(surface).teleported = state_->clock.step();
}
void Renderer::mark_teleported(LineHandle lines) {
  state_->lines.sets().state(lines).teleported = state_->clock.step();
}
void Renderer::mark_teleported(FibreHandle fibres) {
  state_->lines.fibres().state(fibres).teleported = state_->clock.step();
}

void Renderer::forget(StripHandle strips) { state_->strips.state(strips).first_written = 0; }
void Renderer::forget(LineHandle lines) { state_->lines.sets().state(lines).first_written = 0; }

std::span<StripItem> Renderer::strip_items(StripHandle strips) { return state_->strips.items(strips); }
void Renderer::set_visible(StripHandle strips, bool visible) { state_->strips.state(strips).visible = visible; }
void Renderer::set_visible(RigidHandle group, bool visible) { state_->rigids.state(group).visible = visible; }
void Renderer::set_visible(SkinHandle skin, bool visible) { state_->skins.state(skin).visible = visible; }
void Renderer::set_visible(SurfaceHandle surface, bool visible) { state_->surfaces.state(surface).visible = visible; }
void Renderer::set_visible(LineHandle lines, bool visible) { state_->lines.sets().state(lines).visible = visible; }
void Renderer::set_visible(FibreHandle fibres, bool visible) {
  state_->lines.fibres().state(fibres).visible = visible;
}
void Renderer::set_highlighted(SurfaceHandle surface, bool highlighted) {
  state_->surfaces.set_highlighted(surface, highlighted);
}
void Renderer::add_line(const glm::vec3& from, const glm::vec3& to, std::uint32_t colour) {
  state_->lines.add_line(from, to, colour);
}
void Renderer::add_point(const glm::vec3& at, std::uint32_t colour, float size) {
  state_->lines.add_point(at, colour, size);
}

// --- Frame

void Renderer::resize(int width, int height) {
  if (width <= 0 || height <= 0 || (width == state_->target.width() && height == state_->target.height())) return;
  Result<FrameTarget> target =
      FrameTarget::create(width, height, state_->options.samples, state_->options.shadow_size);
  if (target.ok()) state_->target = std::move(*target);  // else the old size goes on
}

void Renderer::State::draw_shadow(const DrawView& view) {
  target.begin_shadow();
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 4.0f);
  if (view.strips) {
    glUseProgram(programs.strip_shadow.name());
    stats.draw_calls += strips.draw_surfaces(clock);
  }
  if (view.meshes) {
    glUseProgram(programs.rigid_shadow.name());
    stats.draw_calls += rigids.draw(clock);
  }
  const bool with_skins = view.skins && view.skin_opacity > 0.0f;
  if (with_skins || view.strips) {
    glUseProgram(programs.skin_shadow.name());
    if (view.strips) stats.draw_calls += surfaces.draw(skin_array.name(), GL_TRIANGLES, clock);
    if (with_skins) stats.draw_calls += skins.draw(skin_array.name(), GL_TRIANGLES, clock);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void Renderer::State::draw_opaque(const DrawView& view) {
  if (view.strips) {
    timer.begin_pass("strips");
    glUseProgram(programs.strip.name());
    stats.strip_draw_calls = strips.draw_surfaces(clock);
    stats.draw_calls += stats.strip_draw_calls;
    stats.strip_vertices = strips.drawn_vertices();
    timer.end_pass();
  }
  if (view.strips) stats.surface_vertices = surfaces.drawn_vertices();
  if (view.strips && !surfaces.empty() && !shows_fibres(view)) {
    timer.begin_pass("surfaces");
    glUseProgram(programs.surface.name());
    stats.draw_calls += surfaces.draw(skin_array.name(), GL_TRIANGLES, clock);
    timer.end_pass();
  }
  if (view.meshes) {
    timer.begin_pass("meshes");
    glUseProgram(programs.rigid.name());
    stats.draw_calls += rigids.draw(clock);
    timer.end_pass();
  }
}

void Renderer::State::draw_ground(const DrawView& view) {
  if (!view.ground || view.camera.eye().y <= 0.0f) return;  // from below it would hide everything
  timer.begin_pass("ground");
  glUseProgram(programs.ground.name());
  glBindTextureUnit(0, target.shadow_map());
  glBindVertexArray(empty_array.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  stats.draw_calls += 1;
  timer.end_pass();
}

void Renderer::State::draw_lines(const DrawView& view) {
  const bool rings = view.rings && view.strips;
  const bool sets = view.lines && lines.has_sets();
  const bool fibres = shows_fibres(view);
  const bool marks = view.marks && (lines.has_lines() || lines.has_points());
  if (!rings && !sets && !fibres && !marks) return;
  timer.begin_pass("lines");
  const auto set_width = [this](float pixels) {
    glLineWidth(std::clamp(pixels, line_widths[0], std::max(line_widths[0], line_widths[1])));
  };
  if (rings) {
    set_width(1.0f);
    glUseProgram(programs.strip_ring.name());
    stats.draw_calls += strips.draw_rings(clock);
  }
  if (fibres) {
    set_width(view.line_width);
    glUseProgram(programs.line.name());
    stats.draw_calls += lines.draw_fibres(clock);
  }
  if (sets || marks) {
    set_width(view.line_width);
    glEnable(GL_BLEND);
    const auto draw_both = [&](const GlProgram& line, const GlProgram& point) {
      glUseProgram(line.name());
      if (sets) stats.draw_calls += lines.draw_sets(clock);
      if (marks) stats.draw_calls += lines.draw_lines();
      if (!marks || !lines.has_points()) return;
      glUseProgram(point.name());
      stats.draw_calls += lines.draw_points();
    };
    draw_both(programs.line, programs.point);
    if (view.lines_through > 0.0f) {
      // What something hides, faintly: only where the depth test fails.
      glDepthFunc(GL_GREATER);
      glDepthMask(GL_FALSE);
      draw_both(programs.line_through, programs.point_through);
      glDepthMask(GL_TRUE);
      glDepthFunc(GL_LEQUAL);
    }
    glDisable(GL_BLEND);
  }
  set_width(1.0f);
  timer.end_pass();
}

template <class Handle>
void Renderer::State::draw_translucent(DeformingBatch<Handle>& batch, const GlProgram& program) {
  // First the depth of the outermost layer, then the colour of just that layer: a thing never shows through itself.
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glUseProgram(programs.skin_depth.name());
  stats.draw_calls += batch.draw(skin_array.name(), GL_TRIANGLES, clock);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  glUseProgram(program.name());
  stats.draw_calls += batch.draw(skin_array.name(), GL_TRIANGLES, clock);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

// After the lines, which they let through.
void Renderer::State::draw_translucent(const DrawView& view) {
  if (view.strips && !surfaces.empty() && shows_fibres(view)) {
    timer.begin_pass("surfaces");
    draw_translucent(surfaces, programs.surface);
    timer.end_pass();
  }
  if (view.skins && view.skin_opacity > 0.0f && !skins.empty()) {
    timer.begin_pass("skins");
    draw_translucent(skins, programs.skin);
    timer.end_pass();
  }
}

void Renderer::draw(const DrawView& view) {
  State& state = *state_;
  state.finish_step();
  state.stats.draw_calls = 0;
  state.stats.strip_draw_calls = 0;
  state.stats.strip_vertices = 0;
  state.stats.surface_vertices = 0;
  state.strips.prepare(state.clock);
  state.rigids.prepare(state.clock);
  state.skins.prepare(state.clock);
  state.surfaces.prepare(state.clock);
  state.lines.prepare(state.clock);

  const bool shadow = view.shadow && view.ground && state.options.shadow_size > 0;
  const float aspect = static_cast<float>(state.target.width()) / static_cast<float>(state.target.height());
  FrameUniforms frame = make_frame_uniforms(view, aspect, shadow ? state.options.shadow_size : 0);
  if (state.shows_fibres(view)) frame.mesh_colour.w = std::clamp(view.opacity_over_fibres, 0.0f, 1.0f);
  state.uniforms.upload(std::as_bytes(std::span(&frame, 1)));
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, state.uniforms.name());

  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);  // radii may be negative: a surface shows both its sides
  glDisable(GL_SCISSOR_TEST);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
  glEnable(GL_PROGRAM_POINT_SIZE);

  if (state.options.time_passes) state.timer.begin_frame();
  if (shadow) {
    state.timer.begin_pass("shadow");
    state.draw_shadow(view);
    state.timer.end_pass();
  }
  state.target.begin_scene(&view.background[0]);
  state.draw_opaque(view);
  state.draw_ground(view);
  state.draw_lines(view);
  state.draw_translucent(view);
  state.timer.begin_pass("resolve");
  state.target.resolve();
  state.timer.end_pass();

  if (state.clock.step() > 0) state.clock.guard();
  state.lines.clear_immediate();
  glBindVertexArray(0);
  glUseProgram(0);
  state.stats.buffer_allocations = state.memory.allocations;
  state.stats.buffer_bytes = state.memory.bytes;
}

void Renderer::bind_target() { state_->target.bind_picture(); }
void Renderer::present(int width, int height) { state_->target.present(width, height); }
Image Renderer::read_image() { return state_->target.read(); }
int Renderer::width() const { return state_->target.width(); }
int Renderer::height() const { return state_->target.height(); }
const RenderStats& Renderer::stats() const { return state_->stats; }
GpuTimer& Renderer::timer() { return state_->timer; }
std::span<const GpuTime> Renderer::gpu_times() const { return state_->timer.times(); }

}  // namespace fascicle
