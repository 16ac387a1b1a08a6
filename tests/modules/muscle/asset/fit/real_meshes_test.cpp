// Anatomical meshes (mm) fitted along straight lines: from 1 % of the mesh's length inside one end of its principal
// axis to 1 % inside the other, at each end where the slice is deepest. Both meshes bend: the straight line leaves them.

#include <memory>

#include <gtest/gtest.h>

#include "engine/content/mesh_reader.hpp"
#include "engine/geometry/principal_axes.hpp"
#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "modules/muscle/asset/fit/fit_muscles.hpp"
#include "modules/muscle/asset/fit/section_slice.hpp"
#include "tests/modules/muscle/asset/fit/fit_shapes.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::muscle {
namespace {

glm::vec3 end_at(const TriangleMesh& mesh, const PrincipalAxes& axes, double along) {
  const SectionFrame frame{axes.centre + along * axes.axes[0], axes.axes[0], axes.axes[1], axes.axes[2]};
  const std::vector<SectionSlice> slices = slice_section(mesh, frame);
  EXPECT_FALSE(slices.empty());
  const glm::dvec2 at = deepest_point(slices[0]);
  return glm::vec3(frame.centre + at.x * frame.u + at.y * frame.v);
}

class RealMeshes : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string file = std::string("pbd/") + GetParam() + ".vtk";
    FASCICLE_SKIP_WITHOUT_DATA(file);
    const auto read = read_mesh((test::data_folder() / file).string());
    ASSERT_TRUE(read.ok()) << to_text(read.diagnostics());
    mesh_ = *read;
    for (glm::vec3& p : mesh_.positions) p *= 0.001f;
    const PrincipalAxes axes = principal_axes(mesh_);
    const double inset = 0.01 * (axes.ranges[0].y - axes.ranges[0].x);
    ends_ = {end_at(mesh_, axes, axes.ranges[0].x + inset), end_at(mesh_, axes, axes.ranges[0].y - inset)};
    oracle_ = std::make_unique<MeshOracle>(mesh_);
  }

  FitComparison compare(std::uint32_t section_vertices, std::uint32_t subdivision) {
    const MuscleDescription muscle = test::line_muscle(ends_, section_vertices, subdivision);
    const FitInput input{&muscle, &mesh_, {}};
    const std::vector<glm::mat4> bones{glm::mat4(1.0f)};
    const FittedMuscle fitted = fit_muscles(std::span(&input, 1), bones)[0];
    EXPECT_TRUE(fitted.diagnostics.warnings.empty()) << to_text(fitted.diagnostics);
    for (const SectionReport& section : fitted.sections) EXPECT_EQ(section.outcome, SectionOutcome::kFitted);
    const auto built = build_muscle_asset(std::span(&muscle, 1), bones, std::span(&fitted.fit, 1));
    EXPECT_TRUE(built.ok()) << to_text(built.diagnostics());
    return compare_fit(**built, 0, *oracle_);
  }

  TriangleMesh mesh_;
  std::vector<glm::vec3> ends_;
  std::unique_ptr<MeshOracle> oracle_;
};

TEST_P(RealMeshes, AreMetWithinTwoPercent) {
  const FitComparison fit = compare(36, 3);
  EXPECT_EQ(fit.sections_outside, 0u);
  EXPECT_LT(fit.rms(), 0.02 * oracle_->diagonal);
  EXPECT_LT(fit.max(), 0.08 * oracle_->diagonal);
  EXPECT_LT(10 * fit.fit_vertices, fit.mesh_vertices);
}

TEST_P(RealMeshes, MoreVerticesAreNearer) {
  double rms = 1.0, max = 1.0;
  for (const std::uint32_t count : {6u, 12u, 24u, 36u}) {
    const FitComparison fit = compare(count, 3);
    EXPECT_EQ(fit.sections_outside, 0u);
    EXPECT_LT(fit.rms(), rms) << count;
    EXPECT_LT(fit.max(), max) << count;
    rms = fit.rms();
    max = fit.max();
  }
}

TEST_P(RealMeshes, MoreSectionsAreNearer) {
  double rms = 1.0, max = 1.0;
  for (const std::uint32_t subdivision : {0u, 1u, 2u, 3u}) {
    const FitComparison fit = compare(36, subdivision);
    EXPECT_EQ(fit.sections_outside, 0u);
    EXPECT_LT(fit.rms(), rms) << subdivision;
    EXPECT_LT(fit.max(), max) << subdivision;
    rms = fit.rms();
    max = fit.max();
  }
}

INSTANTIATE_TEST_SUITE_P(Pbd, RealMeshes, testing::Values("gluteus_maximus", "iliacus"),
                         [](const testing::TestParamInfo<const char*>& row) { return std::string(row.param); });

}  // namespace
}  // namespace fascicle::muscle
