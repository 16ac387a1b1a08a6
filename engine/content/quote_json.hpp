// Text as a JSON string, for everything that the project writes as JSON.
#pragma once

#include <string>
#include <string_view>

namespace fascicle {

// With its quotes, valid JSON whatever the bytes: control characters escaped, broken UTF-8 as U+FFFD.
std::string quote_json(std::string_view text);

}  // namespace fascicle
