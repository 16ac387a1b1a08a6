// Pictures as files. A picture is written whole or not at all (see write_text_atomically).
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "engine/content/result.hpp"

namespace fascicle {

// 8-bit sRGB, rows from the top, three bytes a pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  const std::uint8_t* pixel(int x, int y) const {
    return rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x));
  }
  std::uint8_t* pixel(int x, int y) { return const_cast<std::uint8_t*>(std::as_const(*this).pixel(x, y)); }
};

// Writes a PNG; makes missing folders. Returns the file's size in bytes, or an error (empty image, path not writable).
Result<std::size_t> write_png(const Image& image, const std::filesystem::path& file);

// Pastes images of one size into a grid of `columns`, in reading order, `gap` pixels apart: a contact sheet.
Image contact_sheet(const std::vector<Image>& images, int columns, int gap = 4);

// Averages factor x factor pixels into one.
Image shrink(const Image& image, int factor);

}  // namespace fascicle
