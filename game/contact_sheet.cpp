#include "game/contact_sheet.hpp"

#include <algorithm>

#include <glm/gtc/constants.hpp>

namespace fascicle::game {
namespace {

constexpr int kCellWidth = 300;   // pixels of one picture on the page
constexpr int kCellHeight = 420;

}  // namespace

ContactSheet::ContactSheet(OrbitCamera camera, std::uint64_t frames, int columns, int sides)
    : camera_(camera),
      frames_(frames),
      columns_(static_cast<int>(std::min<std::uint64_t>(static_cast<std::uint64_t>(columns), frames))),
      sides_(sides),
      with_skin_(static_cast<std::size_t>(sides)),
      without_skin_(static_cast<std::size_t>(sides)) {}

bool ContactSheet::wants(std::uint64_t frame) const {
  for (int column = 1; column <= columns_; ++column) {
    if (frame == frames_ * static_cast<std::uint64_t>(column) / static_cast<std::uint64_t>(columns_)) return true;
  }
  return false;
}

void ContactSheet::take(Screen& screen, const glm::vec3& offset, const std::function<void()>& prepare) {
  DrawView view;
  view.camera = camera_;
  view.camera.target += offset;
  view.lines = false;
  for (int side = 0; side < sides_; ++side) {
    const std::size_t row = static_cast<std::size_t>(side);
    view.camera.yaw = camera_.yaw + glm::two_pi<float>() * static_cast<float>(side) / static_cast<float>(sides_);
    view.skins = true;
    prepare();
    with_skin_[row].push_back(screen.take_picture(view, kCellWidth, kCellHeight));
    view.skins = false;
    prepare();
    without_skin_[row].push_back(screen.take_picture(view, kCellWidth, kCellHeight));
  }
}

Result<std::size_t> ContactSheet::write(const std::filesystem::path& file) const {
  std::vector<Image> images;
  for (const auto* part : {&with_skin_, &without_skin_}) {
    for (const std::vector<Image>& row : *part) images.insert(images.end(), row.begin(), row.end());
  }
  return write_png(contact_sheet(images, columns_), file);
}

}  // namespace fascicle::game
