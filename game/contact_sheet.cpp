#include "game/contact_sheet.hpp"

#include <algorithm>

#include <glm/gtc/constants.hpp>

namespace fascicle::game {

bool ContactSheet::wants(std::uint64_t frame) const {
  return std::binary_search(layout_.frames.begin(), layout_.frames.end(), frame);
}

void ContactSheet::take(Screen& screen, const glm::vec3& offset, const std::function<void()>& prepare) {
  const auto sides = static_cast<std::size_t>(layout_.sides);
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    DrawView view = view_;
    view.camera.target += offset;
    view.camera.yaw += glm::two_pi<float>() * static_cast<float>(row % sides) / static_cast<float>(sides);
    view.skins = layout_.with_skin && row < sides;
    prepare();
    rows_[row].push_back(screen.take_picture(view, layout_.width, layout_.height));
  }
}

Result<std::size_t> ContactSheet::write(const std::filesystem::path& file) const {
  std::vector<Image> images;
  for (const std::vector<Image>& row : rows_) images.insert(images.end(), row.begin(), row.end());
  return write_png(contact_sheet(images, static_cast<int>(layout_.frames.size())), file);
}

std::vector<std::uint64_t> spread_frames(std::uint64_t frames, std::uint64_t columns) {
  columns = std::min(columns, frames);
  std::vector<std::uint64_t> spread;
  for (std::uint64_t column = 1; column <= columns; ++column) spread.push_back(frames * column / columns);
  return spread;
}

}  // namespace fascicle::game
