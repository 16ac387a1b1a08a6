#include "engine/content/file_text.hpp"
#include "engine/content/quote_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <string>

#include "tests/engine/content/temporary_folder.hpp"

namespace fascicle {
namespace {

using testing::HasSubstr;

TEST(ReadTextFile, ReportsWhatCannotBeRead) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(to_text(read_text_file(folder / "none").diagnostics()), HasSubstr("no such file"));
  EXPECT_THAT(to_text(read_text_file(folder.path()).diagnostics()), HasSubstr("this is a folder"));
  test::write_in_place(folder / "large", std::string(1000, 'x'));
  EXPECT_THAT(to_text(read_text_file(folder / "large", 999).diagnostics()), HasSubstr("larger than 999 bytes"));
}

TEST(WriteTextAtomically, WritesReplacesAndMakesFolders) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a" / "b" / "c.txt";
  EXPECT_TRUE(write_text_atomically(file, "one").ok());
  EXPECT_TRUE(write_text_atomically(file, std::string(200000, '2')).ok());
  EXPECT_EQ(*read_text_file(file), std::string(200000, '2'));
  // Nothing but the file is left.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file.parent_path()), {}), 1);
}

TEST(WriteTextAtomically, ReportsFailure) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "here");
  test::write_in_place(folder.path() / "here" / "file", "x");
  const Diagnostics diagnostics = write_text_atomically(folder / "here", "text");  // a folder that is not empty
  EXPECT_THAT(to_text(diagnostics), HasSubstr("cannot be written"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  EXPECT_FALSE(write_text_atomically(folder.path() / "here" / "file" / "below", "x").ok());
}

TEST(WriteTextAtomically, WritesTheTargetOfALinkAndKeepsItsPermissions) {
  namespace fs = std::filesystem;
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "there");
  test::write_in_place(folder / "there/file", "old");
  fs::permissions(folder / "there/file", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("there/file", folder / "link");
  fs::create_symlink("there/new", folder / "dangling");
  EXPECT_TRUE(write_text_atomically(folder / "link", "new").ok());
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(*read_text_file(folder / "there/file"), "new");
  EXPECT_EQ(fs::status(folder / "there/file").permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_TRUE(write_text_atomically(folder / "dangling", "new").ok());
  EXPECT_TRUE(fs::is_symlink(folder / "dangling"));
  EXPECT_EQ(*read_text_file(folder / "there/new"), "new");
  fs::create_symlink("circle", folder / "circle");
  EXPECT_THAT(to_text(write_text_atomically(folder / "circle", "x")), HasSubstr("cannot be written"));
  EXPECT_TRUE(fs::is_symlink(folder / "circle"));
}

TEST(WriteTextAtomically, WritesIntoPipesAndReportsFullDevices) {
  namespace fs = std::filesystem;
  const test::TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  EXPECT_TRUE(write_text_atomically(pipe, "through").ok());
  char text[16] = {};
  EXPECT_EQ(::read(reader, text, sizeof text), 7);
  EXPECT_STREQ(text, "through");
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
  // By a link, so that the device itself is never at stake.
  fs::create_symlink("/dev/full", folder / "full");
  EXPECT_THAT(to_text(write_text_atomically(folder / "full", "x")), HasSubstr("No space left"));
  EXPECT_TRUE(fs::is_symlink(folder / "full"));
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

// As with `--stats /dev/stdout >file`: what the program prints before and after stays in the file, in order.
TEST(WriteTextAtomically, WritesIntoStandardOutputWhereItGoesToTheFile) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "out";
  test::write_in_place(file, "");
  std::fflush(stdout);
  const int kept = ::dup(STDOUT_FILENO);
  const int out = ::open(file.c_str(), O_WRONLY);
  ASSERT_GE(out, 0);
  ::dup2(out, STDOUT_FILENO);
  std::fputs("before ", stdout);
  const bool ok = write_text_atomically(file, "between ").ok();
  std::fputs("after", stdout);
  std::fflush(stdout);
  ::dup2(kept, STDOUT_FILENO);
  ::close(kept);
  ::close(out);
  EXPECT_TRUE(ok);
  EXPECT_EQ(*read_text_file(file), "before between after");
}

TEST(QuoteJson, Escapes) {
  EXPECT_EQ(quote_json("a\"b\\c\n\r\t\x02\xc3\xa4"), "\"a\\\"b\\\\c\\n\\r\\t\\u0002\xc3\xa4\"");
}

}  // namespace
}  // namespace fascicle
