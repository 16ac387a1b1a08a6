#include "engine/render/deforming_batch.hpp"

#include <cstddef>

namespace fascicle {

template <class Handle>
DeformingBatch<Handle>::DeformingBatch(GpuMemory& memory)
    : indices_(memory, sizeof(std::uint32_t)),
      vertices_(memory, kVertexBytes),
      instance_data_(memory),
      commands_(memory) {}

template <class Handle>
Handle DeformingBatch<Handle>::add(std::uint32_t vertex_count, std::span<const std::uint32_t> indices) {
  Instance instance;
  instance.vertex_count = vertex_count;
  instance.index_count = static_cast<std::uint32_t>(indices.size());
  instance.first_vertex = vertices_.allocate(vertex_count);
  instance.first_index = indices_.allocate(instance.index_count);
  indices_.upload(instance.first_index, std::as_bytes(indices));
  return instances_.add(instance);
}

template <class Handle>
void DeformingBatch<Handle>::remove(Handle handle) {
  const Instance instance = instances_.remove(handle);
  vertices_.release(instance.first_vertex, instance.vertex_count);
  indices_.release(instance.first_index, instance.index_count);
  changed_ = true;
}

template <class Handle>
std::span<std::byte> DeformingBatch<Handle>::write(Handle handle, const StepClock& clock) {
  Instance& instance = instances_.get(handle);
  instance.state.write(clock.step());
  if (instance.vertex_count == 0) return {};
  return {vertices_.write(clock.current(), instance.first_vertex),
          static_cast<std::size_t>(instance.vertex_count) * kVertexBytes};
}

template <class Handle>
void DeformingBatch<Handle>::set_highlighted(Handle handle, bool highlighted) {
  Instance& instance = instances_.get(handle);
  changed_ |= instance.highlighted != highlighted;
  instance.highlighted = highlighted;
}

template <class Handle>
bool DeformingBatch<Handle>::finish_step(const StepClock& clock) {
  bool copied = false;
  instances_.each([&](Instance& instance) {
    if (!instance.state.carry(clock.step())) return;
    vertices_.copy(instance.first_vertex, instance.vertex_count, clock.previous(), clock.current());
    copied = true;
  });
  return copied;
}

template <class Handle>
void DeformingBatch<Handle>::prepare(const StepClock& clock) {
  instances_.each([&](Instance& instance) {
    if (instance.state.update(clock.step())) changed_ = true;
  });
  if (!changed_) return;
  changed_ = false;
  instance_scratch_.clear();
  command_scratch_.clear();
  drawn_vertices_ = 0;
  instances_.each([&](Instance& instance) {
    if (!instance.state.drawn() || instance.index_count == 0) return;
    command_scratch_.push_back({instance.index_count, 1, instance.first_index,
                                static_cast<GLint>(instance.first_vertex),
                                static_cast<GLuint>(instance_scratch_.size())});
    instance_scratch_.push_back((instance.state.interpolated(clock.step()) ? kInstanceInterpolated : 0u) |
                                (instance.highlighted ? kInstanceHighlighted : 0u));
    drawn_vertices_ += instance.vertex_count;
  });
  instance_data_.upload(std::as_bytes(std::span(instance_scratch_)));
  commands_.upload(std::as_bytes(std::span(command_scratch_)));
}

template <class Handle>
std::uint32_t DeformingBatch<Handle>::draw(GLuint vertex_array, GLenum mode, const StepClock& clock) {
  if (command_scratch_.empty()) return 0;
  vertices_.bind_vertices(vertex_array, kPreviousStep, clock.previous());
  vertices_.bind_vertices(vertex_array, kCurrentStep, clock.current());
  glVertexArrayVertexBuffer(vertex_array, kInstanceFlags, instance_data_.name(), 0, sizeof(std::uint32_t));
  glVertexArrayElementBuffer(vertex_array, indices_.name());
  glBindVertexArray(vertex_array);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.name());
  glMultiDrawElementsIndirect(mode, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(command_scratch_.size()), 0);
  return 1;
}

template class DeformingBatch<SkinHandle>;
template class DeformingBatch<SurfaceHandle>;
template class DeformingBatch<LineHandle>;
template class DeformingBatch<FibreHandle>;

GlVertexArray make_skin_vertex_array() {
  GlVertexArray array = make_vertex_array();
  const GLuint name = array.name();
  for (const GLuint step : {kPreviousStep, kCurrentStep}) {
    const GLuint position = 2 * step, normal = 2 * step + 1;
    glVertexArrayAttribFormat(name, position, 3, GL_FLOAT, GL_FALSE, offsetof(DrawVertex, position));
    glVertexArrayAttribFormat(name, normal, 4, GL_INT_2_10_10_10_REV, GL_TRUE, offsetof(DrawVertex, normal));
    for (const GLuint attribute : {position, normal}) {
      glVertexArrayAttribBinding(name, attribute, step);
      glEnableVertexArrayAttrib(name, attribute);
    }
  }
  glVertexArrayAttribIFormat(name, 4, 1, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(name, 4, kInstanceFlags);
  glEnableVertexArrayAttrib(name, 4);
  glVertexArrayBindingDivisor(name, kInstanceFlags, 1);
  return array;
}

}  // namespace fascicle
