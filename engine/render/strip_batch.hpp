// All strip surfaces of a scene in two draw calls: one multi-draw of strips, one of fans.
//
// Instances (characters) of one topology share indices and vertex infos; an instance's command carries its base
// vertex, and its base instance selects the row of attributes that tells the shader where its rows and items start.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "engine/render/draw_types.hpp"
#include "engine/render/handle_pool.hpp"
#include "engine/render/pool_buffer.hpp"
#include "engine/render/step_state.hpp"
#include "engine/render/strip_topology.hpp"

namespace fascicle {

class StripBatch {
 public:
  explicit StripBatch(GpuMemory& memory);

  StripTopologyHandle add_topology(const StripTopology& topology);
  StripHandle add(StripTopologyHandle topology);
  void remove_topology(StripTopologyHandle topology);
  void remove(StripHandle strips);

  std::span<DrawVertex> write_vertices(StripHandle strips, const StepClock& clock);
  std::span<StripRow> write_rows(StripHandle strips, const StepClock& clock);
  std::span<StripItem> items(StripHandle strips);
  StepState& state(StripHandle strips) { return instances_.get(strips).state; }

  // Carries over what the current step didn't write; true where GPU copies were issued.
  bool finish_step(const StepClock& clock);
  // Remakes commands where something appeared, went or stopped being interpolated, and uploads changed items.
  void prepare(const StepClock& clock);
  // Both return the draw calls issued (0 where there is nothing to draw). The program is bound by the caller.
  std::uint32_t draw_surfaces(const StepClock& clock);
  std::uint32_t draw_rings(const StepClock& clock);
  std::uint64_t drawn_vertices() const { return drawn_vertices_; }

 private:
  struct Range {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  struct Topology {
    Range infos, strips, fans, rings;
    std::uint32_t vertex_count = 0, row_count = 0, item_count = 0, uses = 0;
  };
  struct Instance {
    StripTopologyHandle topology;
    Range vertices, rows, items;
    bool items_changed = false;
    StepState state;
  };
  // Attributes of an instance, by base instance.
  struct InstanceData {
    std::uint32_t first_row = 0, first_item = 0, first_vertex = 0, first_info = 0;
    std::uint32_t interpolated = 0;
  };
  Range add_indices(std::span<const std::uint32_t> indices);
  void bind(const StepClock& clock);

  HandlePool<Topology, StripTopologyHandle> topologies_;
  HandlePool<Instance, StripHandle> instances_;
  std::vector<StripItem> item_mirror_;  // what the GPU's items are uploaded from
  PoolBuffer infos_, indices_, items_;
  StepBuffer vertices_, rows_;
  StreamBuffer instance_data_, commands_;
  std::vector<InstanceData> instance_scratch_;
  std::vector<DrawCommand> command_scratch_;
  std::uint32_t strip_commands_ = 0, fan_commands_ = 0, ring_commands_ = 0;  // in this order in commands_
  bool changed_ = true;
  std::uint64_t drawn_vertices_ = 0;
  GlVertexArray vertex_array_;
};

}  // namespace fascicle
