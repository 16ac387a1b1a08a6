#include "engine/render/screenshot.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stb/stb_image.h>

namespace fascicle {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Image make_gradient(int width, int height) {
  Image image{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height))};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::uint8_t* pixel = image.pixel(x, y);
      pixel[0] = static_cast<std::uint8_t>(x * 7);
      pixel[1] = static_cast<std::uint8_t>(y * 11);
      pixel[2] = static_cast<std::uint8_t>(x * y);
    }
  }
  return image;
}

fs::path fresh_folder(const char* name) {
  const fs::path folder = fs::path(testing::TempDir()) / "fascicle_screenshot_test" / name;
  fs::remove_all(folder);
  return folder;
}

TEST(WritePng, RefusesEmptyAndInconsistentPictures) {
  const fs::path file = fresh_folder("bad") / "a.png";
  for (const Image& bad : {Image{}, Image{-3, 5, {}}, Image{2, 2, std::vector<std::uint8_t>(11)}}) {
    const Result<std::size_t> written = write_png(bad, file);
    ASSERT_FALSE(written.ok());
    EXPECT_THAT(to_text(written.diagnostics()), HasSubstr("three bytes a pixel"));
  }
  EXPECT_FALSE(fs::exists(file));
}

TEST(WritePng, SaysWhyAFileCannotBeWritten) {
  const Result<std::size_t> written = write_png(make_gradient(4, 4), "/proc/no/such/folder/a.png");
  ASSERT_FALSE(written.ok());
  EXPECT_THAT(to_text(written.diagnostics()), HasSubstr("/proc/no/such/folder/a.png"));
  EXPECT_THAT(to_text(written.diagnostics()), HasSubstr("cannot be written"));
}

TEST(WritePng, RefusesToReplaceAFolderAndLeavesNothingBehind) {
  const fs::path folder = fresh_folder("occupied");
  fs::create_directories(folder / "a.png" / "inside");
  EXPECT_FALSE(write_png(make_gradient(4, 4), folder / "a.png").ok());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST(WritePng, WritesTheTargetOfALink) {
  const fs::path folder = fresh_folder("link");
  fs::create_directories(folder);
  fs::create_symlink("target.png", folder / "a.png");
  EXPECT_TRUE(write_png(make_gradient(4, 4), folder / "a.png").ok());
  EXPECT_TRUE(fs::is_symlink(folder / "a.png"));
  EXPECT_TRUE(fs::is_regular_file(folder / "target.png"));
}

TEST(WritePng, RoundTripIsExactAndReplacesAtomically) {
  const fs::path folder = fresh_folder("round_trip");
  const fs::path file = folder / "deep" / "a.png";
  const Image image = make_gradient(37, 23);
  ASSERT_TRUE(write_png(make_gradient(5, 5), file).ok());
  const Result<std::size_t> written = write_png(image, file);
  ASSERT_TRUE(written.ok()) << to_text(written.diagnostics());
  EXPECT_EQ(*written, fs::file_size(file));
  EXPECT_EQ(std::distance(fs::directory_iterator(file.parent_path()), fs::directory_iterator()), 1);

  int width = 0, height = 0, channels = 0;
  std::uint8_t* pixels = stbi_load(file.c_str(), &width, &height, &channels, 0);
  ASSERT_NE(pixels, nullptr);
  EXPECT_EQ(width, 37);
  EXPECT_EQ(height, 23);
  EXPECT_EQ(channels, 3);
  EXPECT_EQ(std::vector<std::uint8_t>(pixels, pixels + image.rgb.size()), image.rgb);
  stbi_image_free(pixels);
}

TEST(ContactSheet, PicturesStandInReadingOrder) {
  EXPECT_TRUE(contact_sheet({}, 3).rgb.empty());
  std::vector<Image> images;
  for (const std::uint8_t grey : {50, 100, 150}) images.push_back({2, 2, std::vector<std::uint8_t>(12, grey)});
  const Image sheet = contact_sheet(images, 2, 1);
  EXPECT_EQ(sheet.width, 5);
  EXPECT_EQ(sheet.height, 5);
  EXPECT_EQ(*sheet.pixel(1, 1), 50);
  EXPECT_EQ(*sheet.pixel(3, 0), 100);
  EXPECT_EQ(*sheet.pixel(0, 3), 150);
}

TEST(Shrink, AveragesBlocks) {
  Image image{4, 2, std::vector<std::uint8_t>(24, 0)};
  image.pixel(0, 0)[0] = 200;
  image.pixel(1, 1)[0] = 100;
  const Image small = shrink(image, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.pixel(0, 0)[0], 75);
  EXPECT_EQ(small.pixel(1, 0)[0], 0);
}

}  // namespace
}  // namespace fascicle
