#include "game/run_recorder.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "engine/content/file_text.hpp"
#include "engine/ecs/monotonic_clock.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/muscle.hpp"
#include "modules/muscle/spawn_surface_muscles.hpp"

namespace fascicle::game {
namespace {

// A short run still has frames to count; a long one leaves out what caches and clocks need to settle.
std::size_t warm_up_frames(std::uint64_t total) {
  return total == 0 ? 30 : static_cast<std::size_t>(std::min<std::uint64_t>(30, total / 10));
}

// Prints what went wrong, and says whether nothing did.
bool explain(const Diagnostics& written) {
  if (!written.ok()) std::fputs(to_text(written).c_str(), stderr);
  return written.ok();
}

}  // namespace

RunRecorder::RunRecorder(const GameOptions& options, Simulation& simulation, std::uint64_t total_frames)
    : options_(options), stats_({.warm_up_frames = warm_up_frames(total_frames)}) {
  if (!options.trace_file.empty()) trace_.emplace();
  stats_.set_note("scene", simulation.scene().name);
  stats_.set_note("workers",
                  fmt::format("{} on {} cores", simulation.workers().workers(), parallel::hardware_workers()));
  stats_.set_note("simd", std::string(to_string(simulation.simd())));
  stats_.set_note("characters", std::to_string(simulation.characters().size()));
  announce_items(simulation);
  if (!options.report_file.empty()) surfaces_.start(simulation);
}

void RunRecorder::announce_items(Simulation& simulation) {
  if (!options_.detail) return;
  for (std::size_t i = 0; i < simulation.characters().size(); ++i) {
    const SpawnedCharacter& character = simulation.characters()[i];
    const std::string owner = cost_owner(character, i);
    if (character.musculature != ecs::kNoEntity) {
      muscle::list_costs(simulation.world(), character.musculature, owner);
    }
    simulation.world().view<const muscle::SurfaceMuscle>().each(
        [&](ecs::Entity entity, const muscle::SurfaceMuscle& surface) {
          if (surface.character != character.entity) return;
          muscle::list_surface_costs(simulation.world(), entity, fmt::format("{} {}", owner, surface.asset->name));
        });
  }
  simulation.world().resource<CostLedger>().set_enabled(true);
}

void RunRecorder::begin_frame() {
  stats_.begin_frame();
  frame_start_ns_ = monotonic_ns();
}

void RunRecorder::record_step(Simulation& simulation) {
  const auto timings = simulation.schedule().timings();
  stats_.record(timings);
  if (trace_) trace_->record(timings);
  collision_.record(simulation, options_.detail);
  surface_stats_.record(simulation);
  if (!options_.report_file.empty()) {
    report_.begin_frame();
    simulation.record_metrics(report_);
    const std::int64_t start = monotonic_ns();
    penetration_.record(simulation, report_);
    record_surface_figures(surfaces_.measure(simulation), report_);
    stats_.record_span("report", monotonic_ns() - start);
  }
  if (options_.detail) simulation.world().resource<CostLedger>().end_frame(stats_.warming_up());
}

void RunRecorder::record_draw(std::int64_t start_ns, std::int64_t end_ns, Renderer& renderer) {
  stats_.record_span("draw", end_ns - start_ns);
  if (trace_) trace_->add_complete("draw", "render", start_ns, end_ns, 0);
  if (renderer.timer().measured_frame() == gpu_frame_) return;
  gpu_frame_ = renderer.timer().measured_frame();
  for (const GpuTime& pass : renderer.gpu_times()) {
    stats_.record_gpu(pass.name, static_cast<std::int64_t>(pass.milliseconds * 1e6));
    if (trace_) trace_->add_counter("gpu " + pass.name + " ms", end_ns, pass.milliseconds);
  }
}

void RunRecorder::end_frame(const Simulation& simulation) {
  ++frames_;
  stats_.set_clamped_steps(simulation.clamped_steps());
  stats_.end_frame();
  if (!trace_) return;
  const std::int64_t now = monotonic_ns();
  trace_->add_frame(frames_, frame_start_ns_, now);
  trace_->add_counter("frame ms", now, static_cast<double>(now - frame_start_ns_) * 1e-6);
  trace_->add_counter("held", now, static_cast<double>(simulation.held_steps()));
  trace_->add_counter("steps dropped", now, static_cast<double>(simulation.clamped_steps()));
}

bool RunRecorder::wants_picture(const Simulation& simulation, bool is_last) const {
  if (!options_.screenshot || picture_written_) return false;
  // A window may make several steps at once and pass the one that was asked for.
  return options_.screenshot->frame ? *options_.screenshot->frame <= simulation.steps() : is_last;
}

void RunRecorder::write_picture(const Image& image) {
  const auto written = write_png(image, options_.screenshot->file);
  if (!written) std::fputs(to_text(written.diagnostics()).c_str(), stderr);
  picture_written_ = true;
  picture_failed_ = !written.ok();
}

int RunRecorder::finish(Simulation& simulation) {
  bool written = !picture_failed_;
  if (options_.screenshot && !picture_written_) {
    std::fprintf(stderr, "%s: no picture was taken: the run ended after %llu steps; ask for an earlier frame\n",
                 options_.screenshot->file.c_str(), static_cast<unsigned long long>(simulation.steps()));
    written = false;
  }
  if (const std::uint64_t held = simulation.held_steps(); held > 0) {
    std::fprintf(stderr,
                 "warning: %llu times a character or muscle kept its last shape because its bones were not finite or "
                 "too far from the origin for single precision\n",
                 static_cast<unsigned long long>(held));
  }
  stats_.set_memory(simulation.world().memory_by_component());
  if (options_.detail) stats_.add_rows(simulation.world().resource<CostLedger>().statistics());
  if (collision_.any()) stats_.set_note("collision", collision_.summary());
  if (!options_.stats_file.empty()) written &= explain(stats_.write(options_.stats_file));
  if (trace_) written &= explain(trace_->write(options_.trace_file));
  if (!options_.report_file.empty()) {
    written &= explain(write_text_atomically(options_.report_file,
                                             report_.to_json(simulation.scene().name, simulation.hash())));
  }
  if (options_.headless) {
    std::fputs((stats_.to_table() + collision_.to_table() + surface_stats_.to_table()).c_str(), stdout);
  }
  if (options_.hash) std::printf("hash %016llx\n", static_cast<unsigned long long>(simulation.hash()));
  return written ? kExitOk : kExitNoOutput;
}

}  // namespace fascicle::game
