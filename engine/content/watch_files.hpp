// Notices that content files changed, for live reload. Polling, a few stat calls a time: this works on every file
// system, for editors that rename a new file over the old one as well as for those that write in place.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace fascicle {

class FileWatcher {
 public:
  using Clock = std::chrono::steady_clock;

  // `settle`: how long, besides kSettlePolls polls, a file must have been absent, empty or unreadable to be reported.
  explicit FileWatcher(Clock::duration settle = std::chrono::seconds(1)) : settle_(settle) {}
  static constexpr int kSettlePolls = 8;

  // Replaces the set of watched files (duplicates are dropped). Files known before keep their state, so that an edit
  // made between a load and this call is still reported by the next poll; the state of new ones is taken now, so watch
  // a file before loading it. A file that is absent is watched for its appearance.
  void watch(std::vector<std::filesystem::path> files);

  // Appends to `changed` the files whose content differs from what was last reported (or, at first, seen), and returns
  // whether there were any. A file is reported once it has been the same for two polls in a row, so that half-written
  // ones are left alone. Absent, empty and unreadable files are states like any content, but those that a save may pass
  // through: they are reported when they last for kSettlePolls polls and the settle time, so that whoever loads the
  // file says what is wrong with it, and its return is reported in turn; a file that is back sooner and as it was is
  // not. Compares size, times in ns and inode first; reads a hash of the content only when these differ or are too
  // recent to be trusted.
  bool poll(std::vector<std::filesystem::path>& changed);

  // Watched files that are absent right now, as of the last poll.
  std::vector<std::filesystem::path> missing() const;

 private:
  struct Stamp {
    bool exists = false;
    std::uintmax_t size = 0;
    std::int64_t modified_ns = 0;
    std::int64_t changed_ns = 0;  // of permissions, too
    std::uint64_t inode = 0;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  struct Entry {
    std::filesystem::path file;
    Stamp stamp;                      // at the last poll
    std::uint64_t reported = 0;       // state that the owner knows: a hash of the content, or a state without any
    std::uint64_t pending = 0;        // another state, seen at the last `pending_polls` polls
    int pending_polls = 0;
    Clock::time_point pending_since;
    bool settled = false;             // the stamp is old enough and its content is the reported one
  };
  static Stamp read_stamp(const std::filesystem::path& file);

  Clock::duration settle_;
  std::vector<Entry> entries_;  // sorted by path
};

}  // namespace fascicle
