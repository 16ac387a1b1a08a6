#include "modules/muscle/measure/jitter.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "modules/muscle/components/lay_out_state.hpp"
#include "tests/modules/muscle/measure/measured_shapes.hpp"

namespace fascicle::muscle {
namespace {

TEST(Jitter, IsTheSecondDifference) {
  const test::Measured one({test::cylinder("a", {0, 0, 0}, {0, 0.2f, 0}, 0.01f, 2, 8)}, {});
  const MuscleAsset& asset = *one.asset;
  ActionLines lines;
  lay_out(asset, lines);
  Jitter still, steady, trembling;
  EXPECT_EQ(still.rms(), 0.0);
  for (int frame = 0; frame < 10; ++frame) {
    still.add(asset, lines);
  }
  EXPECT_EQ(still.rms(), 0.0);
  for (int frame = 0; frame < 10; ++frame) {
    for (std::uint32_t k = 0; k < 5; ++k) lines.x[asset.slot(0, k)] = 0.125f * static_cast<float>(frame);
    steady.add(asset, lines);
  }
  EXPECT_EQ(steady.rms(), 0.0);
  // One section of five jumps to and fro by 1/8 m: a second difference of 1/2 m each frame.
  for (int frame = 0; frame < 10; ++frame) {
    lines.y[asset.slot(0, 2)] = frame % 2 == 0 ? 0.0f : 0.25f;
    trembling.add(asset, lines);
  }
  EXPECT_NEAR(trembling.rms(), std::sqrt(0.25 / 5.0), 1e-7);
  EXPECT_NEAR(trembling.largest(), 0.5, 1e-7);
}

}  // namespace
}  // namespace fascicle::muscle
