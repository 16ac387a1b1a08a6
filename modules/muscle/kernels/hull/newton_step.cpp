#include "modules/muscle/kernels/hull/newton_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "modules/muscle/kernels/hull/constraint_rows.hpp"
#include "modules/muscle/kernels/hull/hull_state.hpp"
#include "modules/muscle/kernels/hull/sample_contacts.hpp"

namespace fascicle::muscle {
namespace {

constexpr int kMostProducts = 16;         // of H in an iteration
// To which an iteration's own problem is solved, while the last one moved more than kNearby of the size, and after that.
constexpr double kAccuracyAfar = 0.1, kAccuracyNearby = 0.01;
constexpr float kNearby = 0.01f;
constexpr float kSafe = 0.1f;             // of Q at rest: where Q itself has no less, it is taken
constexpr int kMostHalvings = 5;
constexpr double kNoise = 1.0e-6;         // of what the energy changes: rounding of single precision

glm::mat3 matrix_of(const MatrixPack& pack, std::size_t lane) {
  glm::mat3 m;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) m[column][row] = pack.value[static_cast<std::size_t>(3 * row + column)][lane];
  }
  return m;
}

// By cluster the inverse of tr(Q) 1 - Q: xx, xy, xz, yy, yz, zz.
std::array<float, 6> invert_turn(const glm::mat3& q, const glm::mat3& rest) {
  const auto turn = [](const glm::mat3& m) {
    const float trace = m[0][0] + m[1][1] + m[2][2];
    return std::array<float, 6>{trace - m[0][0], -0.5f * (m[1][0] + m[0][1]), -0.5f * (m[2][0] + m[0][2]),
                                trace - m[1][1], -0.5f * (m[2][1] + m[1][2]), trace - m[2][2]};
  };
  const auto determinant = [](const std::array<float, 6>& m) {
    return m[0] * (m[3] * m[5] - m[4] * m[4]) - m[1] * (m[1] * m[5] - m[4] * m[2]) + m[2] * (m[1] * m[4] - m[3] * m[2]);
  };
  const std::array<float, 6> at_rest = turn(rest);
  std::array<float, 6> m = turn(q), safe{};
  for (std::size_t i = 0; i < 6; ++i) safe[i] = m[i] - kSafe * at_rest[i];
  if (!(safe[0] > 0.0f && safe[0] * safe[3] - safe[1] * safe[1] > 0.0f && determinant(safe) > 0.0f)) m = at_rest;
  const float d = determinant(m);
  if (!(d > 0.0f)) return {};
  const float f = 1.0f / d;
  return {f * (m[3] * m[5] - m[4] * m[4]), f * (m[2] * m[4] - m[1] * m[5]), f * (m[1] * m[4] - m[2] * m[3]),
          f * (m[0] * m[5] - m[2] * m[2]), f * (m[1] * m[2] - m[0] * m[4]), f * (m[0] * m[3] - m[1] * m[1])};
}

void prepare_turns(const HullProblem& problem, HullScratch& scratch) {
  const HullState& state = scratch.state;
  for (std::size_t c = 0; c < scratch.turn_inverse.size(); ++c) {
    const std::size_t pack = c / kPanelRows, lane = c % kPanelRows;
    const glm::mat3 q = glm::transpose(matrix_of(state.rotations[pack], lane)) * matrix_of(state.shape[pack], lane);
    scratch.turn_inverse[c] = invert_turn(q, matrix_of(problem.hull.shape.rest[pack], lane));
  }
}

// out -= price times the second derivative of the volume times p.
void subtract_volume_curvature(const HullProblem& problem, HullRow p, double price, HullScratch& scratch,
                               HullVector out) {
  const HullSamples& samples = problem.hull.samples;
  problem.kernels.multiply({.matrix = &samples.weights, .in = p, .out = scratch.sample_moves});
  std::ranges::fill(scratch.sample_gradient, SurfacePoint{});
  const auto sixth = static_cast<float>(-price / 6.0);
  const glm::vec3 origin = place(scratch.state.samples[0]);
  for (std::size_t t = 0; t < samples.triangles.size(); t += 3) {
    const std::uint32_t* v = &samples.triangles[t];
    glm::vec3 x[3], y[3];
    for (int k = 0; k < 3; ++k) {
      x[k] = place(scratch.state.samples[v[k]]) - origin;
      y[k] = place(scratch.sample_moves[v[k]]);
    }
    for (int k = 0; k < 3; ++k) {
      const int b = (k + 1) % 3, c = (k + 2) % 3;
      SurfacePoint& g = scratch.sample_gradient[v[k]];
      set(g, place(g) + sixth * (glm::cross(y[b], x[c]) + glm::cross(x[b], y[c])));
    }
  }
  problem.kernels.multiply({.matrix = &samples.gather, .in = scratch.sample_gradient, .out = out, .add = true});
}

