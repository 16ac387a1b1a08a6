// Whole files as text, in and out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "engine/content/result.hpp"

namespace fascicle {

// The file's bytes. Errors: it is absent, a folder, unreadable, or larger than `max_bytes`.
Result<std::string> read_text_file(const std::filesystem::path& file,
                                   std::uintmax_t max_bytes = std::uintmax_t{1} << 30);

// Writes beside the file, then renames, so that a reader sees the old text or the new one and never a half; makes
// missing folders. The target of a symbolic link is written, not the link, and a file keeps its permissions. Devices,
// pipes and what standard output or error goes to (/dev/stdout) are never replaced: the text is written into them as
// into a stream. `text` may be any bytes. Returns empty diagnostics, or what went wrong.
Diagnostics write_text_atomically(const std::filesystem::path& file, std::string_view text);

}  // namespace fascicle
