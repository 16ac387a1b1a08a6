#include "engine/render/gpu_timer.hpp"

#include <epoxy/gl.h>

namespace fascicle {

GpuTimer::~GpuTimer() {
  for (Slot& slot : slots_) {
    for (Pass& pass : slot.passes) glDeleteQueries(2, pass.queries);
  }
}

void GpuTimer::begin_frame() {
  end_frame();
  collect();
  ++frame_;
  Slot& slot = slots_[current_];
  if (slot.pending) {
    ++skipped_;
    return;
  }
  slot.used = 0;
  slot.frame = frame_;
  recording_ = true;
}

void GpuTimer::begin_pass(const char* name) {
  if (!recording_) return;
  Slot& slot = slots_[current_];
  if (slot.used == slot.passes.size()) {
    Pass pass;
    glCreateQueries(GL_TIMESTAMP, 2, pass.queries);
    slot.passes.push_back(pass);
  }
  Pass& pass = slot.passes[slot.used];
  pass.name = name;
  glQueryCounter(pass.queries[0], GL_TIMESTAMP);
}

void GpuTimer::end_pass() {
  if (!recording_) return;
  Slot& slot = slots_[current_];
  glQueryCounter(slot.passes[slot.used].queries[1], GL_TIMESTAMP);
  ++slot.used;
}

void GpuTimer::end_frame() {
  if (!recording_) return;
  slots_[current_].pending = slots_[current_].used > 0;
  current_ = (current_ + 1) % kSlots;
  recording_ = false;
}

void GpuTimer::collect() {
  for (Slot& slot : slots_) {
    if (!slot.pending) continue;
    GLuint64 ready = GL_FALSE;  // of the last query: timestamps complete in order
    glGetQueryObjectui64v(slot.passes[slot.used - 1].queries[1], GL_QUERY_RESULT_AVAILABLE, &ready);
    if (ready == GL_FALSE) continue;
    slot.pending = false;
    if (slot.frame < measured_frame_) continue;
    measured_frame_ = slot.frame;
    times_.resize(slot.used);
    for (std::size_t i = 0; i < slot.used; ++i) {
      GLuint64 begin = 0, end = 0;
      glGetQueryObjectui64v(slot.passes[i].queries[0], GL_QUERY_RESULT, &begin);
      glGetQueryObjectui64v(slot.passes[i].queries[1], GL_QUERY_RESULT, &end);
      times_[i].name = slot.passes[i].name;
      times_[i].milliseconds = end > begin ? static_cast<double>(end - begin) * 1e-6 : 0.0;
    }
  }
}

}  // namespace fascicle
