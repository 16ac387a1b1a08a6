// A page of pictures of one run: frames from left to right, four sides from top to bottom, first with the skin and then
// without. Authors open it to look for muscles that flip, twist, leave their bones or pierce them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "game/screen.hpp"

namespace fascicle::game {

class ContactSheet {
 public:
  // Takes `columns` frames, evenly spread over `frames`, from `sides` directions around the camera's target.
  ContactSheet(OrbitCamera camera, std::uint64_t frames, int columns = 8, int sides = 4);

  // True when frame `frame` (from 1) belongs on the sheet.
  bool wants(std::uint64_t frame) const;
  // Draws it from all sides. The target follows `offset` (a character that walks away). `prepare` is called before
  // each picture: the renderer's immediate lines and points are of one picture.
  void take(Screen& screen, const glm::vec3& offset, const std::function<void()>& prepare);
  // Writes the page.
  Result<std::size_t> write(const std::filesystem::path& file) const;

 private:
  OrbitCamera camera_;
  std::uint64_t frames_;
  int columns_;
  int sides_;
  std::vector<std::vector<Image>> with_skin_;     // by side, then frame
  std::vector<std::vector<Image>> without_skin_;
};

}  // namespace fascicle::game
