// Lines and points: line sets that follow the simulation's steps (action lines; fibres, which are switched apart), and
// immediate ones for one frame.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/render/deforming_batch.hpp"

namespace fascicle {

class LineBatch {
 public:
  explicit LineBatch(GpuMemory& memory);

  DeformingBatch<LineHandle>& sets() { return sets_; }
  DeformingBatch<FibreHandle>& fibres() { return fibres_; }
  void add_line(const glm::vec3& from, const glm::vec3& to, std::uint32_t colour);
  void add_point(const glm::vec3& at, std::uint32_t colour, float size);

  void prepare(const StepClock& clock);
  bool has_sets() const { return !sets_.empty(); }
  bool has_fibres() const { return !fibres_.empty(); }
  bool has_lines() const { return !lines_.empty(); }    // immediate ones
  bool has_points() const { return !points_.empty(); }
  // The program is bound by the caller. Return the draw calls issued.
  std::uint32_t draw_sets(const StepClock& clock);
  std::uint32_t draw_fibres(const StepClock& clock);
  std::uint32_t draw_lines();
  std::uint32_t draw_points();
  // Forgets the immediate lines and points.
  void clear_immediate();

 private:
  struct Point {
    LineVertex vertex;
    float size = 0.0f;  // pixels
  };
  DeformingBatch<LineHandle> sets_;
  DeformingBatch<FibreHandle> fibres_;
  std::vector<LineVertex> lines_;
  std::vector<Point> points_;
  StreamBuffer line_buffer_, point_buffer_;
  GlVertexArray set_array_, line_array_, point_array_;
};

}  // namespace fascicle
