#include "engine/content/text_position.hpp"

#include <algorithm>

namespace fascicle {

LineTable::LineTable(std::string_view text) : starts_{0} {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool lone_return = text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n');
    if (text[i] == '\n' || lone_return) starts_.push_back(i + 1);
  }
}

TextPosition LineTable::position(std::string_view text, std::size_t offset) const {
  if (starts_.empty()) return {};
  offset = std::min(offset, text.size());
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), offset);
  const std::size_t start = *(after - 1);
  int column = 1;
  for (std::size_t i = start; i < offset; ++i) {
    if ((static_cast<unsigned char>(text[i]) & 0xc0u) != 0x80u) ++column;  // continuation bytes are no characters
  }
  return {static_cast<int>(after - starts_.begin()), column};
}

}  // namespace fascicle
