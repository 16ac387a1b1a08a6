#include "tools/fascicle_cook/draw_hulls.hpp"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>
#include <stb/stb_image.h>

#include "engine/render/headless.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;

class DrawHulls : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("draw_hulls_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path file() const { return folder_ / "hulls.png"; }

  struct Counts {
    int width = 0, height = 0, red = 0, light = 0;
  };
  Counts counts() const {
    Counts counts;
    int channels = 0;
    unsigned char* data = stbi_load(file().c_str(), &counts.width, &counts.height, &channels, 3);
    if (data == nullptr) return counts;
    for (int i = 0; i < counts.width * counts.height; ++i) {
      const int r = data[3 * i], g = data[3 * i + 1], b = data[3 * i + 2];
      counts.red += r > g + g / 5 && r > b + b / 5 ? 1 : 0;
      counts.light += r > 190 && g > 190 && b > 190 ? 1 : 0;
    }
    stbi_image_free(data);
    return counts;
  }

  fs::path folder_;
  TriangleMesh fine_ = test::make_sphere(0.08f, 20, 30), hull_ = test::make_sphere(0.1f, 6, 9);
};

TEST_F(DrawHulls, NothingIsRefused) {
  EXPECT_EQ(draw_hulls({}, 3, 100, file()).errors.size(), 1u);
  EXPECT_EQ(draw_hulls(std::array{PicturedHull{&fine_, &hull_, "ball"}}, 0, 100, file()).errors.size(), 1u);
  EXPECT_FALSE(fs::exists(file()));
}

TEST_F(DrawHulls, APathThatCannotBeWrittenIsSaid) {
  if (!Headless::create().ok()) GTEST_SKIP() << "no OpenGL";
  const Diagnostics found = draw_hulls(std::array{PicturedHull{&fine_, &hull_, "ball"}}, 1, 64, "/dev/null/x/hulls.png");
  ASSERT_EQ(found.errors.size(), 1u);
  EXPECT_NE(found.errors[0].file.find("hulls.png"), std::string::npos);
}

TEST_F(DrawHulls, MuscleAndEdgesAreSeen) {
  if (!Headless::create().ok()) GTEST_SKIP() << "no OpenGL";
  const PicturedHull one{&fine_, &hull_, ""};
  ASSERT_TRUE(draw_hulls(std::array{one}, 1, 200, file()).ok());
  const Counts single = counts();
  EXPECT_EQ(single.height, 200);
  EXPECT_GT(single.red, 5000);
  EXPECT_GT(single.light, 500);
  // Three of them in two columns.
  ASSERT_TRUE(draw_hulls(std::array{one, one, one}, 2, 200, file()).ok());
  const Counts three = counts();
  EXPECT_GT(three.width, 2 * single.width);
  EXPECT_GT(three.height, 2 * single.height);
  EXPECT_NEAR(three.red, 3 * single.red, single.red / 10);
}

TEST_F(DrawHulls, AnyMeshIsDrawnOrLeftOut) {
  if (!Headless::create().ok()) GTEST_SKIP() << "no OpenGL";
  TriangleMesh none, broken = hull_;
  broken.positions[3] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(draw_hulls(std::array{PicturedHull{&fine_, &broken, "broken"}}, 1, 64, file()).ok());
  EXPECT_TRUE(draw_hulls(std::array{PicturedHull{&fine_, &none, "none"}}, 1, 64, file()).ok());
}

}  // namespace
}  // namespace fascicle::cook
