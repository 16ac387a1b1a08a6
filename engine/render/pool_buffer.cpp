#include "engine/render/pool_buffer.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

namespace fascicle {
namespace {

// Slots start at multiples of this many elements, so that any stride of 4 bytes or more gives offsets that are
// multiples of 256 bytes, the most that shader storage may ask for.
constexpr std::uint32_t kMinElements = 256;

std::uint32_t grown_capacity(std::uint32_t capacity, std::uint32_t count) {
  // Twice as much, and surely room for `count` at the end.
  return std::bit_ceil(std::max({capacity + count, capacity * 2, kMinElements}));
}

GLuint make_buffer(std::size_t bytes, GLbitfield flags, GpuMemory& memory) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), nullptr, flags);
  memory.allocations += 1;
  memory.bytes += bytes;
  return name;
}

void free_buffer(GLuint name, std::size_t bytes, GpuMemory& memory) {
  if (name == 0) return;
  glDeleteBuffers(1, &name);
  memory.bytes -= bytes;
}

}  // namespace

PoolBuffer::~PoolBuffer() {
  free_buffer(name_, static_cast<std::size_t>(ranges_.capacity()) * stride_, memory_);
}

std::uint32_t PoolBuffer::allocate(std::uint32_t count) {
  if (const auto first = ranges_.allocate(count)) return *first;
  const std::uint32_t old_capacity = ranges_.capacity();
  const std::size_t old_bytes = static_cast<std::size_t>(old_capacity) * stride_;
  ranges_.grow(grown_capacity(old_capacity, count));
  const GLuint grown =
      make_buffer(static_cast<std::size_t>(ranges_.capacity()) * stride_, GL_DYNAMIC_STORAGE_BIT, memory_);
  if (name_ != 0) glCopyNamedBufferSubData(name_, grown, 0, 0, static_cast<GLsizeiptr>(old_bytes));
  free_buffer(name_, old_bytes, memory_);
  name_ = grown;
  return *ranges_.allocate(count);
}

void PoolBuffer::upload(std::uint32_t first, std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  glNamedBufferSubData(name_, static_cast<GLintptr>(static_cast<std::size_t>(first) * stride_),
                       static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

StepClock::~StepClock() {
  for (GLsync fence : fences_) glDeleteSync(fence);
}

bool StepClock::advance() {
  ++step_;
  GLsync& fence = fences_[current()];
  if (fence == nullptr) return false;
  GLenum answer = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, 0);
  const bool waited = answer == GL_TIMEOUT_EXPIRED;
  constexpr GLuint64 kTenMilliseconds = 10'000'000;
  while (answer == GL_TIMEOUT_EXPIRED) answer = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, kTenMilliseconds);
  glDeleteSync(fence);
  fence = nullptr;
  return waited;
}

void StepClock::guard() {
  guard_slot(current());
  guard_slot(previous());
}

void StepClock::guard_slot(std::uint32_t slot) {
  glDeleteSync(fences_[slot]);
  fences_[slot] = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

StepBuffer::~StepBuffer() { free_buffer(name_, total_bytes(), memory_); }

std::uint32_t StepBuffer::allocate(std::uint32_t count) {
  if (const auto first = ranges_.allocate(count)) return *first;
  const std::size_t old_slot = slot_bytes();
  ranges_.grow(grown_capacity(ranges_.capacity(), count));
  const GLbitfield flags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  const GLuint grown = make_buffer(total_bytes(), flags, memory_);
  for (std::uint32_t slot = 0; slot < StepClock::kSlots && name_ != 0; ++slot) {
    glCopyNamedBufferSubData(name_, grown, static_cast<GLintptr>(slot * old_slot), slot_offset(slot),
                             static_cast<GLsizeiptr>(old_slot));
  }
  glFinish();  // the copies must not land after what threads write next
  free_buffer(name_, StepClock::kSlots * old_slot, memory_);
  name_ = grown;
  mapped_ = static_cast<std::byte*>(glMapNamedBufferRange(name_, 0, static_cast<GLsizeiptr>(total_bytes()), flags));
  assert(mapped_ != nullptr);
  return *ranges_.allocate(count);
}

void StepBuffer::copy(std::uint32_t first, std::uint32_t count, std::uint32_t from_slot, std::uint32_t to_slot) {
  if (count == 0) return;
  const auto offset = static_cast<GLintptr>(static_cast<std::size_t>(first) * stride_);
  glCopyNamedBufferSubData(name_, name_, slot_offset(from_slot) + offset, slot_offset(to_slot) + offset,
                           static_cast<GLsizeiptr>(static_cast<std::size_t>(count) * stride_));
}

void StepBuffer::bind_vertices(GLuint vertex_array, GLuint binding, std::uint32_t slot) const {
  glVertexArrayVertexBuffer(vertex_array, binding, name_, slot_offset(slot), static_cast<GLsizei>(stride_));
}

void StepBuffer::bind_storage(GLuint binding, std::uint32_t slot) const {
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, name_, slot_offset(slot),
                    static_cast<GLsizeiptr>(slot_bytes()));
}

StreamBuffer::~StreamBuffer() { free_buffer(name_, capacity_, memory_); }

void StreamBuffer::upload(std::span<const std::byte> bytes) {
  constexpr std::size_t kMinBytes = 4096;
  if (bytes.size() > capacity_ || name_ == 0) {
    free_buffer(name_, capacity_, memory_);
    capacity_ = std::bit_ceil(std::max(bytes.size(), kMinBytes));
    name_ = make_buffer(capacity_, GL_DYNAMIC_STORAGE_BIT, memory_);
  }
  if (!bytes.empty()) glNamedBufferSubData(name_, 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

}  // namespace fascicle
