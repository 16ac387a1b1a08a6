// Notices that content files changed, for live reload. Polling, a few stat calls a time: this works on every file
// system, for editors that rename a new file over the old one as well as for those that write in place.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace fascicle {

class FileWatcher {
 public:
  // Replaces the set of watched files (duplicates are dropped). Files known before keep their state, so that an edit
  // made between a load and this call is still reported by the next poll; the state of new ones is taken now, so watch
  // a file before loading it. A file that is absent is watched for its appearance.
  void watch(std::vector<std::filesystem::path> files);

  // Appends to `changed` the files whose content differs from what was last reported (or, at first, seen), and returns
  // whether there were any. A file is reported once it has been the same, and not empty, for two polls in a row, so
  // that half-written ones are left alone; one that vanished is reported when it is back with another content. Compares
  // size, time in ns and inode first; reads a hash of the content only when these differ or are too recent to be
  // trusted.
  bool poll(std::vector<std::filesystem::path>& changed);

  // Watched files that are absent right now, as of the last poll.
  std::vector<std::filesystem::path> missing() const;

 private:
  struct Stamp {
    bool exists = false;
    std::uintmax_t size = 0;
    std::int64_t modified_ns = 0;
    std::uint64_t inode = 0;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  struct Entry {
    std::filesystem::path file;
    Stamp stamp;                      // at the last poll
    std::uint64_t reported_hash = 0;  // content that the owner knows; 0: none
    std::uint64_t pending_hash = 0;   // content seen at the last poll, 0: none
    bool settled = false;             // the stamp is old enough and its content is the reported one
  };
  static Stamp read_stamp(const std::filesystem::path& file);

  std::vector<Entry> entries_;  // sorted by path
};

}  // namespace fascicle
