// All instruction sets give the same bits; the plain reference gives the same numbers to rounding.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/muscle_state.hpp"
#include "tests/support/synthetic_levels.hpp"
#include "tests/support/synthetic_muscles.hpp"

namespace fascicle::muscle {
namespace {

using test::MuscleState;

struct Size {
  std::uint32_t section_vertices, subdivision;
};
void PrintTo(const Size& size, std::ostream* to) { *to << size.section_vertices << " at LSS " << size.subdivision; }

// Muscles of several |C| and LSS in one asset, some with a tendon at both ends, one without, radii of both signs, some
// with end sections that lie on areas of their bones.
std::shared_ptr<const MuscleAsset> build(Size size) {
  std::vector<MuscleDescription> muscles = test::synthetic_muscles(size.section_vertices, size.subdivision);
  muscles[3].tendon_at_origin = 0.5f;
  muscles[5].tendon_at_origin = muscles[5].tendon_at_insertion = 0.0f;
  muscles[7].section_vertices = 10;
  muscles[11].section_vertices = 14;
  muscles[13].longitudinal_subdivision = 3;
  std::vector<MuscleFit> fits(muscles.size());
  fits[2].end_normals[0] = fits[4].end_normals[1] = glm::vec3(0.0f, -0.8f, 0.6f);
  fits[9].end_normals = {glm::vec3(0.6f, -0.8f, 0.0f), glm::vec3(0.0f, -0.6f, -0.8f)};
  const auto result = build_muscle_asset(muscles, test::rest_bones(), fits);
  EXPECT_TRUE(result.ok()) << to_text(result.diagnostics());
  return *result;
}

template <class T>
bool same_bits(const AlignedVector<T>& a, const AlignedVector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same_bits(const MuscleState& a, const MuscleState& b) {
  EXPECT_TRUE(same_bits(a.lines.x, b.lines.x) && same_bits(a.lines.y, b.lines.y) && same_bits(a.lines.z, b.lines.z));
  EXPECT_TRUE(same_bits(a.sections.ux, b.sections.ux) && same_bits(a.sections.uy, b.sections.uy) &&
              same_bits(a.sections.uz, b.sections.uz));
  EXPECT_TRUE(same_bits(a.sections.vx, b.sections.vx) && same_bits(a.sections.vy, b.sections.vy) &&
              same_bits(a.sections.vz, b.sections.vz));
  EXPECT_TRUE(same_bits(a.sections.arc, b.sections.arc));
  EXPECT_TRUE(same_bits(a.sections.twist, b.sections.twist));
  for (std::size_t end = 0; end < 2; ++end) {
    EXPECT_TRUE(same_bits(a.tendons.segment[end], b.tendons.segment[end]));
    EXPECT_TRUE(same_bits(a.tendons.fraction[end], b.tendons.fraction[end]));
    EXPECT_TRUE(same_bits(a.tendons.arc[end], b.tendons.arc[end]));
  }
  EXPECT_TRUE(same_bits(a.surfaces.vertices, b.surfaces.vertices));
  EXPECT_EQ(std::memcmp(a.volumes.data(), b.volumes.data(), a.volumes.size() * sizeof(float)), 0);
}

class KernelAgreement : public testing::TestWithParam<Size> {};

TEST_P(KernelAgreement, InstructionSetsGiveTheSameBits) {
  const auto asset = build(GetParam());
  const std::vector<SimdLevel> levels = test::available_levels();
  if (levels.size() < 2) GTEST_SKIP() << "this processor has the baseline alone";
  std::vector<MuscleState> states(levels.size(), MuscleState(asset));
  for (int frame = 0; frame < 24; ++frame) {
    const std::vector<glm::mat4> bones = test::walk_bones(static_cast<float>(frame) / 24.0f);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      states[i].step(mtu_kernels(levels[i]), bones, frame == 0, frame % 2 == 1);
      if (i > 0) expect_same_bits(states[0], states[i]);
    }
    ASSERT_FALSE(testing::Test::HasFailure()) << "frame " << frame;
  }
}

// Ends on areas are a matter of their own muscles, not of those beside them.
TEST_P(KernelAgreement, EndsOnAreasLeaveOtherMusclesTheirBits) {
  const std::vector<MuscleDescription> muscles =
      test::synthetic_muscles(GetParam().section_vertices, GetParam().subdivision);
  std::vector<MuscleFit> fits(muscles.size());
  for (std::size_t m = 0; m < fits.size(); m += 5) {
    fits[m].end_normals = {glm::vec3(0, -0.8f, 0.6f), glm::vec3(0, -1, 0)};
  }
  const auto with = build_muscle_asset(muscles, test::rest_bones(), fits);
  const auto without = build_muscle_asset(muscles, test::rest_bones());
  ASSERT_TRUE(with.ok() && without.ok());
  MuscleState a(*with), b(*without);
  for (int frame = 0; frame < 6; ++frame) {
    const std::vector<glm::mat4> bones = test::walk_bones(static_cast<float>(frame) / 6.0f);
    a.step(mtu_kernels(detect_simd()), bones, frame == 0);
    b.step(mtu_kernels(detect_simd()), bones, frame == 0);
    for (std::uint32_t m = 0; m < muscles.size(); ++m) {
      if (m % 5 == 0) continue;
      ASSERT_EQ(a.twist(m), b.twist(m));
      for (std::uint32_t k = 0; k < (*with)->muscles[m].section_count; ++k) {
        ASSERT_EQ(a.u(m, k), b.u(m, k)) << m << " " << k;
        ASSERT_EQ(a.v(m, k), b.v(m, k)) << m << " " << k;
      }
    }
  }
}

TEST_P(KernelAgreement, ReferenceGivesTheSameNumbers) {
  const auto asset = build(GetParam());
  MuscleState fast(asset), plain(asset);
  const MtuKernels& reference = mtu_reference_kernels(SimdLevel::kPortable);
  for (int frame = 0; frame < 24; ++frame) {
    const std::vector<glm::mat4> bones = test::walk_bones(static_cast<float>(frame) / 24.0f);
    fast.step(mtu_kernels(detect_simd()), bones, frame == 0);
    plain.step(reference, bones, frame == 0);
    for (std::uint32_t m = 0; m < asset->size(); ++m) {
      const std::uint32_t last = asset->muscles[m].section_count - 1;
      for (std::uint32_t k = 0; k <= last; ++k) {
        ASSERT_LT(glm::distance(fast.point(m, k), plain.point(m, k)), 1.0e-6f);
        ASSERT_LT(glm::distance(fast.u(m, k), plain.u(m, k)), 1.0e-5f) << m << " " << k;
        ASSERT_LT(glm::distance(fast.v(m, k), plain.v(m, k)), 1.0e-5f);
      }
      ASSERT_NEAR(fast.twist(m), plain.twist(m), 1.0e-5f);
      // The reference sums up to 4,000 terms in one float; volume_test holds the kernel to 1e-5 in double precision.
      ASSERT_NEAR(fast.volumes[m], plain.volumes[m], 1.0e-4f * plain.volumes[m] + 1.0e-12f);
      for (const MuscleEnd end : {MuscleEnd::kOrigin, MuscleEnd::kInsertion}) {
        ASSERT_NEAR(tendon_border(*asset, fast.tendons, m, end).arc, tendon_border(*asset, plain.tendons, m, end).arc,
                    1.0e-6f);
      }
      for (std::size_t i = 0; i < fast.vertices(m).size(); ++i) {
        ASSERT_LT(glm::distance(fast.vertices(m)[i].position, plain.vertices(m)[i].position), 1.0e-5f);
        // Normals: one step of the packing, two where rounding differs in two components.
        ASSERT_LT(glm::distance(unpack_surface_normal(fast.vertices(m)[i].normal),
                                unpack_surface_normal(plain.vertices(m)[i].normal)),
                  4.0e-3f);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, KernelAgreement,
                         testing::Values(Size{6, 0}, Size{8, 1}, Size{10, 2}, Size{12, 1}, Size{36, 1}, Size{256, 0}),
                         [](const testing::TestParamInfo<Size>& row) {
                           return "C" + std::to_string(row.param.section_vertices) + "_LSS" +
                                  std::to_string(row.param.subdivision);
                         });

// A level of detail half way to the next: points between two bindings.
TEST(MorphedPoints, AgreeAndLieBetween) {
  const auto levels = test::synthetic_levels({12, 2}, 2);
  const std::vector<glm::mat4> bones = test::walk_bones(0.3f);
  const auto place = [&](const MtuKernels& kernels, float morph) {
    MuscleState state(levels->assets[0]);
    state.musculature.coarser = levels->morphs.data();
    state.musculature.morph = morph;
    kernels.place_points(place_points_job(state.musculature, {bones, 0}, state.lines));
    return state.lines;
  };
  const ActionLines from = place(mtu_kernels(SimdLevel::kPortable), 0.0f);
  const ActionLines to = place(mtu_kernels(SimdLevel::kPortable), 1.0f);
  const ActionLines between = place(mtu_kernels(SimdLevel::kPortable), 0.3f);
  float furthest = 0.0f;
  for (std::size_t i = 0; i < from.x.size(); ++i) {
    EXPECT_NEAR(between.x[i], from.x[i] + 0.3f * (to.x[i] - from.x[i]), 1.0e-6f);
    furthest = std::max(furthest, std::abs(to.x[i] - from.x[i]));
  }
  EXPECT_GT(furthest, 1.0e-4f);
  for (const SimdLevel level : test::available_levels()) {
    const ActionLines fast = place(mtu_kernels(level), 0.3f), plain = place(mtu_reference_kernels(level), 0.3f);
    EXPECT_TRUE(same_bits(fast.x, between.x) && same_bits(fast.y, between.y) && same_bits(fast.z, between.z));
    for (std::size_t i = 0; i < fast.x.size(); ++i) {
      ASSERT_LT(glm::distance(glm::vec3(fast.x[i], fast.y[i], fast.z[i]), glm::vec3(plain.x[i], plain.y[i], plain.z[i])),
                1.0e-6f);
    }
  }
}

TEST(CheckBones, EveryEntryIsSeen) {
  for (const SimdLevel level : test::available_levels()) {
    std::vector<float> bones(16 * 3, 1.0f);
    EXPECT_TRUE(mtu_kernels(level).check_bones(bones.data(), 3));
    for (std::size_t i = 0; i < bones.size(); ++i) {
      for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity(), 2.0f * kLargestBoneEntry}) {
        bones[i] = bad;
        EXPECT_FALSE(mtu_kernels(level).check_bones(bones.data(), 3)) << i << " " << bad;
        EXPECT_FALSE(mtu_reference_kernels(level).check_bones(bones.data(), 3));
        bones[i] = 1.0f;
      }
    }
  }
}

}  // namespace
}  // namespace fascicle::muscle
