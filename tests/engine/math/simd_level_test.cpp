#include "engine/math/simd_level.hpp"

#include <gtest/gtest.h>

namespace fascicle {
namespace {

TEST(SimdLevel, UnknownNamesAreRefused) {
  EXPECT_FALSE(parse_simd_level(""));
  EXPECT_FALSE(parse_simd_level("AVX2"));
  EXPECT_FALSE(parse_simd_level("avx"));
}

TEST(SimdLevel, NamesComeBack) {
  for (const SimdLevel level : {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
    ASSERT_TRUE(parse_simd_level(to_string(level)));
    EXPECT_EQ(*parse_simd_level(to_string(level)), level);
  }
}

TEST(SimdLevel, DetectionIsSteadyAndImpliesTheLowerLevel) {
  EXPECT_EQ(detect_simd(), detect_simd());
  if (detect_simd() == SimdLevel::kAvx512) {
    EXPECT_TRUE(__builtin_cpu_supports("avx2"));
  }
}

}  // namespace
}  // namespace fascicle
