// Line and column of a byte offset in a text, for the positions that errors quote. Lines end with \n, \r\n or \r;
// columns count UTF-8 characters, as editors do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace fascicle {

struct TextPosition {
  int line = 0;    // from 1; 0: unknown
  int column = 0;  // from 1
};

class LineTable {
 public:
  LineTable() = default;
  // Keeps no reference to `text`.
  explicit LineTable(std::string_view text);

  // `text` is the text that the table was made from. An offset past its end gives the position of its end.
  TextPosition position(std::string_view text, std::size_t offset) const;

 private:
  std::vector<std::size_t> starts_;  // offset of each line's first byte
};

}  // namespace fascicle
