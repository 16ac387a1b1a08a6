#include "engine/render/strip_batch.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include <glm/packing.hpp>

namespace fascicle {
namespace {

// A vertex's info as the shader reads it.
struct PackedInfo {
  std::uint32_t row = 0;
  std::uint32_t circle = 0;  // cosine and sine of its angle, snorm 2 x 16
  float along = 0.0f;
};
static_assert(sizeof(PackedInfo) == 12);

PackedInfo pack_info(const StripVertexInfo& info) {
  if (info.turn < 0.0f) return {info.row, 0u, info.along};
  const float angle = 6.28318531f * info.turn;
  return {info.row, glm::packSnorm2x16(glm::vec2(std::cos(angle), std::sin(angle))), info.along};
}

constexpr GLuint kPreviousVertices = 0, kCurrentVertices = 1, kInstances = 2;  // vertex buffer bindings

GlVertexArray make_strip_vertex_array() {
  GlVertexArray array = make_vertex_array();
  const GLuint name = array.name();
  const auto vertex_attribute = [name](GLuint position, GLuint normal, GLuint binding) {
    glVertexArrayAttribFormat(name, position, 3, GL_FLOAT, GL_FALSE, offsetof(DrawVertex, position));
    glVertexArrayAttribBinding(name, position, binding);
    glEnableVertexArrayAttrib(name, position);
    glVertexArrayAttribFormat(name, normal, 4, GL_INT_2_10_10_10_REV, GL_TRUE, offsetof(DrawVertex, normal));
    glVertexArrayAttribBinding(name, normal, binding);
    glEnableVertexArrayAttrib(name, normal);
  };
  vertex_attribute(0, 1, kPreviousVertices);
  vertex_attribute(2, 3, kCurrentVertices);
  glVertexArrayAttribIFormat(name, 4, 4, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(name, 4, kInstances);
  glEnableVertexArrayAttrib(name, 4);
  glVertexArrayAttribIFormat(name, 5, 1, GL_UNSIGNED_INT, 16);
  glVertexArrayAttribBinding(name, 5, kInstances);
  glEnableVertexArrayAttrib(name, 5);
  glVertexArrayBindingDivisor(name, kInstances, 1);
  return array;
}

}  // namespace

StripBatch::StripBatch(GpuMemory& memory)
    : infos_(memory, sizeof(PackedInfo)),
      indices_(memory, sizeof(std::uint32_t)),
      items_(memory, sizeof(StripItem)),
      vertices_(memory, sizeof(DrawVertex)),
      rows_(memory, sizeof(StripRow)),
      instance_data_(memory),
      commands_(memory),
      vertex_array_(make_strip_vertex_array()) {}

StripBatch::Range StripBatch::add_indices(std::span<const std::uint32_t> indices) {
  const auto count = static_cast<std::uint32_t>(indices.size());
  const Range range{indices_.allocate(count), count};
  indices_.upload(range.first, std::as_bytes(indices));
  return range;
}

StripTopologyHandle StripBatch::add_topology(const StripTopology& topology) {
  assert(!topology.vertices.empty() && topology.row_count > 0 && topology.item_count > 0);
  Topology added;
  added.vertex_count = static_cast<std::uint32_t>(topology.vertices.size());
  added.row_count = topology.row_count;
  added.item_count = topology.item_count;
  std::vector<PackedInfo> packed(topology.vertices.size());
  std::transform(topology.vertices.begin(), topology.vertices.end(), packed.begin(), pack_info);
  added.infos = {infos_.allocate(added.vertex_count), added.vertex_count};
  infos_.upload(added.infos.first, std::as_bytes(std::span(packed)));
  added.strips = add_indices(topology.strip_indices);
  added.fans = add_indices(topology.fan_indices);
  added.rings = add_indices(topology.ring_indices);
  return topologies_.add(added);
}

void StripBatch::remove_topology(StripTopologyHandle handle) {
  assert(topologies_.get(handle).uses == 0 && "remove its strips first");
  const Topology topology = topologies_.remove(handle);
  infos_.release(topology.infos.first, topology.infos.count);
  for (const Range& range : {topology.strips, topology.fans, topology.rings}) {
    indices_.release(range.first, range.count);
  }
}

StripHandle StripBatch::add(StripTopologyHandle handle) {
  Topology& topology = topologies_.get(handle);
  topology.uses += 1;
  Instance instance;
  instance.topology = handle;
  instance.vertices = {vertices_.allocate(topology.vertex_count), topology.vertex_count};
  instance.rows = {rows_.allocate(topology.row_count), topology.row_count};
  instance.items = {items_.allocate(topology.item_count), topology.item_count};
  const std::size_t items_end = instance.items.first + instance.items.count;
  if (item_mirror_.size() < items_end) item_mirror_.resize(items_end);
  std::fill_n(item_mirror_.begin() + instance.items.first, instance.items.count, StripItem{});
  instance.items_changed = true;
  return instances_.add(instance);
}

void StripBatch::remove(StripHandle handle) {
  const Instance instance = instances_.remove(handle);
  topologies_.get(instance.topology).uses -= 1;
  vertices_.release(instance.vertices.first, instance.vertices.count);
  rows_.release(instance.rows.first, instance.rows.count);
  items_.release(instance.items.first, instance.items.count);
  changed_ = true;
}

std::span<DrawVertex> StripBatch::write_vertices(StripHandle strips, const StepClock& clock) {
  Instance& instance = instances_.get(strips);
  instance.state.write(clock.step());
  return {reinterpret_cast<DrawVertex*>(vertices_.write(clock.current(), instance.vertices.first)),
          instance.vertices.count};
}

std::span<StripRow> StripBatch::write_rows(StripHandle strips, const StepClock& clock) {
  Instance& instance = instances_.get(strips);
  return {reinterpret_cast<StripRow*>(rows_.write(clock.current(), instance.rows.first)), instance.rows.count};
}

std::span<StripItem> StripBatch::items(StripHandle strips) {
  Instance& instance = instances_.get(strips);
  instance.items_changed = true;
  return std::span(item_mirror_).subspan(instance.items.first, instance.items.count);
}

bool StripBatch::finish_step(const StepClock& clock) {
  bool copied = false;
  instances_.each([&](Instance& instance) {
    if (!instance.state.carry(clock.step())) return;
    vertices_.copy(instance.vertices.first, instance.vertices.count, clock.previous(), clock.current());
    rows_.copy(instance.rows.first, instance.rows.count, clock.previous(), clock.current());
    copied = true;
  });
  return copied;
}

void StripBatch::prepare(const StepClock& clock) {
  instances_.each([&](Instance& instance) {
    if (instance.state.update(clock.step())) changed_ = true;
    if (!instance.items_changed) return;
    instance.items_changed = false;
    items_.upload(instance.items.first,
                  std::as_bytes(std::span(item_mirror_).subspan(instance.items.first, instance.items.count)));
  });
  if (!changed_) return;
  changed_ = false;

  instance_scratch_.clear();
  command_scratch_.clear();
  drawn_vertices_ = 0;
  const auto append_commands = [&](auto range_of) {
    const std::size_t before = command_scratch_.size();
    std::uint32_t base_instance = 0;
    instances_.each([&](Instance& instance) {
      if (!instance.state.drawn()) return;
      const Topology& topology = topologies_.get(instance.topology);
      const Range range = range_of(topology);
      if (range.count > 0) {
        command_scratch_.push_back(
            {range.count, 1, range.first, static_cast<GLint>(instance.vertices.first), base_instance});
      }
      ++base_instance;
    });
    return static_cast<std::uint32_t>(command_scratch_.size() - before);
  };
  strip_commands_ = append_commands([](const Topology& topology) { return topology.strips; });
  fan_commands_ = append_commands([](const Topology& topology) { return topology.fans; });
  ring_commands_ = append_commands([](const Topology& topology) { return topology.rings; });
  instances_.each([&](Instance& instance) {
    if (!instance.state.drawn()) return;
    instance_scratch_.push_back({instance.rows.first, instance.items.first, instance.vertices.first,
                                 topologies_.get(instance.topology).infos.first,
                                 instance.state.interpolated(clock.step()) ? 1u : 0u});
    drawn_vertices_ += instance.vertices.count;
  });
  instance_data_.upload(std::as_bytes(std::span(instance_scratch_)));
  commands_.upload(std::as_bytes(std::span(command_scratch_)));
}

void StripBatch::bind(const StepClock& clock) {
  const GLuint array = vertex_array_.name();
  vertices_.bind_vertices(array, kPreviousVertices, clock.previous());
  vertices_.bind_vertices(array, kCurrentVertices, clock.current());
  glVertexArrayVertexBuffer(array, kInstances, instance_data_.name(), 0, sizeof(InstanceData));
  glVertexArrayElementBuffer(array, indices_.name());
  glBindVertexArray(array);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, infos_.name());
  rows_.bind_storage(1, clock.previous());
  rows_.bind_storage(2, clock.current());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, items_.name());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.name());
}

namespace {

std::uint32_t multi_draw(GLenum mode, std::uint32_t first_command, std::uint32_t count) {
  if (count == 0) return 0;
  const auto offset = static_cast<std::uintptr_t>(first_command) * sizeof(DrawCommand);
  glMultiDrawElementsIndirect(mode, GL_UNSIGNED_INT, reinterpret_cast<const void*>(offset),
                              static_cast<GLsizei>(count), 0);
  return 1;
}

}  // namespace

std::uint32_t StripBatch::draw_surfaces(const StepClock& clock) {
  if (strip_commands_ + fan_commands_ == 0) return 0;
  bind(clock);
  return multi_draw(GL_TRIANGLE_STRIP, 0, strip_commands_) +
         multi_draw(GL_TRIANGLE_FAN, strip_commands_, fan_commands_);
}

std::uint32_t StripBatch::draw_rings(const StepClock& clock) {
  if (ring_commands_ == 0) return 0;
  bind(clock);
  return multi_draw(GL_LINE_STRIP, strip_commands_ + fan_commands_, ring_commands_);
}

}  // namespace fascicle
