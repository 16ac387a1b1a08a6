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

std::int64_t nanoseconds(const timespec& time) { return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec; }

std::int64_t wall_clock_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);  // the clock of the stamps
  return nanoseconds(now);
}

// States of a file without content; all others are hashes.
constexpr std::uint64_t kAbsent = 0, kUnreadable = 1, kEmpty = 2;
constexpr bool has_content(std::uint64_t state) { return state > kEmpty; }

// Of a file that exists.
std::uint64_t hash_file(const std::filesystem::path& file) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return kUnreadable;
  if (text->empty()) return kEmpty;
  // FNV-1a over words, which is fast enough for meshes of some megabytes.
  std::uint64_t hash = 0xcbf29ce484222325u ^ text->size();
  for (std::size_t i = 0; i < text->size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, text->data() + i, std::min<std::size_t>(8, text->size() - i));
    hash = (hash ^ word) * 0x100000001b3u;
    hash ^= hash >> 29;  // so that high bytes reach low bits
  }
  return has_content(hash) ? hash : ~hash;
}

}  // namespace

FileWatcher::Stamp FileWatcher::read_stamp(const std::filesystem::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return {};
  return {true, static_cast<std::uintmax_t>(info.st_size),
          nanoseconds(info.st_mtim), nanoseconds(info.st_ctim),
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
    entry.reported = entry.stamp.exists ? hash_file(file) : kAbsent;
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
    const std::uint64_t state = stamp.exists ? hash_file(entry.file) : kAbsent;
    if (state == entry.reported) {
      entry.pending_polls = 0;
      entry.settled = has_content(state) && stable && wall_clock_ns() - stamp.modified_ns > kTrustedAgeNs;
      continue;
    }
    if (entry.pending_polls == 0 || state != entry.pending) {  // perhaps half-written: wait
      entry.pending = state;
      entry.pending_polls = 1;
      entry.pending_since = Clock::now();
      continue;
    }
    ++entry.pending_polls;
    const bool lasting = has_content(state) || (entry.pending_polls >= kSettlePolls &&
                                                Clock::now() - entry.pending_since >= settle_);
    if (!lasting) continue;
    entry.reported = state;
    entry.pending_polls = 0;
    changed.push_back(entry.file);
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
