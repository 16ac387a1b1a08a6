#include "modules/muscle/kernels/hull/newton_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "modules/muscle/kernels/hull/hull_state.hpp"
#include "modules/muscle/kernels/hull/mesh_volume.hpp"
#include "modules/muscle/kernels/hull/sample_contacts.hpp"

namespace fascicle::muscle {
namespace {

constexpr int kMostProducts = 12;         // of H in an iteration
constexpr double kAccuracy = 0.1;         // to which an iteration's own problem is solved
constexpr float kSafe = 0.1f;             // of Q at rest: where Q itself has no less, it is taken
constexpr int kSweeps = 100;              // over the multipliers
constexpr int kMostHalvings = 5;
constexpr double kNoise = 1.0e-5;         // of what the energy changes: rounding of single precision

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostRows, kMostRows>;
using RowValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostRows, 1>;

glm::mat3 matrix_of(const MatrixPack& pack, std::size_t lane) {
  glm::mat3 m;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) m[column][row] = pack.value[static_cast<std::size_t>(3 * row + column)][lane];
  }
  return m;
}

// The rows of J, scaled so that each costs the same: the volume's first, if it is kept, then contacts'.
class ConstraintRows {
 public:
  ConstraintRows(const HullProblem& problem, HullScratch& scratch) : problem_(problem), scratch_(scratch) {
    const HullSamples& samples = problem.hull.samples;
    volume_ = problem.keeps_volume ? 1 : 0;
    if (volume_ != 0) {
      measure_volume(samples.triangles, scratch.state.samples, scratch.sample_gradient);
      problem.kernels.multiply({.matrix = &samples.gather, .in = scratch.sample_gradient, .out = scratch.volume_row});
      problem.kernels.multiply(
          {.matrix = &problem.hull.shape.inverse, .in = scratch.volume_row, .out = scratch.volume_solution});
    }
    const std::size_t count = volume_ + scratch.state.contacts.size();
    schur_.resize(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const double value = product(i, j);
        schur_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = value;
        schur_(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) = value;
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double own = schur_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i));
      scale_[i] = own > 0.0 ? 1.0 / std::sqrt(own) : 0.0;
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        schur_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *= scale_[i] * scale_[j];
      }
    }
  }

  std::size_t count() const { return static_cast<std::size_t>(schur_.rows()); }
  bool is_volume(std::size_t row) const { return row < volume_; }
  double schur(std::size_t i, std::size_t j) const {
    return schur_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  double scale(std::size_t row) const { return scale_[row]; }
  double need(std::size_t row) const {
    if (is_volume(row)) return scale_[row] * (problem_.hull.samples.volume - scratch_.state.volume);
    return scale_[row] * static_cast<double>(contact(row).need);
  }

  // J x, and out += factor * J' or factor * A^-1 J'.
  double apply(std::size_t row, HullRow x) const {
    if (is_volume(row)) return scale_[row] * dot(HullRow(scratch_.volume_row), x);
    const float* weights = weights_of(row, problem_.hull.samples.rows);
    glm::vec3 sum(0.0f);
    for (std::size_t i = 0; i < x.size(); ++i) sum += weights[i] * place(x[i]);
    return scale_[row] * static_cast<double>(glm::dot(contact(row).normal, sum));
  }
  void add_row(std::size_t row, double factor, HullVector out) const {
    if (is_volume(row)) return add(factor * scale_[row], scratch_.volume_row, out);
    add_weighted(row, factor, weights_of(row, problem_.hull.samples.rows), out);
  }
  void add_solution(std::size_t row, double factor, HullVector out) const {
    if (is_volume(row)) return add(factor * scale_[row], scratch_.volume_solution, out);
    add_weighted(row, factor, weights_of(row, problem_.hull.samples.solutions), out);
  }

 private:
  const SampleContact& contact(std::size_t row) const { return scratch_.state.contacts[row - volume_]; }
  const float* weights_of(std::size_t row, const AlignedVector<float>& rows) const {
    return &rows[std::size_t{contact(row).sample} * problem_.hull.rest.size()];
  }
  void add_weighted(std::size_t row, double factor, const float* weights, HullVector out) const {
    const glm::vec3 along = static_cast<float>(factor * scale_[row]) * contact(row).normal;
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].x += weights[i] * along.x;
      out[i].y += weights[i] * along.y;
      out[i].z += weights[i] * along.z;
    }
  }
  double product(std::size_t i, std::size_t j) const {
    if (is_volume(i)) return dot(HullRow(scratch_.volume_row), HullRow(scratch_.volume_solution));
    const std::size_t count = problem_.hull.rest.size();
    const float* rows = weights_of(i, problem_.hull.samples.rows);
    if (is_volume(j)) {
      glm::vec3 sum(0.0f);
      for (std::size_t k = 0; k < count; ++k) sum += rows[k] * place(scratch_.volume_solution[k]);
      return static_cast<double>(glm::dot(contact(i).normal, sum));
    }
    const float* solutions = weights_of(j, problem_.hull.samples.solutions);
    double sum = 0.0;
    for (std::size_t k = 0; k < count; ++k) sum += static_cast<double>(rows[k] * solutions[k]);
    return sum * static_cast<double>(glm::dot(contact(i).normal, contact(j).normal));
  }

  const HullProblem& problem_;
  HullScratch& scratch_;
  std::size_t volume_ = 0;
  Rows schur_;
  std::array<double, kMostRows> scale_{};
};

