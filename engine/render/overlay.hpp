// The text and graphs over the picture (Dear ImGui): time per system with history, a frame graph, a list of items,
// switches, pause and single step, and messages such as the errors of a live reload. It knows nothing of the game:
// an OverlayModel goes in, OverlayActions come out. Works headless too.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/content/result.hpp"
#include "engine/render/input.hpp"

namespace fascicle {

class Renderer;

struct OverlayTiming {
  std::string_view name;
  float milliseconds = 0.0f;
};

struct OverlaySwitch {
  const char* name = "";
  bool on = false;
  const char* shortcut = "";  // shown beside it
};

struct OverlaySlider {
  const char* name = "";
  float value = 0.0f;
  float low = 0.0f;
  float high = 1.0f;
};

// A row of the item list. Values in the units that the model's headings state; one that is not a number is left out.
inline constexpr std::size_t kOverlayValues = 9;
struct OverlayItem {
  std::string_view name;
  float values[kOverlayValues] = {};
  bool visible = true;
  bool highlighted = false;
  bool warning = false;  // painted amber
};

struct OverlayButton {
  std::string name;
  const char* shortcut = "";  // shown beside it
  bool enabled = true;
};

// What the user is in the middle of: lines of text and buttons. Without a title it isn't shown.
struct OverlayTask {
  std::string title;
  std::vector<std::string> lines;
  std::vector<OverlayButton> buttons;
};

struct OverlayModel {
  std::string_view title;           // scene
  std::string_view subtitle;        // who draws: GL renderer, workers
  float frame_milliseconds = 0.0f;  // wall time of the last frame
  float budget_milliseconds = 16.7f;
  std::uint64_t frame = 0;          // simulation step count
  double time = 0.0;                // simulation time, s
  bool paused = false;
  float time_scale = 1.0f;
  std::uint64_t catch_up_steps = 0;
  std::span<const OverlayTiming> systems;
  std::span<const OverlayTiming> gpu;
  std::span<const OverlayTiming> counts;  // name and plain number ("characters", "draw calls")
  std::span<const OverlaySwitch> switches;
  std::span<const OverlaySlider> sliders;
  const char* item_heading = "item";
  // Up to the first that is empty or null.
  std::array<const char*, kOverlayValues> value_headings = {};
  std::span<const OverlayItem> items;
  const OverlayTask* task = nullptr;
  std::span<const std::string> errors;    // shown in red until gone from the model
  std::span<const std::string> warnings;
};

// What the user asked for in this frame; -1: nothing.
struct OverlayActions {
  bool toggle_pause = false;
  bool single_step = false;
  float time_scale = -1.0f;
  int switched = -1;              // index of a switch to flip
  int slider = -1;                // index of a slider moved to slider_value
  float slider_value = 0.0f;
  int item_highlighted = -1;      // item clicked
  int item_visibility = -1;       // item whose visibility to flip
  int task_button = -1;           // button of the task that was pressed
  bool dismiss_messages = false;
  bool hide_overlay = false;
};

// A line of text over the picture.
struct Caption {
  glm::vec2 at{0.0f};                    // pixels from the picture's top left corner to the text's
  std::string text;
  std::uint32_t colour = 0xffffffffu;    // sRGB, R in the lowest byte: of the text, or of its swatch
  bool swatch = false;                   // a square of that colour stands before it, the text is white
};

class Overlay {
 public:
  // Needs the renderer's context current. One overlay at a time.
  static Result<std::unique_ptr<Overlay>> create();
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  // Lays out and draws over the renderer's picture (after Renderer::draw, before present or read_image).
  // `delta_seconds` is the wall time since the last frame.
  OverlayActions draw(const OverlayModel& model, const InputState& input, float delta_seconds, Renderer& renderer);

  // Draws lines of text of this height (pixels) over the renderer's picture, and nothing else.
  void draw_captions(std::span<const Caption> captions, float size, Renderer& renderer);
  // Pixels that a line of text takes.
  float text_width(std::string_view text, float size) const;

  // Of the last draw: the pointer or keyboard is the overlay's, not the camera's.
  bool wants_mouse() const;
  bool wants_keyboard() const;

 private:
  struct State;
  Overlay();
  std::unique_ptr<State> state_;
};

}  // namespace fascicle
