// Where tests find real data that is not part of the project: the folder named by the environment variable
// FASCICLE_DATA, by default ../shared/data beside the project. Tests that need it skip, saying so, where it is absent.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace fascicle::test {

inline std::filesystem::path data_folder() {
  if (const char* folder = std::getenv("FASCICLE_DATA")) return folder;
  return std::filesystem::path(FASCICLE_SOURCE_DIR) / ".." / "shared" / "data";
}

}  // namespace fascicle::test

#define FASCICLE_SKIP_WITHOUT_DATA(relative)                                                      \
  if (!std::filesystem::exists(::fascicle::test::data_folder() / (relative)))                     \
  GTEST_SKIP() << (::fascicle::test::data_folder() / (relative)) << " is absent; set FASCICLE_DATA"
