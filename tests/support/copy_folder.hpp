// A character's folder copied for a test that changes it. Beside its content lies the cache of its bones' fields, which
// other tests may be writing at the same time: what they have not finished is left out.
#pragma once

#include <filesystem>
#include <string>

namespace fascicle::test {

inline void copy_character_folder(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::filesystem::create_directories(to);
  for (const auto& entry : std::filesystem::directory_iterator(from)) {
    const std::string name = entry.path().filename().string();
    if (name.find(".bones.vdb.") == std::string::npos) std::filesystem::copy_file(entry.path(), to / name);
  }
}

}  // namespace fascicle::test
