#include "tools/fascicle_cook/draw_fit.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <stb/stb_image.h>

#include "engine/render/headless.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;

struct Picture {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;

  // Pixels where channel `most` stands out by far over both others.
  int count_hue(std::size_t most) const {
    int count = 0;
    for (std::size_t i = 0; i < rgb.size(); i += 3) {
      const int value = rgb[i + most], other = std::max(rgb[i + (most + 1) % 3], rgb[i + (most + 2) % 3]);
      count += value > 60 && value > other + other / 3 ? 1 : 0;
    }
    return count;
  }
};

Picture read_picture(const fs::path& file) {
  Picture picture;
  int channels = 0;
  unsigned char* data = stbi_load(file.c_str(), &picture.width, &picture.height, &channels, 3);
  if (data == nullptr) return picture;
  picture.rgb.assign(data, data + 3 * picture.width * picture.height);
  stbi_image_free(data);
  return picture;
}

class DrawFit : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("draw_fit_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    muscle::MuscleDescription rod;
    rod.name = "rod";
    rod.attachments = {{0, {0.0f, 0.0f, 0.0f}}, {0, {0.0f, 0.3f, 0.0f}}};
    rod.hill = {.max_isometric_force = 100.0f, .optimal_fibre_length = 0.05f, .tendon_slack_length = 0.02f};
    rod.profile = {{0.0f, 1.0f}, {0.02f, 0.03f}, true};
    rod.section_vertices = 12;
    rod.longitudinal_subdivision = 2;
    const std::array<glm::mat4, 1> bones = {glm::mat4(1.0f)};
    asset_ = *muscle::build_muscle_asset(std::array{rod}, bones);
    sections_.assign(asset_->muscles[0].section_count, {});
    for (muscle::SectionReport& section : sections_) section.outcome = muscle::SectionOutcome::kFitted;
    mesh_ = test::make_sphere(0.08f, 20, 30, {0.0f, 0.15f, 0.0f});
  }
  void TearDown() override { fs::remove_all(folder_); }

  bool can_draw() const { return Headless::create().ok(); }
  fs::path file(const char* name) const { return folder_ / name; }
  PicturedMuscle pictured() const { return {asset_.get(), 0, nullptr, sections_}; }
  Picture draw(const FitPicture& picture) const {
    const Diagnostics found = draw_fit(picture, file("fit.png"));
    EXPECT_TRUE(found.ok()) << to_text(found);
    return read_picture(file("fit.png"));
  }

  fs::path folder_;
  std::shared_ptr<const muscle::MuscleAsset> asset_;
  std::vector<muscle::SectionReport> sections_;
  TriangleMesh mesh_;
};

TEST_F(DrawFit, NothingIsRefused) {
  const Diagnostics found = draw_fit({"none", {}}, file("none.png"));
  ASSERT_EQ(found.errors.size(), 1u);
  EXPECT_NE(found.errors[0].cause.find("no muscle"), std::string::npos);
  EXPECT_FALSE(fs::exists(file("none.png")));
}

TEST_F(DrawFit, APathThatCannotBeWrittenIsSaid) {
  if (!can_draw()) GTEST_SKIP() << "no OpenGL";
  const Diagnostics found = draw_fit({"rod", {pictured()}, 64}, "/dev/null/x/fit.png");
  ASSERT_EQ(found.errors.size(), 1u);
  EXPECT_NE(found.errors[0].file.find("fit.png"), std::string::npos);
}

TEST_F(DrawFit, OutcomesHaveTheirColours) {
  if (!can_draw()) GTEST_SKIP() << "no OpenGL";
  const FitPicture picture{"rod", {pictured()}, 300};
  const Picture fitted = draw(picture);
  ASSERT_GT(fitted.width, 300);
  EXPECT_GT(fitted.count_hue(1), 2000);
  EXPECT_EQ(fitted.count_hue(0), 0);
  sections_[2].outcome = muscle::SectionOutcome::kOutside;
  const Picture outside = draw(picture);
  EXPECT_GT(outside.count_hue(0), 500);
  EXPECT_GT(outside.count_hue(1), 1000);
  EXPECT_LT(outside.count_hue(1), fitted.count_hue(1));
  for (muscle::SectionReport& section : sections_) {
    section.outcome = muscle::SectionOutcome::kFitted;
    section.rescued = true;
  }
  EXPECT_GT(draw(picture).count_hue(2), 2000);
  const Picture grey = draw({"not fitted", {{asset_.get(), 0, nullptr, {}}}, 300});
  EXPECT_EQ(grey.count_hue(0) + grey.count_hue(1) + grey.count_hue(2), 0);
}

TEST_F(DrawFit, TheMeshIsOfGlass) {
  if (!can_draw()) GTEST_SKIP() << "no OpenGL";
  FitPicture picture{"rod", {pictured()}, 300};
  const Picture plain = draw(picture);
  picture.muscles[0].mesh = &mesh_;
  const Picture glass = draw(picture);
  EXPECT_NE(plain.rgb, glass.rgb);
  EXPECT_GT(glass.count_hue(1), 500);  // the fit is seen through it
}

TEST_F(DrawFit, AnyMeshIsDrawnOrLeftOut) {
  if (!can_draw()) GTEST_SKIP() << "no OpenGL";
  TriangleMesh none, broken = mesh_;
  broken.positions[3] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
  for (const TriangleMesh* mesh : {&none, &broken}) {
    const Picture drawn = draw({"rod", {{asset_.get(), 0, mesh, sections_}}, 100});
    EXPECT_GT(drawn.width, 100);
  }
}

}  // namespace
}  // namespace fascicle::cook
