#include "engine/content/watch_files.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <string_view>

#include "engine/content/file_text.hpp"

namespace fascicle {
namespace {

// File systems keep times in steps of up to 2 s (FAT); an edit that follows another within a step and keeps the size
// leaves the stamp as it was. So a stamp counts only when it was this old when it was read.
constexpr std::int64_t kTrustedAgeNs = 2'500'000'000;

std::int64_t wall_clock_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);  // the clock of the stamps
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// Never 0 for content; 0 for an empty or unreadable file.
std::uint64_t hash_file(const std::filesystem::path& file) {
  const Result<std::string> text = read_text_file(file);
  if (!text || text->empty()) return 0;
  // FNV-1a over words, which is fast enough for meshes of some megabytes.
  std::uint64_t hash = 0xcbf29ce484222325u ^ text->size();
  for (std::size_t i = 0; i < text->size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, text->data() + i, std::min<std::size_t>(8, text->size() - i));
    hash = (hash ^ word) * 0x100000001b3u;
    hash ^= hash >> 29;  // so that high bytes reach low bits
  }
  return hash == 0 ? 1 : hash;
}

}  // namespace

FileWatcher::Stamp FileWatcher::read_stamp(const std::filesystem::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return {};
  return {true, static_cast<std::uintmax_t>(info.st_size),
          std::int64_t{info.st_mtim.tv_sec} * 1'000'000'000 + info.st_mtim.tv_nsec,
          static_cast<std::uint64_t>(info.st_ino)};
}

void FileWatcher::watch(std::vector<std::filesystem::path> files) {
  std::ranges::sort(files);
  files.erase(std::unique(files.begin(), files.end()), files.end());
  std::vector<Entry> entries;
  entries.reserve(files.size());
  for (std::filesystem::path& file : files) {
    const auto known = std::ranges::lower_bound(entries_, file, {}, &Entry::file);
    if (known != entries_.end() && known->file == file) {
      entries.push_back(std::move(*known));
      known->file = file;  // keeps entries_ sorted for the searches to come
      continue;
    }
    Entry entry;
    entry.stamp = read_stamp(file);
    if (entry.stamp.exists) entry.reported_hash = hash_file(file);
    entry.file = std::move(file);
    entries.push_back(std::move(entry));
  }
  entries_ = std::move(entries);
}

bool FileWatcher::poll(std::vector<std::filesystem::path>& changed) {
  const std::size_t before = changed.size();
  for (Entry& entry : entries_) {
    const Stamp stamp = read_stamp(entry.file);
    if (entry.settled && stamp == entry.stamp) continue;
    const bool stable = stamp == entry.stamp;
    entry.stamp = stamp;
    entry.settled = false;
    const std::uint64_t hash = stamp.exists ? hash_file(entry.file) : 0;
    if (hash == 0 || hash == entry.reported_hash) {
      entry.pending_hash = 0;
      entry.settled = hash != 0 && stable && wall_clock_ns() - stamp.modified_ns > kTrustedAgeNs;
    } else if (hash != entry.pending_hash) {
      entry.pending_hash = hash;  // perhaps half-written: wait for the next poll
    } else {
      entry.reported_hash = hash;
      entry.pending_hash = 0;
      changed.push_back(entry.file);
    }
  }
  return changed.size() > before;
}

std::vector<std::filesystem::path> FileWatcher::missing() const {
  std::vector<std::filesystem::path> files;
  for (const Entry& entry : entries_) {
    if (!entry.stamp.exists) files.push_back(entry.file);
  }
  return files;
}

}  // namespace fascicle
