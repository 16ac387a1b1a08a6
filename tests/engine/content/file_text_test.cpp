#include "engine/content/file_text.hpp"
#include "engine/content/quote_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(QuoteJson, Escapes) {
  EXPECT_EQ(quote_json("a\"b\\c\n\r\t\x02\xc3\xa4"), "\"a\\\"b\\\\c\\n\\r\\t\\u0002\xc3\xa4\"");
}

}  // namespace
}  // namespace fascicle
