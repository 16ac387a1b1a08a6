// A page of pictures of one run: frames from left to right, sides from top to bottom, first with the skin, where there
// is one, and then without. Authors open it to look for muscles that flip, twist, leave their bones or pierce them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <utility>
#include <vector>

#include "game/screen.hpp"

namespace fascicle::game {

class ContactSheet {
 public:
  struct Layout {
    std::vector<std::uint64_t> frames;  // from 1, rising
    int sides = 4;                      // directions around the camera's target
    bool with_skin = false;             // all of it twice
    int width = 300, height = 420;      // of one picture, pixels
  };
  // Pictures as `view` shows them.
  ContactSheet(const DrawView& view, Layout layout) : view_(view), layout_(std::move(layout)), rows_(row_count()) {}

  // True when frame `frame` (from 1) belongs on the sheet.
  bool wants(std::uint64_t frame) const;
  // Draws it from all sides. The target follows `offset` (a character that walks away). `prepare` is called before
  // each picture: the renderer's immediate lines and points are of one picture.
  void take(Screen& screen, const glm::vec3& offset, const std::function<void()>& prepare);
  // Writes the page.
  Result<std::size_t> write(const std::filesystem::path& file) const;

 private:
  std::size_t row_count() const {
    return static_cast<std::size_t>(layout_.with_skin ? 2 * layout_.sides : layout_.sides);
  }

  DrawView view_;
  Layout layout_;
  std::vector<std::vector<Image>> rows_;  // by side with the skin, if it is wanted, then by side without
};

// `columns` frames evenly spread over a run of `frames`, its last one among them; all where there are fewer.
std::vector<std::uint64_t> spread_frames(std::uint64_t frames, std::uint64_t columns = 8);

}  // namespace fascicle::game
