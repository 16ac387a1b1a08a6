// Draws the world's surfaces: fibred strip surfaces, deforming surfaces with the fibres inside them, rigid meshes,
// translucent skins, lines and a ground, with OpenGL 4.5 core, in a window or headless. It draws into a framebuffer of
// its own, which `present` copies to the window and `read_image` to memory, so that both ways give the same picture.
//
// How data gets here. Structure (what exists) changes seldom: add_*, remove, on the GL thread. Contents change once a
// simulation step: `begin_step` on the GL thread, then any thread writes each thing's current state into the spans
// that *_vertices, *_rows and *_matrices return; these are GPU-visible memory, so write each element once, in order,
// and never read. The renderer keeps the last two steps of everything and interpolates between them on the GPU by
// DrawView::alpha. A thing that was not written in a step keeps its last state. A thing is first drawn once it has
// been written. Nothing is allocated in a steady frame.
//
// All instances of one kind go out in one multi-draw call: strips, fans, rings, surfaces, meshes, skins, lines, fibres.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "engine/render/camera.hpp"
#include "engine/render/draw_types.hpp"
#include "engine/render/gpu_timer.hpp"
#include "engine/render/screenshot.hpp"
#include "engine/render/strip_topology.hpp"

namespace fascicle {

struct RendererOptions {
  int width = 1280;    // pixels
  int height = 720;
  int samples = 4;     // multisampling; lowered to what the driver has, 0 or 1: none
  int shadow_size = 1024;  // pixels a side of the ground's shadow map
  bool time_passes = true;  // GPU timer queries
};

// What to draw and how, for one frame. Colours are linear.
struct DrawView {
  OrbitCamera camera;
  float alpha = 1.0f;          // 0: the step before the last; 1: the last step
  bool strips = true;          // and surfaces
  bool tendons = true;         // false: all of a strip surface, or surface, is belly
  bool rings = false;          // outlines of the strip surfaces' rows
  bool fibres = false;         // inside surfaces, which are translucent then
  float opacity_over_fibres = 0.3f;
  bool meshes = true;
  bool skins = true;
  float skin_opacity = 0.3f;  // 1: opaque; 0: not drawn
  bool lines = true;           // the line sets that follow the steps
  bool marks = true;           // immediate lines and points
  float lines_through = 0.35f;  // opacity of lines where something is in front of them
  float line_width = 1.5f;     // pixels
  float point_scale = 1.0f;    // of immediate points' sizes
  bool ground = true;
  bool shadow = true;
  bool back_faces = false;     // paints faces that are clockwise on screen magenta: shows inverted surfaces
  glm::vec3 background{0.085f, 0.095f, 0.11f};
  glm::vec3 mesh_colour{0.80f, 0.74f, 0.62f};
  glm::vec3 skin_colour{0.68f, 0.42f, 0.32f};
};

struct RenderStats {
  std::uint32_t draw_calls = 0;         // in the last draw, all passes
  std::uint32_t strip_draw_calls = 0;   // those for strip surfaces in the main pass: at most 2
  std::uint64_t strip_vertices = 0;     // drawn, all instances
  std::uint64_t surface_vertices = 0;   // likewise
  std::uint64_t buffer_allocations = 0;  // GPU buffers made since the start; constant in steady frames
  std::uint64_t buffer_bytes = 0;       // GPU buffer memory held
  std::uint64_t step_waits = 0;         // begin_step calls that had to wait for the GPU
};

class Renderer {
 public:
  // Needs a current OpenGL 4.5 core context. Errors: shader compilation (file:line), framebuffer not complete.
  static Result<std::unique_ptr<Renderer>> create(const RendererOptions& options = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // --- Structure: GL thread, outside of steps' writing.
  StripTopologyHandle add_strip_topology(const StripTopology& topology);
  StripHandle add_strips(StripTopologyHandle topology);
  MeshHandle add_mesh(const TriangleMesh& mesh);
  RigidHandle add_rigid(std::span<const MeshHandle> meshes);  // one matrix a mesh, in this order
  SkinHandle add_skin(std::uint32_t vertex_count, std::span<const std::uint32_t> triangle_indices);
  SurfaceHandle add_surface(std::uint32_t vertex_count, std::span<const std::uint32_t> triangle_indices);
  LineHandle add_lines(std::uint32_t vertex_count, std::span<const std::uint32_t> line_strip_indices);
  FibreHandle add_fibres(std::uint32_t vertex_count, std::span<const std::uint32_t> line_strip_indices);
  void remove(StripTopologyHandle topology);  // after the strips that use it
  void remove(StripHandle strips);
  void remove(MeshHandle mesh);  // after the rigid groups that use it
  void remove(RigidHandle group);
  void remove(SkinHandle skin);
  void remove(SurfaceHandle surface);
  void remove(LineHandle lines);
  void remove(FibreHandle fibres);

  // --- Contents: once a simulation step.
  void begin_step();  // GL thread
  // Any thread, each handle by one thread at a time. The spans are valid until the next begin_step, add or remove.
  std::span<DrawVertex> strip_vertices(StripHandle strips);
  std::span<StripRow> strip_rows(StripHandle strips);
  std::span<glm::mat4> rigid_matrices(RigidHandle group);  // mesh to world
  std::span<DrawVertex> skin_vertices(SkinHandle skin);
  std::span<DrawVertex> surface_vertices(SurfaceHandle surface);
  std::span<LineVertex> line_vertices(LineHandle lines);
  std::span<LineVertex> fibre_vertices(FibreHandle fibres);
  // The step just written is a jump: drawn as it is, not interpolated. For one step.
  void mark_teleported(StripHandle strips);
  void mark_teleported(RigidHandle group);
  void mark_teleported(SkinHandle skin);
  void mark_teleported(SurfaceHandle surface);
  void mark_teleported(LineHandle lines);
  void mark_teleported(FibreHandle fibres);
  // Not drawn until it is written again, which is then no step that is interpolated from. For things that take turns.
  void forget(StripHandle strips);
  void forget(LineHandle lines);

  // --- At any time, GL thread.
  std::span<StripItem> strip_items(StripHandle strips);  // readable and writable; uploaded before the next draw
  void set_visible(StripHandle strips, bool visible);
  void set_visible(RigidHandle group, bool visible);
  void set_visible(SkinHandle skin, bool visible);
  void set_visible(SurfaceHandle surface, bool visible);
  void set_visible(LineHandle lines, bool visible);
  void set_visible(FibreHandle fibres, bool visible);
  void set_highlighted(SurfaceHandle surface, bool highlighted);
  // Immediate lines and points in world space (m), for this draw only, not interpolated. Points: pixels across.
  void add_line(const glm::vec3& from, const glm::vec3& to, std::uint32_t colour);
  void add_point(const glm::vec3& at, std::uint32_t colour, float size = 6.0f);

  // --- Frame: GL thread.
  void resize(int width, int height);  // no-op for the same size; 0 keeps the old
  void draw(const DrawView& view);
  // Binds the finished picture for drawing over it (the overlay): 8-bit colour, no depth, no sRGB conversion.
  void bind_target();
  void present(int width, int height);  // copies to framebuffer 0 of this size
  Image read_image();                   // waits for the GPU
  int width() const;
  int height() const;

  const RenderStats& stats() const;
  GpuTimer& timer();  // the overlay times its own pass with it
  std::span<const GpuTime> gpu_times() const;

 private:
  struct State;
  explicit Renderer(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace fascicle
