#include "game/run_window.hpp"

#include <chrono>
#include <cstdio>

#include <fmt/format.h>

#include "engine/ecs/monotonic_clock.hpp"
#include "engine/render/pick.hpp"
#include "game/overlay_model.hpp"
#include "game/pick_place.hpp"
#include "game/run_recorder.hpp"
#include "game/scene_view.hpp"
#include "game/screen.hpp"
#include "game/simulation.hpp"
#include "game/tag_editor.hpp"
#include "modules/muscle/content/content_reloader.hpp"
#include "modules/muscle/content/save_collision.hpp"
#include "modules/muscle/muscle.hpp"

namespace fascicle::game {
namespace {

const std::uint32_t kPickColour = pack_colour({1.0f, 1.0f, 1.0f, 1.0f});

class WindowRun {
 public:
  WindowRun(const GameOptions& options, const std::filesystem::path& scene_file,
            std::shared_ptr<const muscle::SceneAsset> scene, Screen& screen)
      : options_(options),
        screen_(screen),
        reloader_(scene_file, scene),
        simulation_(scene, {.workers = options.threads,
                            .copies = options.copies,
                            .simd = parse_simd_level(options.simd).value_or(detect_simd()),
                            .surface_solver = options.surface_solver,
                            .skin_meshes = true}),
        scene_view_(simulation_, *screen.renderer),
        feed_(scene->name, fmt::format("{}, {} workers", screen.info.renderer, simulation_.workers().workers())),
        recorder_(options, simulation_, options.frames.value_or(0)) {
    view_.camera = scene_camera(simulation_.scene());
    view_.lines = false;
    view_.marks = options.show_collision;
    view_.skins = !options.show_collision && !options.show_fibres;
    view_.fibres = options.show_fibres;
  }

  int run() {
    auto last = std::chrono::steady_clock::now();
    while (!is_over()) {
      const auto now = std::chrono::steady_clock::now();
      const double seconds = std::chrono::duration<double>(now - last).count();
      last = now;
      frame(seconds);
    }
    return recorder_.finish(simulation_);
  }

 private:
  // The window is closing, or the frames that were asked for are done: this is the last picture.
  bool is_over() const {
    return screen_.window->should_close() || (options_.frames && simulation_.steps() >= *options_.frames);
  }

  void frame(double seconds) {
    const InputState& input = screen_.window->poll();
    const glm::ivec2 size = screen_.window->framebuffer_size();
    if (size.x > 0 && size.y > 0) screen_.renderer->resize(size.x, size.y);

    poll_reload();
    recorder_.begin_frame();
    simulation_.set_viewer(make_viewer(view_.camera, screen_.renderer->height(), options_.level));
    const int steps = simulation_.loop().begin_frame(seconds);
    for (int i = 0; i < steps && !is_over(); ++i) {
      scene_view_.begin_step();
      simulation_.step();
      feed_.record_step(simulation_.schedule());
      recorder_.record_step(simulation_);
    }

    const bool over_overlay = show_overlay_ && screen_.overlay->wants_mouse();
    if (!over_overlay) apply_input(input, glm::vec2(size), view_.camera);
    if (!screen_.overlay->wants_keyboard()) handle_keys(input);
    const auto click = clicks_.update(input, over_overlay);
    if (click && editor_.active()) pick(*click, glm::vec2(size));
    view_.alpha = simulation_.loop().paused() ? 1.0f : simulation_.loop().alpha();
    const std::int64_t draw_start = monotonic_ns();
    screen_.renderer->draw(mark(view_));
    if (show_overlay_) {
      const OverlayModel& model =
          feed_.build(simulation_, *screen_.renderer, view_, static_cast<float>(seconds * 1e3), shown_character_,
                      recorder_.collision(), editor_.task());
      apply(screen_.overlay->draw(model, input, static_cast<float>(seconds), *screen_.renderer));
    }
    screen_.renderer->present(size.x, size.y);
    recorder_.record_draw(draw_start, monotonic_ns(), *screen_.renderer);
    recorder_.end_frame(simulation_);
    if (recorder_.wants_picture(simulation_, is_over())) {
      recorder_.write_picture(screen_.renderer->read_image());
    }
    screen_.window->swap();
  }

  // The view as it is drawn, with this picture's marks handed over.
  DrawView mark(DrawView view) {
    constexpr float kMarksThrough = 0.6f;  // what is behind muscles matters as much
    if (view.marks) scene_view_.mark_collision();
    for (const PickedPlace& place : editor_.places()) {
      if (editor_.active() && place.bone < 0) scene_view_.mark_place(place.character, place.tag, kPickColour);
    }
    if (view.marks || editor_.active()) view.lines_through = kMarksThrough;
    view.marks |= editor_.active();
    return view;
  }

  void pick(const glm::vec2& pixel, const glm::vec2& size) {
    const auto is_hidden = [this](const std::string& name) { return !feed_.item_state(name).visible; };
    const PickFilter filter{.muscles = view_.strips, .bones = view_.meshes, .is_hidden = is_hidden};
    const auto place = pick_place(simulation_, filter, ray_through(view_.camera, pixel, size));
    if (place) editor_.pick(*place);
  }

  void edit(TagCommand command) {
    if (command == TagCommand::kSave) save_tag();
    else if (command == TagCommand::kLeave) editor_.set_active(false);
    else editor_.apply(command);
  }

