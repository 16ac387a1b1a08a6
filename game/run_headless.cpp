#include "game/run_headless.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "engine/ecs/monotonic_clock.hpp"
#include "game/contact_sheet.hpp"
#include "game/run_recorder.hpp"
#include "game/scene_view.hpp"
#include "game/screen.hpp"
#include "game/simulation.hpp"

namespace fascicle::game {
namespace {

constexpr std::int64_t kProgressAfterNs = 2'000'000'000;  // a run this long shows how far it is
constexpr std::int64_t kProgressEveryNs = 500'000'000;

// "frame 120 of 300" on a terminal, rewritten in place; silent in a pipe and for short runs.
class Progress {
 public:
  explicit Progress(std::uint64_t total) : total_(total), start_ns_(monotonic_ns()), shown_ns_(start_ns_) {}
  void show(std::uint64_t frame) {
    if (!terminal_) return;
    const std::int64_t now = monotonic_ns();
    if (now - start_ns_ < kProgressAfterNs || now - shown_ns_ < kProgressEveryNs) return;
    shown_ns_ = now;
    shown_ = true;
    std::fprintf(stderr, "\rframe %llu of %llu ", static_cast<unsigned long long>(frame),
                 static_cast<unsigned long long>(total_));
  }
  void done() const {
    if (shown_) std::fprintf(stderr, "\r                                        \r");
  }

 private:
  std::uint64_t total_;
  std::int64_t start_ns_, shown_ns_;
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  bool shown_ = false;
};

}  // namespace

int run_headless(const GameOptions& options, std::shared_ptr<const muscle::SceneAsset> scene) {
  const std::uint64_t frames = options.frames.value_or(static_cast<std::uint64_t>(scene->frames));
  if (!options.sheet_frames.empty() && options.sheet_frames.back() > frames) {
    std::fprintf(stderr, "--sheet-frames asks for frame %llu of %llu; ask for earlier ones or more --frames\n",
                 static_cast<unsigned long long>(options.sheet_frames.back()),
                 static_cast<unsigned long long>(frames));
    return kExitUsage;
  }
  std::unique_ptr<Screen> screen;
  if (options.draw) {
    auto opened = open_headless(options.width, options.height);
    if (!opened) {
      std::fputs(to_text(opened.diagnostics()).c_str(), stderr);
      std::fprintf(stderr, "Nothing can be drawn here; --no-draw runs the simulation alone.\n");
      return kExitNoOutput;
    }
    screen = std::move(*opened);
  }

  Simulation simulation(scene, {.workers = options.threads,
                                .copies = options.copies,
                                .simd = parse_simd_level(options.simd).value_or(detect_simd()),
                                .surface_solver = options.surface_solver,
                                .skin_meshes = options.draw});
  std::optional<SceneView> view;
  DrawView draw_view;
  draw_view.camera = scene_camera(*scene);  // muscles have their level of detail by it, drawn or not
  draw_view.lines = false;
  draw_view.skins = !options.show_collision && !options.show_fibres;
  draw_view.fibres = options.show_fibres;
  if (options.show_collision) draw_view.lines_through = 0.6f;
  if (screen) view.emplace(simulation, *screen->renderer);
  const auto mark = [&] {  // immediate marks are of one picture
    if (options.show_collision) view->mark_collision();
  };

  std::optional<ContactSheet> sheet;
  if (!options.contact_sheet_file.empty()) {
    const auto& characters = simulation.characters();
    const bool any_skin = std::any_of(characters.begin(), characters.end(),
                                      [](const SpawnedCharacter& character) { return !character.skins.empty(); });
    sheet.emplace(draw_view, ContactSheet::Layout{
                                 .frames = options.sheet_frames.empty() ? spread_frames(frames) : options.sheet_frames,
                                 .sides = options.sheet_sides,
                                 .with_skin = draw_view.skins && any_skin,
                                 .width = options.sheet_width,
                                 .height = options.sheet_height});
  }
  RunRecorder recorder(options, simulation, frames);
  Progress progress(frames);

  for (std::uint64_t frame = 1; frame <= frames; ++frame) {
    recorder.begin_frame();
    if (view) view->begin_step();
    simulation.set_viewer(make_viewer(draw_view.camera, options.height, options.level));
    simulation.step();
    recorder.record_step(simulation);
    draw_view.camera.target = scene->camera.target + simulation.travel();
    if (screen) {
      mark();
      const std::int64_t start = monotonic_ns();
      screen->renderer->draw(draw_view);
      recorder.record_draw(start, monotonic_ns(), *screen->renderer);
    }
    recorder.end_frame(simulation);
    if (screen && recorder.wants_picture(simulation, frame == frames)) {
      mark();
      recorder.write_picture(screen->take_picture(draw_view, options.width, options.height));
    }
    if (sheet && sheet->wants(frame)) sheet->take(*screen, simulation.travel(), mark);
    progress.show(frame);
  }
  progress.done();

  int status = recorder.finish(simulation);
  if (sheet) {
    const auto written = sheet->write(options.contact_sheet_file);
    if (!written) {
      std::fputs(to_text(written.diagnostics()).c_str(), stderr);
      status = kExitNoOutput;
    }
  }
  return status;
}

}  // namespace fascicle::game
