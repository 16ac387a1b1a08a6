// Pictures of two solvers' shapes beside each other.
#include "tools/fascicle_cook/surface_picture.hpp"

#include <algorithm>
#include <vector>

#include <gmock/gmock.h>
#include <stb/stb_image.h>

#include "engine/render/headless.hpp"
#include "tests/tools/fascicle_cook/posed_limb.hpp"

namespace fascicle::cook {
namespace {

std::vector<PosePair> pairs_at(const std::vector<double>& angles) {
  std::vector<PosePair> pairs;
  for (const double angle : angles) pairs.push_back({.angle = angle, .step = 1, .beside = 1, .apart = 0.0});
  return pairs;
}

TEST(SpreadPairs, AreTheNearestToEvenAngles) {
  EXPECT_THAT(spread_pairs({}), testing::IsEmpty());
  EXPECT_EQ(spread_pairs(pairs_at({0.1, 0.2})).size(), 2u);
  const auto spread = spread_pairs(pairs_at({0.0, 0.1, 0.2, 0.45, 0.9, 1.0}));
  ASSERT_EQ(spread.size(), 3u);
  EXPECT_EQ(spread[0].angle, 0.0);
  EXPECT_EQ(spread[1].angle, 0.45);
  EXPECT_EQ(spread[2].angle, 1.0);
}

TEST(DrawBeside, WithoutPosesThereIsNothingToDraw) {
  EXPECT_THAT(to_text(draw_beside({}, "nothing.png")), testing::HasSubstr("no pose of the scene"));
}

struct Picture {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;

  std::vector<unsigned char> cell(int left, int top, int size) const {
    std::vector<unsigned char> pixels;
    for (int y = top; y < top + size; ++y) {
      const auto row = rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * width + left);
      pixels.insert(pixels.end(), row, row + 3 * size);
    }
    return pixels;
  }
};

// The same scene twice: the two of a pair are the same picture, to the pixel.
TEST(DrawBeside, AColumnAPoseAndSolverAndARowASide) {
  if (!Headless::create()) GTEST_SKIP() << "no OpenGL";
  const test::ScratchFolder folder;
  BesidePicture picture;
  picture.scene = picture.beside = load_posed_limb(folder, {0.6, 0.0, 0.3});
  ASSERT_TRUE(picture.scene);
  picture.pairs = {{.angle = 0.0, .step = 2, .beside = 2, .apart = 0.0}, {.angle = 0.6, .step = 1, .beside = 1, .apart = 0.0}};
  picture.sides = 2;
  picture.width = picture.height = 96;
  const auto file = folder.path() / "beside.png";
  const Diagnostics drawn = draw_beside(picture, file);
  ASSERT_TRUE(drawn.ok()) << to_text(drawn);
  Picture found;
  int channels = 0;
  unsigned char* data = stbi_load(file.c_str(), &found.width, &found.height, &channels, 3);
  ASSERT_NE(data, nullptr);
  found.rgb.assign(data, data + 3 * found.width * found.height);
  stbi_image_free(data);

  const int cell = 96 + 4;
  ASSERT_GE(found.width, 4 * cell - 4);
  const int head = found.height - (2 * cell - 4);
  ASSERT_GT(head, 0);
  for (const int row : {0, 1}) {
    for (const int pose : {0, 1}) {
      const auto left = found.cell(2 * pose * cell, head + row * cell, 96);
      EXPECT_EQ(left, found.cell((2 * pose + 1) * cell, head + row * cell, 96)) << row << ' ' << pose;
      // Muscle is in it: red by far.
      std::size_t red = 0;
      for (std::size_t i = 0; i < left.size(); i += 3) red += left[i] > 2 * std::max(left[i + 1], left[i + 2]) ? 1u : 0u;
      EXPECT_GT(red, 96u * 96u / 50u) << row << ' ' << pose;
    }
    EXPECT_NE(found.cell(0, head + row * cell, 96), found.cell(2 * cell, head + row * cell, 96)) << row;
  }
}

TEST(DrawBeside, APathThatCannotBeWrittenIsSaid) {
  if (!Headless::create()) GTEST_SKIP() << "no OpenGL";
  const test::ScratchFolder folder;
  BesidePicture picture;
  picture.scene = picture.beside = load_posed_limb(folder, {0.6});
  picture.pairs = {{.angle = 0.6, .step = 1, .beside = 1, .apart = 0.0}};
  picture.width = picture.height = 32;
  EXPECT_FALSE(draw_beside(picture, "/dev/null/beside.png").ok());
}

}  // namespace
}  // namespace fascicle::cook
