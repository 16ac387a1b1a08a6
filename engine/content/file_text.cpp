#include "engine/content/file_text.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace fascicle {
namespace {

Diagnostic file_error(const std::filesystem::path& file, std::string cause, std::string remedy) {
  return {.file = file.string(), .path = {}, .cause = std::move(cause), .remedy = std::move(remedy)};
}

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

Result<std::string> read_text_file(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(file, code);
  if (!std::filesystem::exists(status)) {
    return file_error(file, "no such file", "check the name; paths are relative to the file that names them");
  }
  if (std::filesystem::is_directory(status)) return file_error(file, "this is a folder", "name a file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return file_error(file, "cannot be opened", "check that the file may be read");
  std::string text;
  // Read in blocks rather than by the size that the file system tells: pipes and files being written have none.
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  while (stream) {
    const std::size_t used = text.size();
    text.resize(used + kBlock);
    stream.read(text.data() + used, static_cast<std::streamsize>(kBlock));
    text.resize(used + static_cast<std::size_t>(stream.gcount()));
    if (text.size() > max_bytes) {
      return file_error(file, fmt::format("larger than {} bytes", max_bytes),
                        "split it, or check that it is the right file");
    }
  }
  if (stream.bad()) return file_error(file, "cannot be read to its end", "check the disk");
  return text;
}

Diagnostics write_text_atomically(const std::filesystem::path& file, std::string_view text) {
  Diagnostics result;
  const auto fail = [&](std::string_view what) {
    result.errors.push_back(file_error(file, fmt::format("cannot be written: {}: {}", what, std::strerror(errno)),
                                       "check that the folder may be written and the disk has room"));
    return result;
  };
  std::error_code code;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), code);
  std::string temporary = file.string() + ".XXXXXX";
  const int descriptor = ::mkstemp(temporary.data());
  if (descriptor < 0) return fail("no new file beside it");
  bool ok = write_all(descriptor, text) && ::fchmod(descriptor, 0644) == 0;
  ok = ::close(descriptor) == 0 && ok;
  if (ok && ::rename(temporary.c_str(), file.c_str()) == 0) return result;
  fail(ok ? "the new file cannot take its place" : "writing failed");
  ::unlink(temporary.c_str());
  return result;
}

}  // namespace fascicle
