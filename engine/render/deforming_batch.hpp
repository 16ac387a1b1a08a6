// Things whose vertices (16 bytes each) change every step over constant indices, all in one multi-draw: skins and
// surfaces as triangles, action lines and fibres as line strips. The caller owns the vertex array, whose bindings are:
// 0 the previous step's vertices, 1 the last step's, 2 one uint an instance with its InstanceFlags (divisor 1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/render/draw_types.hpp"
#include "engine/render/handle_pool.hpp"
#include "engine/render/pool_buffer.hpp"
#include "engine/render/step_state.hpp"

namespace fascicle {

inline constexpr GLuint kPreviousStep = 0, kCurrentStep = 1, kInstanceFlags = 2;

enum InstanceFlags : std::uint32_t { kInstanceInterpolated = 1u << 0, kInstanceHighlighted = 1u << 1 };

template <class Handle>
class DeformingBatch {
 public:
  static constexpr std::uint32_t kVertexBytes = 16;
  explicit DeformingBatch(GpuMemory& memory);

  Handle add(std::uint32_t vertex_count, std::span<const std::uint32_t> indices);
  void remove(Handle handle);
  // The current step's vertices of `handle`, vertex_count of them.
  std::span<std::byte> write(Handle handle, const StepClock& clock);
  StepState& state(Handle handle) { return instances_.get(handle).state; }
  void set_highlighted(Handle handle, bool highlighted);

  bool finish_step(const StepClock& clock);
  void prepare(const StepClock& clock);
  // Returns the draw calls issued.
  std::uint32_t draw(GLuint vertex_array, GLenum mode, const StepClock& clock);
  // What the next draw shows.
  bool empty() const { return command_scratch_.empty(); }
  std::uint64_t drawn_vertices() const { return drawn_vertices_; }

 private:
  struct Instance {
    std::uint32_t first_vertex = 0, vertex_count = 0, first_index = 0, index_count = 0;
    StepState state;
    bool highlighted = false;
  };
  HandlePool<Instance, Handle> instances_;
  PoolBuffer indices_;
  StepBuffer vertices_;
  StreamBuffer instance_data_, commands_;
  std::vector<std::uint32_t> instance_scratch_;
  std::vector<DrawCommand> command_scratch_;
  std::uint64_t drawn_vertices_ = 0;
  bool changed_ = true;
};

extern template class DeformingBatch<SkinHandle>;
extern template class DeformingBatch<SurfaceHandle>;
extern template class DeformingBatch<LineHandle>;
extern template class DeformingBatch<FibreHandle>;

// Vertex array for DrawVertex: locations 0, 1 previous position and normal; 2, 3 current; 4 the flags.
GlVertexArray make_skin_vertex_array();

}  // namespace fascicle
