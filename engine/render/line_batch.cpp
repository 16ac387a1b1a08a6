#include "engine/render/line_batch.hpp"

#include <cstddef>

namespace fascicle {
namespace {

// Locations: 0 previous position, 1 current position, 2 colour, 3 flags, 4 point size. What a vertex array
// leaves out is read from the context's constant attributes, set before drawing.
GlVertexArray make_line_vertex_array(GLuint previous_binding, GLuint current_binding, bool with_flags,
                                     bool with_size) {
  GlVertexArray array = make_vertex_array();
  const GLuint name = array.name();
  const auto enable = [name](GLuint attribute, GLuint binding) {
    glVertexArrayAttribBinding(name, attribute, binding);
    glEnableVertexArrayAttrib(name, attribute);
  };
  glVertexArrayAttribFormat(name, 0, 3, GL_FLOAT, GL_FALSE, offsetof(LineVertex, position));
  enable(0, previous_binding);
  glVertexArrayAttribFormat(name, 1, 3, GL_FLOAT, GL_FALSE, offsetof(LineVertex, position));
  enable(1, current_binding);
  glVertexArrayAttribFormat(name, 2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(LineVertex, colour));
  enable(2, current_binding);
  if (with_flags) {
    glVertexArrayAttribIFormat(name, 3, 1, GL_UNSIGNED_INT, 0);
    enable(3, kInstanceFlags);
    glVertexArrayBindingDivisor(name, kInstanceFlags, 1);
  }
  if (with_size) {
    glVertexArrayAttribFormat(name, 4, 1, GL_FLOAT, GL_FALSE, sizeof(LineVertex));
    enable(4, current_binding);
  }
  return array;
}

void set_constant_attributes() {
  glVertexAttribI1ui(3, 0u);
  glVertexAttrib1f(4, 1.0f);
}

}  // namespace

LineBatch::LineBatch(GpuMemory& memory)
    : sets_(memory),
      fibres_(memory),
      line_buffer_(memory),
      point_buffer_(memory),
      set_array_(make_line_vertex_array(kPreviousStep, kCurrentStep, true, false)),
      line_array_(make_line_vertex_array(0, 0, false, false)),
      point_array_(make_line_vertex_array(0, 0, false, true)) {}

void LineBatch::add_line(const glm::vec3& from, const glm::vec3& to, std::uint32_t colour) {
  lines_.push_back({from, colour});
  lines_.push_back({to, colour});
}

void LineBatch::add_point(const glm::vec3& at, std::uint32_t colour, float size) {
  points_.push_back({{at, colour}, size});
}

void LineBatch::prepare(const StepClock& clock) {
  sets_.prepare(clock);
  fibres_.prepare(clock);
  if (!lines_.empty()) line_buffer_.upload(std::as_bytes(std::span(lines_)));
  if (!points_.empty()) point_buffer_.upload(std::as_bytes(std::span(points_)));
}

std::uint32_t LineBatch::draw_sets(const StepClock& clock) {
  set_constant_attributes();
  return sets_.draw(set_array_.name(), GL_LINE_STRIP, clock);
}

std::uint32_t LineBatch::draw_fibres(const StepClock& clock) {
  set_constant_attributes();
  return fibres_.draw(set_array_.name(), GL_LINE_STRIP, clock);
}

std::uint32_t LineBatch::draw_lines() {
  if (lines_.empty()) return 0;
  set_constant_attributes();
  glVertexArrayVertexBuffer(line_array_.name(), 0, line_buffer_.name(), 0, sizeof(LineVertex));
  glBindVertexArray(line_array_.name());
  glDrawArrays(GL_LINES, 0, static_cast<GLsizei>(lines_.size()));
  return 1;
}

std::uint32_t LineBatch::draw_points() {
  if (points_.empty()) return 0;
  set_constant_attributes();
  glVertexArrayVertexBuffer(point_array_.name(), 0, point_buffer_.name(), 0, sizeof(Point));
  glBindVertexArray(point_array_.name());
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(points_.size()));
  return 1;
}

void LineBatch::clear_immediate() {
  lines_.clear();
  points_.clear();
}

}  // namespace fascicle
