#include "engine/render/rigid_batch.hpp"

#include <cassert>
#include <cstddef>

#include <glm/geometric.hpp>

namespace fascicle {
namespace {

constexpr GLuint kVertices = 0, kInstances = 1;  // vertex buffer bindings

GlVertexArray make_rigid_vertex_array() {
  GlVertexArray array = make_vertex_array();
  const GLuint name = array.name();
  glVertexArrayAttribFormat(name, 0, 3, GL_FLOAT, GL_FALSE, offsetof(DrawVertex, position));
  glVertexArrayAttribFormat(name, 1, 4, GL_INT_2_10_10_10_REV, GL_TRUE, offsetof(DrawVertex, normal));
  glVertexArrayAttribIFormat(name, 2, 2, GL_UNSIGNED_INT, 0);
  for (const GLuint attribute : {0u, 1u, 2u}) {
    glVertexArrayAttribBinding(name, attribute, attribute == 2 ? kInstances : kVertices);
    glEnableVertexArrayAttrib(name, attribute);
  }
  glVertexArrayBindingDivisor(name, kInstances, 1);
  return array;
}

// The file's normals, or area-weighted ones where it has none.
std::vector<DrawVertex> make_vertices(const TriangleMesh& mesh) {
  std::vector<DrawVertex> vertices(mesh.positions.size());
  if (mesh.normals.size() == mesh.positions.size()) {
    pack_vertices(mesh.positions, mesh.normals, vertices);
    return vertices;
  }
  std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3& a = mesh.positions[mesh.indices[i]];
    const glm::vec3& b = mesh.positions[mesh.indices[i + 1]];
    const glm::vec3& c = mesh.positions[mesh.indices[i + 2]];
    const glm::vec3 area = glm::cross(b - a, c - a);
    for (std::size_t corner = 0; corner < 3; ++corner) normals[mesh.indices[i + corner]] += area;
  }
  pack_vertices(mesh.positions, normals, vertices);
  return vertices;
}

}  // namespace

RigidBatch::RigidBatch(GpuMemory& memory)
    : vertices_(memory, sizeof(DrawVertex)),
      indices_(memory, sizeof(std::uint32_t)),
      matrices_(memory, sizeof(glm::mat4)),
      instance_data_(memory),
      commands_(memory),
      vertex_array_(make_rigid_vertex_array()) {}

MeshHandle RigidBatch::add_mesh(const TriangleMesh& mesh) {
  Mesh added;
  added.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
  added.index_count = static_cast<std::uint32_t>(mesh.indices.size());
  added.first_vertex = vertices_.allocate(added.vertex_count);
  added.first_index = indices_.allocate(added.index_count);
  vertices_.upload(added.first_vertex, std::as_bytes(std::span<const DrawVertex>(make_vertices(mesh))));
  indices_.upload(added.first_index, std::as_bytes(std::span(mesh.indices)));
  return meshes_.add(std::move(added));
}

void RigidBatch::remove_mesh(MeshHandle handle) {
  assert(meshes_.get(handle).uses == 0 && "remove its groups first");
  const Mesh mesh = meshes_.remove(handle);
  vertices_.release(mesh.first_vertex, mesh.vertex_count);
  indices_.release(mesh.first_index, mesh.index_count);
}

RigidHandle RigidBatch::add(std::span<const MeshHandle> meshes) {
  Group group;
  group.meshes.assign(meshes.begin(), meshes.end());
  group.first_matrix = matrices_.allocate(static_cast<std::uint32_t>(meshes.size()));
  for (const MeshHandle mesh : meshes) meshes_.get(mesh).uses += 1;
  return groups_.add(std::move(group));
}

void RigidBatch::remove(RigidHandle handle) {
  const Group group = groups_.remove(handle);
  matrices_.release(group.first_matrix, static_cast<std::uint32_t>(group.meshes.size()));
  for (const MeshHandle mesh : group.meshes) meshes_.get(mesh).uses -= 1;
  changed_ = true;
}

std::span<glm::mat4> RigidBatch::write_matrices(RigidHandle handle, const StepClock& clock) {
  Group& group = groups_.get(handle);
  group.state.write(clock.step());
  if (group.meshes.empty()) return {};
  return {reinterpret_cast<glm::mat4*>(matrices_.write(clock.current(), group.first_matrix)), group.meshes.size()};
}

bool RigidBatch::finish_step(const StepClock& clock) {
  bool copied = false;
  groups_.each([&](Group& group) {
    if (!group.state.carry(clock.step())) return;
    matrices_.copy(group.first_matrix, static_cast<std::uint32_t>(group.meshes.size()), clock.previous(),
                   clock.current());
    copied = true;
  });
  return copied;
}

void RigidBatch::prepare(const StepClock& clock) {
  groups_.each([&](Group& group) {
    if (group.state.update(clock.step())) changed_ = true;
  });
  if (!changed_) return;
  changed_ = false;

  meshes_.each([](Mesh& mesh) { mesh.instances.clear(); });
  groups_.each([&](Group& group) {
    if (!group.state.drawn()) return;
    const std::uint32_t interpolated = group.state.interpolated(clock.step()) ? 1u : 0u;
    for (std::size_t i = 0; i < group.meshes.size(); ++i) {
      meshes_.get(group.meshes[i]).instances.emplace_back(group.first_matrix + i, interpolated);
    }
  });
  instance_scratch_.clear();
  command_scratch_.clear();
  meshes_.each([&](Mesh& mesh) {
    if (mesh.instances.empty() || mesh.index_count == 0) return;
    command_scratch_.push_back({mesh.index_count, static_cast<GLuint>(mesh.instances.size()), mesh.first_index,
                                static_cast<GLint>(mesh.first_vertex),
                                static_cast<GLuint>(instance_scratch_.size())});
    instance_scratch_.insert(instance_scratch_.end(), mesh.instances.begin(), mesh.instances.end());
  });
  instance_data_.upload(std::as_bytes(std::span(instance_scratch_)));
  commands_.upload(std::as_bytes(std::span(command_scratch_)));
}

std::uint32_t RigidBatch::draw(const StepClock& clock) {
  if (command_scratch_.empty()) return 0;
  const GLuint array = vertex_array_.name();
  glVertexArrayVertexBuffer(array, kVertices, vertices_.name(), 0, sizeof(DrawVertex));
  glVertexArrayVertexBuffer(array, kInstances, instance_data_.name(), 0, sizeof(glm::uvec2));
  glVertexArrayElementBuffer(array, indices_.name());
  glBindVertexArray(array);
  matrices_.bind_storage(0, clock.previous());
  matrices_.bind_storage(1, clock.current());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.name());
  glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(command_scratch_.size()),
                              0);
  return 1;
}

}  // namespace fascicle