  // The reload of the changed file brings the tag into the simulation.
  void save_tag() {
    const auto tag = editor_.tag();
    if (!tag) return;
    const muscle::CharacterAsset& asset = *simulation_.characters()[editor_.places()[0].character].asset;
    const auto saved = muscle::save_transversal(asset.files.front(), asset, *tag, editor_.mirror());
    feed_.set_messages(saved.diagnostics());
    if (saved) {
      editor_.set_saved(saved->file.string());
    } else {
      editor_.set_failed();
      show_overlay_ = true;  // it has the errors
    }
  }

  void poll_reload() {
    auto outcome = reloader_.poll();
    if (!outcome) return;
    feed_.set_messages(outcome->diagnostics);
    if (!outcome->scene) {
      std::fputs(to_text(outcome->diagnostics).c_str(), stderr);
      return;
    }
    scene_view_.release();
    simulation_.swap_scene(outcome->scene);
    scene_view_.attach();
    recorder_.announce_items(simulation_);
    apply_item_states();
    std::vector<const muscle::CharacterAsset*> assets;
    for (const SpawnedCharacter& character : simulation_.characters()) assets.push_back(character.asset.get());
    editor_.rename(assets);
    // The new things show nothing until a step has written them.
    scene_view_.begin_step();
    simulation_.refresh();
    std::fprintf(stderr, "content reloaded\n");
  }

  void handle_keys(const InputState& input) {
    if (input.was_pressed(Key::e)) editor_.set_active(!editor_.active());
    if (editor_.active()) {
      if (const auto command = TagEditor::command_of(input)) return edit(*command);
    }
    if (input.was_pressed(Key::space)) toggle_pause();
    if (input.was_pressed(Key::period)) simulation_.loop().request_single_step();
    if (input.was_pressed(Key::h)) show_overlay_ = !show_overlay_;
    if (input.was_pressed(Key::r)) view_.camera = scene_camera(simulation_.scene());
    if (input.was_pressed(Key::escape)) screen_.window->request_close();
    for (const ViewSwitch& s : kViewSwitches) {
      if (input.was_pressed(s.key)) view_.*s.field = !(view_.*s.field);
    }
  }

  void apply(const OverlayActions& actions) {
    if (actions.toggle_pause) toggle_pause();
    if (actions.single_step) simulation_.loop().request_single_step();
    if (actions.time_scale >= 0.0f) simulation_.loop().set_time_scale(actions.time_scale);
    if (actions.switched >= 0) {
      const ViewSwitch& s = kViewSwitches[static_cast<std::size_t>(actions.switched)];
      view_.*s.field = !(view_.*s.field);
    }
    if (actions.task_button >= 0) edit(TagEditor::command_of_button(actions.task_button));
    if (actions.slider == 0) view_.skin_opacity = actions.slider_value;
    if (actions.dismiss_messages) feed_.clear_messages();
    if (actions.hide_overlay) show_overlay_ = false;
    if (actions.item_highlighted >= 0) flip(actions.item_highlighted, &OverlayFeed::ItemState::highlighted);
    if (actions.item_visibility >= 0) flip(actions.item_visibility, &OverlayFeed::ItemState::visible);
  }

  void flip(int item, bool OverlayFeed::ItemState::* field) {
    const std::string name = feed_.item_name(static_cast<std::size_t>(item));
    if (name.empty()) return;
    OverlayFeed::ItemState& state = feed_.item_state(name);
    state.*field = !(state.*field);
    apply_item_states();
  }

  // What the user hid or marked, by the muscles' names, so that it outlives a reload.
  void apply_item_states() {
    const SpawnedCharacter& shown = simulation_.characters()[shown_character_];
    const auto flags_of = [this](const std::string& name) {
      const OverlayFeed::ItemState& state = feed_.item_state(name);
      return (state.visible ? 0u : kItemHidden) | (state.highlighted ? kItemHighlighted : 0u);
    };
    for (std::uint32_t m = 0; shown.asset->muscles && m < shown.asset->muscles->size(); ++m) {
      scene_view_.set_muscle_flags(shown.scene_index, m, flags_of(shown.asset->muscles->muscles[m].name));
    }
    simulation_.world().view<const muscle::SurfaceMuscle>().each([&](const muscle::SurfaceMuscle& surface) {
      if (surface.character != shown.entity) return;
      scene_view_.set_surface_flags(shown.scene_index, surface.asset->name, flags_of(surface.asset->name));
    });
  }

  void toggle_pause() { simulation_.loop().set_paused(!simulation_.loop().paused()); }

  const GameOptions& options_;
  Screen& screen_;
  muscle::ContentReloader reloader_;
  Simulation simulation_;
  SceneView scene_view_;
  OverlayFeed feed_;
  RunRecorder recorder_;
  TagEditor editor_;
  ClickTracker clicks_;
  DrawView view_;
  bool show_overlay_ = true;
  std::size_t shown_character_ = 0;
};

}  // namespace

int run_window(const GameOptions& options, const std::filesystem::path& scene_file,
               std::shared_ptr<const muscle::SceneAsset> scene) {
  auto screen = open_window("Fascicle: " + scene->name, options.width, options.height);
  if (!screen) {
    std::fputs(to_text(screen.diagnostics()).c_str(), stderr);
    std::fprintf(stderr, "No window can be opened; --headless runs without one.\n");
    return kExitNoOutput;
  }
  WindowRun run(options, scene_file, std::move(scene), **screen);
  return run.run();
}

}  // namespace fascicle::game
