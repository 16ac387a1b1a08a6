#include "game/contact_sheet.hpp"

#include <algorithm>

#include <glm/gtc/constants.hpp>

namespace fascicle::game {
namespace {

constexpr int kCellWidth = 300;   // pixels of one picture on the page
constexpr int kCellHeight = 420;

}  // namespace

ContactSheet::ContactSheet(const DrawView& view, std::vector<std::uint64_t> frames, int sides, bool with_skin)
    : view_(view),
      frames_(std::move(frames)),
      sides_(sides),
      with_skin_(with_skin),
      rows_(static_cast<std::size_t>(with_skin ? 2 * sides : sides)) {}

bool ContactSheet::wants(std::uint64_t frame) const {
  return std::binary_search(frames_.begin(), frames_.end(), frame);
}

void ContactSheet::take(Screen& screen, const glm::vec3& offset, const std::function<void()>& prepare) {
  const auto first_without = static_cast<std::size_t>(with_skin_ ? sides_ : 0);
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const std::size_t side = row % static_cast<std::size_t>(sides_);
    DrawView view = view_;
    view.camera.target += offset;
    view.camera.yaw += glm::two_pi<float>() * static_cast<float>(side) / static_cast<float>(sides_);
    view.skins = row < first_without;
    prepare();
    rows_[row].push_back(screen.take_picture(view, kCellWidth, kCellHeight));
  }
}

Result<std::size_t> ContactSheet::write(const std::filesystem::path& file) const {
  std::vector<Image> images;
  for (const std::vector<Image>& row : rows_) images.insert(images.end(), row.begin(), row.end());
  return write_png(contact_sheet(images, static_cast<int>(frames_.size())), file);
}

std::vector<std::uint64_t> spread_frames(std::uint64_t frames, std::uint64_t columns) {
  columns = std::min(columns, frames);
  std::vector<std::uint64_t> spread;
  for (std::uint64_t column = 1; column <= columns; ++column) spread.push_back(frames * column / columns);
  return spread;
}

}  // namespace fascicle::game