// out = H p.
void apply_hessian(const HullProblem& problem, HullRow p, HullScratch& scratch, HullVector out) {
  const HullShape& shape = problem.hull.shape;
  problem.kernels.multiply({.matrix = &shape.spread, .in = p, .out = scratch.columns});
  for (std::size_t c = 0; c < scratch.turn_inverse.size(); ++c) {
    const std::size_t pack = c / kPanelRows, lane = c % kPanelRows;
    const glm::mat3 rotation = matrix_of(scratch.state.rotations[pack], lane);
    SurfacePoint* columns = &scratch.columns[3 * c];
    const glm::mat3 d = glm::transpose(rotation) * glm::mat3(place(columns[0]), place(columns[1]), place(columns[2]));
    const glm::vec3 a(d[1][2] - d[2][1], d[2][0] - d[0][2], d[0][1] - d[1][0]);
    const std::array<float, 6>& m = scratch.turn_inverse[c];
    const glm::vec3 w(m[0] * a.x + m[1] * a.y + m[2] * a.z, m[1] * a.x + m[3] * a.y + m[4] * a.z,
                      m[2] * a.x + m[4] * a.y + m[5] * a.z);
    // [w]'s columns, turned; and less, for what is added is subtracted.
    set(columns[0], -(rotation * glm::vec3(0.0f, w.z, -w.y)));
    set(columns[1], -(rotation * glm::vec3(-w.z, 0.0f, w.x)));
    set(columns[2], -(rotation * glm::vec3(w.y, -w.x, 0.0f)));
  }
  problem.kernels.multiply({.matrix = &shape.stiffness, .in = p, .out = out});
  problem.kernels.multiply({.matrix = &shape.gather, .in = scratch.columns, .out = out, .add = true});
  if (scratch.volume_price != 0.0) subtract_volume_curvature(problem, p, scratch.volume_price, scratch, out);
}

// scratch.step: the move that this iteration proposes. scratch.residual holds -g on entry.
void solve_step(const HullProblem& problem, const ActiveRows& active, double accuracy, HullScratch& scratch) {
  const HullVector step(scratch.step), r(scratch.residual), p(scratch.direction), z(scratch.conditioned),
      product(scratch.product);
  std::ranges::fill(step, SurfacePoint{});
  active.reach(step);
  apply_hessian(problem, step, scratch, product);
  add(-1.0, product, r);
  active.condition(problem, r, z);
  std::ranges::copy(z, p.begin());
  double rz = dot(HullRow(r), HullRow(z));
  const double enough = accuracy * accuracy * rz;
  for (int i = 0; i < kMostProducts && rz > enough && rz > 0.0; ++i) {
    apply_hessian(problem, p, scratch, product);
    const double curvature = dot(HullRow(p), HullRow(product));
    if (!(curvature > 0.0)) {
      if (i == 0) add(1.0, p, step);  // a step as if H were A
      return;
    }
    const double length = rz / curvature;
    add(length, p, step);
    add(-length, product, r);
    active.condition(problem, r, z);
    const double next = dot(HullRow(r), HullRow(z));
    const auto kept = static_cast<float>(next / rz);
    for (std::size_t k = 0; k < p.size(); ++k) {
      p[k].x = z[k].x + kept * p[k].x;
      p[k].y = z[k].y + kept * p[k].y;
      p[k].z = z[k].z + kept * p[k].z;
    }
    rz = next;
  }
}

double furthest(HullRow moves) {
  double most = 0.0;
  for (const SurfacePoint& move : moves) {
    const double square = dot(move, move);
    if (!std::isfinite(square)) return square;
    most = std::max(most, square);
  }
  return std::sqrt(most);
}

// What the line search wants smaller: the energy, and what is violated at prices above the multipliers'.
struct Prices {
  double volume = 0.0;   // J/m^3 (the energy's unit, a 1/m^2 stiffness left out)
  double contact = 0.0;
};

