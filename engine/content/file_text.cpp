#include "engine/content/file_text.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>

namespace fascicle {
namespace {

Diagnostic file_error(const std::filesystem::path& file, std::string cause, std::string remedy) {
  return {.file = file.string(), .path = {}, .cause = std::move(cause), .remedy = std::move(remedy)};
}

// 0, or why not all was written (an errno).
int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;  // a device that takes no more
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// Standard output or error where it goes to `target` (as with /dev/stdout), else -1. A second opening of the same file
// would have a position of its own, and a file put in its place would get nothing of what is printed later.
int standard_stream_to(const struct stat& target) {
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat stream {};
    if (::fstat(descriptor, &stream) == 0 && stream.st_dev == target.st_dev && stream.st_ino == target.st_ino) {
      return descriptor;
    }
  }
  return -1;
}

// Into a device, a pipe, or a stream that is open already. 0, or an errno.
int write_directly(const std::filesystem::path& file, int open_already, std::string_view text) {
  if (open_already >= 0) {
    std::fflush(open_already == STDOUT_FILENO ? stdout : stderr);  // what was printed before comes first
    return write_all(open_already, text);
  }
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int code = write_all(descriptor, text);
  return ::close(descriptor) != 0 && code == 0 ? errno : code;
}

// The path that symbolic links at `file` lead to, whether or not there is a file; nothing where they go in a circle.
std::optional<std::filesystem::path> follow_links(std::filesystem::path file) {
  constexpr int kMaxLinks = 40;  // as the kernel
  std::error_code error;
  for (int i = 0; i < kMaxLinks; ++i) {
    if (!std::filesystem::is_symlink(std::filesystem::symlink_status(file, error))) return file;
    const std::filesystem::path next = std::filesystem::read_symlink(file, error);
    if (error) return file;
    file = file.parent_path() / next;  // an absolute `next` replaces the folder
  }
  return std::nullopt;
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
  const auto fail = [&](std::string_view what, int code) {
    result.errors.push_back(file_error(file, fmt::format("cannot be written: {}: {}", what, std::strerror(code)),
                                       "check that the folder may be written and the disk has room"));
    return result;
  };
  struct stat target {};
  const bool exists = ::stat(file.c_str(), &target) == 0;
  if (exists && !S_ISDIR(target.st_mode)) {
    const int open_already = standard_stream_to(target);
    if (open_already >= 0 || !S_ISREG(target.st_mode)) {
      const int code = write_directly(file, open_already, text);
      return code == 0 ? result : fail("writing failed", code);
    }
  }
  const std::optional<std::filesystem::path> resolved = follow_links(file);
  if (!resolved) return fail("its symbolic links have no end", ELOOP);
  std::error_code ignored;
  if (resolved->has_parent_path()) std::filesystem::create_directories(resolved->parent_path(), ignored);
  std::string temporary = resolved->string() + ".XXXXXX";
  const int descriptor = ::mkstemp(temporary.data());
  if (descriptor < 0) return fail("no new file beside it", errno);
  const mode_t mode = exists && S_ISREG(target.st_mode) ? target.st_mode & 0777 : 0644;
  int code = write_all(descriptor, text);
  if (code == 0 && ::fchmod(descriptor, mode) != 0) code = errno;
  if (::close(descriptor) != 0 && code == 0) code = errno;
  if (code != 0) {
    fail("writing failed", code);
  } else if (::rename(temporary.c_str(), resolved->c_str()) != 0) {
    fail("the new file cannot take its place", errno);
  } else {
    return result;
  }
  ::unlink(temporary.c_str());
  return result;
}

}  // namespace fascicle
