#include "engine/loop/write_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace fascicle {
namespace {

class WriteFile : public testing::Test {
 protected:
  WriteFile() : folder_(std::filesystem::path(testing::TempDir()) / ("fascicle_write_file_" + name())) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~WriteFile() override { std::filesystem::remove_all(folder_); }

  static std::string name() { return testing::UnitTest::GetInstance()->current_test_info()->name(); }
  static std::string read(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

  std::filesystem::path folder_;
};

TEST_F(WriteFile, FailsWhereThereIsNoFolder) {
  EXPECT_EQ(write_file_atomically(folder_ / "none" / "a.txt", "x"), std::errc::no_such_file_or_directory);
  EXPECT_EQ(files(), 0u);
}

TEST_F(WriteFile, FailureLeavesWhatWasThere) {
  const std::filesystem::path path = folder_ / "taken";
  std::filesystem::create_directories(path / "inside");  // a folder cannot be replaced by a file
  EXPECT_TRUE(write_file_atomically(path, "x"));
  EXPECT_TRUE(std::filesystem::exists(path / "inside"));
  EXPECT_EQ(files(), 1u) << "the temporary file stayed behind";
}

TEST_F(WriteFile, WritesAndReplaces) {
  const std::filesystem::path path = folder_ / "a.txt";
  EXPECT_FALSE(write_file_atomically(path, std::string(100000, 'x')));
  EXPECT_EQ(read(path).size(), 100000u);
  EXPECT_FALSE(write_file_atomically(path, "short"));
  EXPECT_EQ(read(path), "short");
  EXPECT_FALSE(write_file_atomically(path, ""));
  EXPECT_EQ(read(path), "");
  EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace fascicle
