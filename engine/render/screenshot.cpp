#include "engine/render/screenshot.hpp"

#include <algorithm>
#include <cassert>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <stb/stb_image_write.h>

#include "engine/content/file_text.hpp"

namespace fascicle {
namespace {

void append_bytes(void* context, void* data, int size) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(context);
  const auto* first = static_cast<const std::uint8_t*>(data);
  bytes.insert(bytes.end(), first, first + size);
}

Diagnostic picture_error(const std::filesystem::path& file, const std::string& cause, const std::string& remedy) {
  return {file.string(), 0, 0, "", cause, remedy};
}

}  // namespace

Result<std::size_t> write_png(const Image& image, const std::filesystem::path& file) {
  const auto needed = 3 * static_cast<std::size_t>(std::max(image.width, 0)) *
                      static_cast<std::size_t>(std::max(image.height, 0));
  if (needed == 0 || image.rgb.size() != needed) {
    return picture_error(file, fmt::format("the picture is {} x {} with {} bytes", image.width, image.height,
                                           image.rgb.size()),
                         "a picture needs a positive size and three bytes a pixel");
  }
  std::vector<std::uint8_t> bytes;
  if (stbi_write_png_to_func(append_bytes, &bytes, image.width, image.height, 3, image.rgb.data(),
                             3 * image.width) == 0) {
    return picture_error(file, "the picture could not be compressed", "free some memory");
  }
  Diagnostics written = write_text_atomically(
      file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  if (!written.ok()) return written;
  return bytes.size();
}

Image contact_sheet(const std::vector<Image>& images, int columns, int gap) {
  assert(columns > 0 && gap >= 0);
  Image sheet;
  if (images.empty()) return sheet;
  const int width = images.front().width, height = images.front().height;
  const int count = static_cast<int>(images.size());
  const int used_columns = std::min(columns, count);
  const int rows = (count + columns - 1) / columns;
  sheet.width = used_columns * width + (used_columns - 1) * gap;
  sheet.height = rows * height + (rows - 1) * gap;
  sheet.rgb.assign(3 * static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height), 24);
  for (int i = 0; i < count; ++i) {
    const Image& image = images[static_cast<std::size_t>(i)];
    assert(image.width == width && image.height == height);
    const int x = (i % columns) * (width + gap), y = (i / columns) * (height + gap);
    for (int row = 0; row < height; ++row) {
      std::copy_n(image.pixel(0, row), 3 * width, sheet.pixel(x, y + row));
    }
  }
  return sheet;
}

Image shrink(const Image& image, int factor) {
  assert(factor > 0);
  Image small;
  small.width = image.width / factor;
  small.height = image.height / factor;
  small.rgb.resize(3 * static_cast<std::size_t>(small.width) * static_cast<std::size_t>(small.height));
  const int area = factor * factor;
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int dy = 0; dy < factor; ++dy) {
          for (int dx = 0; dx < factor; ++dx) sum += image.pixel(x * factor + dx, y * factor + dy)[c];
        }
        small.pixel(x, y)[c] = static_cast<std::uint8_t>((sum + area / 2) / area);
      }
    }
  }
  return small;
}

}  // namespace fascicle
