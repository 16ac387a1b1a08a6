// The reduced energy: nothing at rest and for what only turns, and its gradient by finite differences.
#include "modules/muscle/kernels/hull/hull_state.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "modules/muscle/kernels/hull/newton_step.hpp"
#include "modules/muscle/kernels/hull/push_out.hpp"
#include "tests/modules/muscle/kernels/hull/posed_spindle.hpp"

namespace fascicle::muscle {
namespace {

struct Posed {
  PosedSpindle spindle;
  SurfaceStep step;
  HullProblem problem;
  explicit Posed(float angle)
      : step((spindle.move(glm::mat4(1.0f), bent(angle)), spindle.step())),
        problem{step, *spindle.hull, hull_kernels(spindle.simd), spindle.line} {
    place_bones(step, spindle.scratch.bones);
    find_load(problem, spindle.scratch);
    start_state(problem, spindle.scratch);
  }
  HullState& state() { return spindle.scratch.state; }
};

TEST(HullState, RestHasNoLoadNoMoveAndNoEnergy) {
  Posed posed(0.0f);
  for (const SurfacePoint& load : posed.spindle.scratch.load) EXPECT_EQ(dot(load, load), 0.0);
  for (const SurfacePoint& moved : posed.state().moved) EXPECT_EQ(dot(moved, moved), 0.0);
  EXPECT_EQ(posed.state().energy, 0.0);
  EXPECT_EQ(posed.state().volume, posed.spindle.hull->samples.volume);
}

// A turned muscle's shape costs nothing: what the energy has beside loads is its value without attachments.
TEST(HullState, TurningAloneCostsNothing) {
  PosedSpindle spindle;
  const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), 1.1f, glm::normalize(glm::vec3(0.3f, 1.0f, -0.2f)));
  spindle.move(turn, turn);
  const SurfaceStep step = spindle.step();
  const HullProblem problem{step, *spindle.hull, hull_kernels(spindle.simd), spindle.line};
  place_bones(step, spindle.scratch.bones);
  find_load(problem, spindle.scratch);
  start_state(problem, spindle.scratch);
  // From the carriers' rotations it is there at once.
  EXPECT_LT(newton_step(problem, spindle.scratch), 1e-6);
  for (std::size_t h = 0; h < spindle.hull->rest.size(); ++h) {
    const glm::vec3 rest = spindle.hull->rest[h], to(turn * glm::vec4(rest, 1.0f));
    EXPECT_LT(glm::distance(rest + place(spindle.scratch.state.moved[h]), to), 2e-6f);
  }
}

TEST(HullState, TheGradientIsThatOfFiniteDifferences) {
  Posed posed(0.6f);
  HullScratch& scratch = posed.spindle.scratch;
  HullState& state = posed.state();
  const std::size_t count = posed.spindle.hull->rest.size();
  // Somewhere that is no solution.
  for (std::size_t h = 0; h < count; ++h) {
    state.moved[h].x += 0.004f * std::sin(static_cast<float>(3 * h));
    state.moved[h].y += 0.004f * std::cos(static_cast<float>(5 * h));
  }
  evaluate(posed.problem, scratch, state);
  AlignedVector<SurfacePoint> gradient(count);
  gather_rotations(posed.problem, state.rotations, scratch.columns, gradient);
  for (std::size_t h = 0; h < count; ++h) {
    gradient[h].x = state.stiff[h].x - gradient[h].x - scratch.load[h].x;
    gradient[h].y = state.stiff[h].y - gradient[h].y - scratch.load[h].y;
    gradient[h].z = state.stiff[h].z - gradient[h].z - scratch.load[h].z;
  }
  constexpr float kStep = 5.0e-4f;
  double largest = 0.0;
  for (const SurfacePoint& g : gradient) largest = std::max(largest, std::sqrt(dot(g, g)));
  for (std::size_t h = 0; h < count; h += 9) {
    float* place_of[] = {&state.moved[h].x, &state.moved[h].y, &state.moved[h].z};
    const float expected[] = {gradient[h].x, gradient[h].y, gradient[h].z};
    for (int axis = 0; axis < 3; ++axis) {
      const float before = *place_of[axis];
      *place_of[axis] = before + kStep;
      evaluate(posed.problem, scratch, state);
      const double more = state.energy;
      *place_of[axis] = before - kStep;
      evaluate(posed.problem, scratch, state);
      const double less = state.energy;
      *place_of[axis] = before;
      EXPECT_NEAR((more - less) / (2.0 * static_cast<double>(kStep)), static_cast<double>(expected[axis]), 0.01 * largest);
    }
  }
}

TEST(NewtonStep, LessensWhatItMeasures) {
  for (const float angle : {-1.0f, 0.4f, 1.2f}) {
    Posed posed(angle);
    const double volume = posed.spindle.hull->samples.volume;
    const double off = std::abs(posed.state().volume - volume);
    double moved = newton_step(posed.problem, posed.spindle.scratch);
    EXPECT_LT(std::abs(posed.state().volume - volume), 0.5 * off + 1e-3 * volume);
    for (int i = 0; i < 5; ++i) {
      const double next = newton_step(posed.problem, posed.spindle.scratch);
      EXPECT_LT(next, moved + 1e-6);
      moved = next;
    }
    EXPECT_LT(moved, 1e-5);
    EXPECT_NEAR(posed.state().volume, volume, 1e-6 * volume);
  }
}

}  // namespace
}  // namespace fascicle::muscle
