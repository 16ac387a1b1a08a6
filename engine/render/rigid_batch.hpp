// All rigid meshes (bones) of a scene in one multi-draw: meshes share one vertex and one index buffer, each mesh is
// one command with an instance for every group that uses it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "engine/render/draw_types.hpp"
#include "engine/render/handle_pool.hpp"
#include "engine/render/pool_buffer.hpp"
#include "engine/render/step_state.hpp"

namespace fascicle {

class RigidBatch {
 public:
  explicit RigidBatch(GpuMemory& memory);

  MeshHandle add_mesh(const TriangleMesh& mesh);
  RigidHandle add(std::span<const MeshHandle> meshes);
  void remove_mesh(MeshHandle mesh);
  void remove(RigidHandle group);

  std::span<glm::mat4> write_matrices(RigidHandle group, const StepClock& clock);
  StepState& state(RigidHandle group) { return groups_.get(group).state; }

  bool finish_step(const StepClock& clock);
  void prepare(const StepClock& clock);
  std::uint32_t draw(const StepClock& clock);

 private:
  struct Mesh {
    std::uint32_t first_vertex = 0, vertex_count = 0, first_index = 0, index_count = 0, uses = 0;
    std::vector<glm::uvec2> instances;  // scratch: matrix index; 1 where interpolated
  };
  struct Group {
    std::vector<MeshHandle> meshes;
    std::uint32_t first_matrix = 0;
    StepState state;
  };

  HandlePool<Mesh, MeshHandle> meshes_;
  HandlePool<Group, RigidHandle> groups_;
  PoolBuffer vertices_, indices_;
  StepBuffer matrices_;
  StreamBuffer instance_data_, commands_;
  std::vector<glm::uvec2> instance_scratch_;
  std::vector<DrawCommand> command_scratch_;
  bool changed_ = true;
  GlVertexArray vertex_array_;
};

}  // namespace fascicle