double merit(const HullProblem& problem, const HullState& state, const Prices& prices) {
  double contacts = 0.0;
  for (const SampleContact& contact : state.contacts) contacts += std::max(0.0, static_cast<double>(contact.need));
  const double volume = problem.keeps_volume ? std::abs(state.volume - problem.hull.samples.volume) : 0.0;
  return state.energy + prices.volume * volume + prices.contact * contacts;
}

Prices prices_of(const ConstraintRows& rows, const RowValues& multipliers) {
  Prices prices;
  for (std::size_t i = 0; i < rows.count(); ++i) {
    double& price = rows.is_volume(i) ? prices.volume : prices.contact;
    price = std::max(price, 2.0 * rows.scale(i) * std::abs(multipliers[static_cast<Eigen::Index>(i)]));
  }
  return prices;
}

}  // namespace

void start_state(const HullProblem& problem, HullScratch& scratch) {
  const HullAsset& hull = problem.hull;
  HullState& state = scratch.state;
  for (std::size_t c = 0; c < hull.shape.clusters; ++c) {
    glm::quat turned(1.0f, 0.0f, 0.0f, 0.0f);
    if (!hull.shape.carry.empty()) {
      const CarryWeights& carry = hull.shape.carry[c];
      for (std::size_t k = 0; k < 4; ++k) {
        if (!(carry.weight[k] > 0.0f)) continue;
        const RigidMotion motion{glm::mat4(1.0f), problem.step.carriers[carry.carrier[k]].to};
        const glm::mat3 part(part_of(motion, static_cast<double>(carry.weight[k])));
        turned = glm::normalize(glm::quat_cast(part)) * turned;
      }
    }
    const glm::mat3 rotation = glm::mat3_cast(glm::normalize(turned));
    for (std::size_t i = 0; i < 9; ++i) {
      state.rotations[c / kPanelRows].value[i][c % kPanelRows] = rotation[static_cast<int>(i % 3)][static_cast<int>(i / 3)];
    }
  }
  gather_rotations(problem, state.rotations, scratch.columns, scratch.residual);
  add(1.0, scratch.load, scratch.residual);
  problem.kernels.multiply({.matrix = &hull.shape.inverse, .in = scratch.residual, .out = state.moved});
  evaluate(problem, scratch, state);
  find_contacts(problem, {}, scratch, state);
}

double newton_step(const HullProblem& problem, HullScratch& scratch) {
  HullState& state = scratch.state;
  if (!std::isfinite(state.energy)) return state.energy;
  // -g, and the move to where A alone would go.
  gather_rotations(problem, state.rotations, scratch.columns, scratch.residual);
  add(1.0, scratch.load, scratch.residual);
  add(-1.0, state.stiff, scratch.residual);
  problem.kernels.multiply({.matrix = &problem.hull.shape.inverse, .in = scratch.residual, .out = scratch.step});
  const ConstraintRows rows(problem, scratch);
  const RowValues multipliers = find_multipliers(rows, scratch.step);
  prepare_turns(problem, scratch);
  const bool nearby = !scratch.residuals.empty() && scratch.residuals.back() < kNearby;
  scratch.volume_price = nearby && problem.keeps_volume ? multipliers[0] * rows.scale(0) : 0.0;
  solve_step(problem, ActiveRows(rows, multipliers), nearby ? kAccuracyNearby : kAccuracyAfar, scratch);

  const Prices prices = prices_of(rows, multipliers);
  const double before = merit(problem, state, prices);
  const double allowed = before + kNoise * std::abs(state.energy);
  const double length = furthest(scratch.step);
  if (!std::isfinite(length)) return length;
  double share = 1.0;
  for (int halving = 0;; ++halving, share *= 0.5) {
    HullState& trial = scratch.trial;
    std::ranges::copy(state.moved, trial.moved.begin());
    add(share, scratch.step, trial.moved);
    std::ranges::copy(state.rotations, trial.rotations.begin());
    evaluate(problem, scratch, trial);
    find_contacts(problem, state.samples, scratch, trial);
    if (halving == kMostHalvings || merit(problem, trial, prices) <= allowed) break;
  }
  std::swap(scratch.state, scratch.trial);
  return length;
}

}  // namespace fascicle::muscle