// Multipliers of min |d - free|^2_A subject to J d = or >= need: Gauss-Seidel, contacts only push.
RowValues find_multipliers(const ConstraintRows& rows, HullRow free) {
  const std::size_t count = rows.count();
  std::array<double, kMostRows> lack{};
  for (std::size_t i = 0; i < count; ++i) lack[i] = rows.need(i) - rows.apply(i, free);
  RowValues multipliers = RowValues::Zero(static_cast<Eigen::Index>(count));
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double moved = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!(rows.schur(i, i) > 0.0)) continue;
      double left = lack[i];
      for (std::size_t j = 0; j < count; ++j) left -= rows.schur(i, j) * multipliers[static_cast<Eigen::Index>(j)];
      double& own = multipliers[static_cast<Eigen::Index>(i)];
      const double before = own;
      own += left / rows.schur(i, i);
      if (!rows.is_volume(i)) own = std::max(own, 0.0);
      moved = std::max(moved, std::abs(own - before));
    }
    if (!(moved > 1.0e-9 * multipliers.cwiseAbs().maxCoeff())) break;
  }
  return multipliers;
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
}

// The active rows, and the projection that keeps moves from changing them.
class ActiveRows {
 public:
  ActiveRows(const ConstraintRows& rows, const RowValues& multipliers) : rows_(rows) {
    for (std::size_t i = 0; i < rows.count(); ++i) {
      if (rows.schur(i, i) > 0.0 && (rows.is_volume(i) || multipliers[static_cast<Eigen::Index>(i)] > 0.0)) {
        active_[count_++] = i;
      }
    }
    Rows schur(static_cast<Eigen::Index>(count_), static_cast<Eigen::Index>(count_));
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j < count_; ++j) {
        // Contacts that the hull cannot tell apart would have no solution.
        const double more = i == j ? 1.0 + 1.0e-6 : 1.0;
        schur(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = more * rows.schur(active_[i], active_[j]);
      }
    }
    solver_.compute(schur);
  }

  // The least move (by A) that gives the rows what they need.
  void reach(HullVector move) const {
    RowValues need(static_cast<Eigen::Index>(count_));
    for (std::size_t i = 0; i < count_; ++i) need[static_cast<Eigen::Index>(i)] = rows_.need(active_[i]);
    add_solutions(solve(need), 1.0, move);
  }

  // z = A^-1 r without what changes a row; r loses what only pushes against rows, which keeps rounding small.
  void condition(const HullProblem& problem, HullVector r, HullVector z) const {
    problem.kernels.multiply({.matrix = &problem.hull.shape.inverse, .in = r, .out = z});
    for (int pass = 0; pass < 2; ++pass) {
      const RowValues multipliers = solve(values(z));
      add_solutions(multipliers, -1.0, z);
      for (std::size_t i = 0; pass == 0 && i < count_; ++i) {
        rows_.add_row(active_[i], -multipliers[static_cast<Eigen::Index>(i)], r);
      }
    }
  }

 private:
  RowValues solve(const RowValues& values) const {
    if (count_ == 0) return values;
    return solver_.solve(values);
  }
  RowValues values(HullRow x) const {
    RowValues result(static_cast<Eigen::Index>(count_));
    for (std::size_t i = 0; i < count_; ++i) result[static_cast<Eigen::Index>(i)] = rows_.apply(active_[i], x);
    return result;
  }
  void add_solutions(const RowValues& multipliers, double factor, HullVector out) const {
    for (std::size_t i = 0; i < count_; ++i) {
      rows_.add_solution(active_[i], factor * multipliers[static_cast<Eigen::Index>(i)], out);
    }
  }

  const ConstraintRows& rows_;
  std::array<std::size_t, kMostRows> active_{};
  std::size_t count_ = 0;
  Eigen::LDLT<Rows> solver_;
};

// scratch.step: the move that this iteration proposes. scratch.residual holds -g on entry.
void solve_step(const HullProblem& problem, const ActiveRows& active, HullScratch& scratch) {
  const HullVector step(scratch.step), r(scratch.residual), p(scratch.direction), z(scratch.conditioned),
      product(scratch.product);
  std::ranges::fill(step, SurfacePoint{});
  active.reach(step);
  apply_hessian(problem, step, scratch, product);
  add(-1.0, product, r);
  active.condition(problem, r, z);
  std::ranges::copy(z, p.begin());
  double rz = dot(HullRow(r), HullRow(z));
  const double enough = kAccuracy * kAccuracy * rz;
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
  for (const SurfacePoint& move : moves) most = std::max(most, dot(move, move));
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
  // -g, and the move to where A alone would go.
  gather_rotations(problem, state.rotations, scratch.columns, scratch.residual);
  add(1.0, scratch.load, scratch.residual);
  add(-1.0, state.stiff, scratch.residual);
  problem.kernels.multiply({.matrix = &problem.hull.shape.inverse, .in = scratch.residual, .out = scratch.step});
  const ConstraintRows rows(problem, scratch);
  const RowValues multipliers = find_multipliers(rows, scratch.step);
  prepare_turns(problem, scratch);
  solve_step(problem, ActiveRows(rows, multipliers), scratch);

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
  return share * length;
}

}  // namespace fascicle::muscle
