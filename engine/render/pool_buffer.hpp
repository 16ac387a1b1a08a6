// GPU buffers that many things share, each with a range of its own.
//
// A PoolBuffer holds constant data, written once. A StepBuffer holds data that changes every simulation step: three
// copies (slots) in one persistently mapped buffer, of which the frame reads the last two while the next step writes
// the third. Threads write straight into the mapping; no GL call is made for it. Both grow by doubling when something
// is added that doesn't fit, never in a steady frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/render/gl_objects.hpp"
#include "engine/render/range_allocator.hpp"

namespace fascicle {

class PoolBuffer {
 public:
  PoolBuffer(GpuMemory& memory, std::uint32_t stride) : memory_(memory), stride_(stride) {}
  ~PoolBuffer();
  PoolBuffer(const PoolBuffer&) = delete;
  PoolBuffer& operator=(const PoolBuffer&) = delete;

  std::uint32_t allocate(std::uint32_t count);
  void release(std::uint32_t first, std::uint32_t count) { ranges_.release(first, count); }
  void upload(std::uint32_t first, std::span<const std::byte> bytes);
  GLuint name() const { return name_; }
  std::uint32_t stride() const { return stride_; }

 private:
  GpuMemory& memory_;
  std::uint32_t stride_;
  RangeAllocator ranges_;
  GLuint name_ = 0;
};

// Which slots the last two steps are in, and the fences that keep a step from overwriting what the GPU still reads.
class StepClock {
 public:
  static constexpr std::uint32_t kSlots = 3;
  ~StepClock();
  // Starts the next step. True where it had to wait for the GPU.
  bool advance();
  // Call after GL commands that read or write the last two slots.
  void guard();

  std::uint64_t step() const { return step_; }
  std::uint32_t current() const { return static_cast<std::uint32_t>(step_ % kSlots); }
  std::uint32_t previous() const { return static_cast<std::uint32_t>((step_ + kSlots - 1) % kSlots); }

 private:
  void guard_slot(std::uint32_t slot);

  std::uint64_t step_ = 0;
  GLsync fences_[kSlots] = {};
};

class StepBuffer {
 public:
  StepBuffer(GpuMemory& memory, std::uint32_t stride) : memory_(memory), stride_(stride) {}
  ~StepBuffer();
  StepBuffer(const StepBuffer&) = delete;
  StepBuffer& operator=(const StepBuffer&) = delete;

  std::uint32_t allocate(std::uint32_t count);
  void release(std::uint32_t first, std::uint32_t count) { ranges_.release(first, count); }
  std::byte* write(std::uint32_t slot, std::uint32_t first) {
    return mapped_ + slot * slot_bytes() + static_cast<std::size_t>(first) * stride_;
  }
  // GPU copy of a range between slots, for things that no step wrote.
  void copy(std::uint32_t first, std::uint32_t count, std::uint32_t from_slot, std::uint32_t to_slot);

  GLuint name() const { return name_; }
  std::size_t slot_bytes() const { return static_cast<std::size_t>(ranges_.capacity()) * stride_; }
  std::size_t total_bytes() const { return StepClock::kSlots * slot_bytes(); }
  GLintptr slot_offset(std::uint32_t slot) const { return static_cast<GLintptr>(slot * slot_bytes()); }
  std::uint32_t stride() const { return stride_; }
  // Binds a slot as a vertex buffer, or as a shader storage block.
  void bind_vertices(GLuint vertex_array, GLuint binding, std::uint32_t slot) const;
  void bind_storage(GLuint binding, std::uint32_t slot) const;

 private:
  GpuMemory& memory_;
  std::uint32_t stride_;
  RangeAllocator ranges_;
  GLuint name_ = 0;
  std::byte* mapped_ = nullptr;
};

// Small data rewritten whole from a CPU array when it changes: draw commands, instance tables, immediate lines.
class StreamBuffer {
 public:
  explicit StreamBuffer(GpuMemory& memory) : memory_(memory) {}
  ~StreamBuffer();
  StreamBuffer(const StreamBuffer&) = delete;
  StreamBuffer& operator=(const StreamBuffer&) = delete;

  void upload(std::span<const std::byte> bytes);
  GLuint name() const { return name_; }

 private:
  GpuMemory& memory_;
  GLuint name_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace fascicle
