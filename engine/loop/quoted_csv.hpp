// A text as a field of the CSV that the statistics write.
#pragma once

#include <string>
#include <string_view>

namespace fascicle {

// RFC 4180: quoted where it holds a comma, a quote or a line break.
std::string quoted_csv(std::string_view text);

}  // namespace fascicle
