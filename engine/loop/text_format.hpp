// Strings as fields of the text formats the loop writes.
#pragma once

#include <string>
#include <string_view>

namespace fascicle {

// With its quotes, valid JSON whatever the bytes: control characters escaped, broken UTF-8 as U+FFFD.
std::string quoted_json(std::string_view text);

// A CSV field (RFC 4180): quoted where it holds a comma, a quote or a line break.
std::string quoted_csv(std::string_view text);

}  // namespace fascicle
