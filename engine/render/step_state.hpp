// When a drawn thing was last written, and so whether it can be drawn and interpolated.
#pragma once

#include <cstdint>

#include "engine/render/pool_buffer.hpp"

namespace fascicle {

struct StepState {
  std::uint64_t first_written = 0;  // step; 0: never
  std::uint64_t last_written = 0;
  std::uint64_t teleported = 0;     // the last step that was a jump
  bool visible = true;

  // What the draw commands were made from.
  bool drawn_before = false;
  bool interpolated_before = false;

  void write(std::uint64_t step) {
    if (first_written == 0) first_written = step;
    last_written = step;
  }
  bool drawn() const { return visible && first_written != 0; }
  bool interpolated(std::uint64_t step) const { return first_written < step && teleported != step; }
  // True where draw commands made earlier no longer fit; remembers the new state.
  bool update(std::uint64_t step) {
    const bool changed = drawn() != drawn_before || interpolated(step) != interpolated_before;
    drawn_before = drawn();
    interpolated_before = interpolated(step);
    return changed;
  }
  // True once in each step that didn't write a thing which has been written before: it must be carried over.
  bool carry(std::uint64_t step) {
    if (first_written == 0 || last_written == step) return false;
    last_written = step;
    return true;
  }
};

}  // namespace fascicle
