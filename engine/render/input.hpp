// What the user did since the last frame, independent of the windowing library: read by the camera, the overlay and
// the game. Tests and headless runs fill it by hand.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

namespace fascicle {

enum class MouseButton : std::uint8_t { left, right, middle };

enum class Key : std::uint8_t {
  space, escape, enter, tab, backspace, remove, home, end, left, right, up, down, page_up, page_down, period, comma,
  a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z,
  f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12,
  count
};

struct InputState {
  glm::vec2 mouse{-1.0f, -1.0f};        // framebuffer pixels from the top left; negative: outside
  glm::vec2 mouse_delta{0.0f};          // since the last frame
  glm::vec2 scroll{0.0f};               // notches since the last frame
  std::array<bool, 3> buttons{};        // held now, by MouseButton
  std::array<bool, static_cast<std::size_t>(Key::count)> keys{};  // held now, by Key
  std::vector<Key> pressed;             // went down since the last frame, in order (no repeats)
  std::vector<std::uint32_t> text;      // Unicode code points typed since the last frame
  bool shift = false, control = false, alt = false;

  bool held(MouseButton button) const { return buttons[static_cast<std::size_t>(button)]; }
  bool held(Key key) const { return keys[static_cast<std::size_t>(key)]; }
  bool was_pressed(Key key) const;
};

}  // namespace fascicle
