// Writes a whole file or none of it: a reader, or a crash, never meets half of it.
#pragma once

#include <filesystem>
#include <string_view>
#include <system_error>

namespace fascicle {

// Writes beside `path` under another name, then renames. On failure `path` is as before and the error says why.
[[nodiscard]] std::error_code write_file_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace fascicle
