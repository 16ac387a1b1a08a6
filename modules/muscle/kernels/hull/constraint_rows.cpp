#include "modules/muscle/kernels/hull/constraint_rows.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "modules/muscle/kernels/hull/mesh_volume.hpp"

namespace fascicle::muscle {
namespace {

constexpr int kSweeps = 100;            // over the multipliers
constexpr double kSettled = 1.0e-9;     // of the largest: a sweep that changes less is the last
// Contacts give way by this part of what they push: those that the hull can hardly tell apart would otherwise push
// without end, in opposite directions. What they leave is for the full mesh.
constexpr double kGive = 1.0e-2;

Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }

glm::vec3 weighted_sum(const float* weights, HullRow x) {
  glm::vec3 sum(0.0f);
  for (std::size_t i = 0; i < x.size(); ++i) sum += weights[i] * place(x[i]);
  return sum;
}

}  // namespace

ConstraintRows::ConstraintRows(const HullProblem& problem, HullScratch& scratch) : problem_(problem), scratch_(scratch) {
  const HullSamples& samples = problem.hull.samples;
  volume_ = problem.keeps_volume ? 1 : 0;
  if (volume_ != 0) {
    measure_volume(samples.triangles, scratch.state.samples, scratch.sample_gradient);
    problem.kernels.multiply({.matrix = &samples.gather, .in = scratch.sample_gradient, .out = scratch.volume_row});
    problem.kernels.multiply(
        {.matrix = &problem.hull.shape.inverse, .in = scratch.volume_row, .out = scratch.volume_solution});
  }
  const std::size_t count = volume_ + scratch.state.contacts.size();
  schur_.resize(at(count), at(count));
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j <= i; ++j) schur_(at(i), at(j)) = schur_(at(j), at(i)) = product(i, j);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double own = schur_(at(i), at(i));
    scale_[i] = own > 0.0 ? 1.0 / std::sqrt(own) : 0.0;
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) schur_(at(i), at(j)) *= scale_[i] * scale_[j];
    if (!is_volume(i)) schur_(at(i), at(i)) *= 1.0 + kGive;
  }
}

double ConstraintRows::need(std::size_t row) const {
  if (is_volume(row)) return scale_[row] * (problem_.hull.samples.volume - scratch_.state.volume);
  return scale_[row] * static_cast<double>(contact(row).need);
}

double ConstraintRows::apply(std::size_t row, HullRow x) const {
  if (is_volume(row)) return scale_[row] * dot(HullRow(scratch_.volume_row), x);
  const glm::vec3 sum = weighted_sum(weights_of(row, problem_.hull.samples.rows), x);
  return scale_[row] * static_cast<double>(glm::dot(contact(row).normal, sum));
}

void ConstraintRows::add_row(std::size_t row, double factor, HullVector out) const {
  if (is_volume(row)) return add(factor * scale_[row], scratch_.volume_row, out);
  add_weighted(row, factor, weights_of(row, problem_.hull.samples.rows), out);
}

void ConstraintRows::add_solution(std::size_t row, double factor, HullVector out) const {
  if (is_volume(row)) return add(factor * scale_[row], scratch_.volume_solution, out);
  add_weighted(row, factor, weights_of(row, problem_.hull.samples.solutions), out);
}

const float* ConstraintRows::weights_of(std::size_t row, const AlignedVector<float>& rows) const {
  return &rows[std::size_t{contact(row).sample} * problem_.hull.rest.size()];
}

void ConstraintRows::add_weighted(std::size_t row, double factor, const float* weights, HullVector out) const {
  const glm::vec3 along = static_cast<float>(factor * scale_[row]) * contact(row).normal;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].x += weights[i] * along.x;
    out[i].y += weights[i] * along.y;
    out[i].z += weights[i] * along.z;
  }
}

// J_i A^-1 J_j', before scaling; j <= i.
double ConstraintRows::product(std::size_t i, std::size_t j) const {
  if (is_volume(i)) return dot(HullRow(scratch_.volume_row), HullRow(scratch_.volume_solution));
  const float* row = weights_of(i, problem_.hull.samples.rows);
  const glm::vec3 normal = contact(i).normal;
  if (is_volume(j)) return static_cast<double>(glm::dot(normal, weighted_sum(row, scratch_.volume_solution)));
  const float* solution = weights_of(j, problem_.hull.samples.solutions);
  double sum = 0.0;
  for (std::size_t k = 0; k < problem_.hull.rest.size(); ++k) sum += static_cast<double>(row[k] * solution[k]);
  return sum * static_cast<double>(glm::dot(normal, contact(j).normal));
}

RowValues find_multipliers(const ConstraintRows& rows, HullRow free) {
  const std::size_t count = rows.count();
  RowValues lack(at(count)), multipliers = RowValues::Zero(at(count));
  for (std::size_t i = 0; i < count; ++i) lack[at(i)] = rows.need(i) - rows.apply(i, free);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double moved = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!(rows.schur(i, i) > 0.0)) continue;
      double left = lack[at(i)];
      for (std::size_t j = 0; j < count; ++j) left -= rows.schur(i, j) * multipliers[at(j)];
      double& own = multipliers[at(i)];
      const double before = own;
      own += left / rows.schur(i, i);
      if (!rows.is_volume(i)) own = std::max(own, 0.0);
      moved = std::max(moved, std::abs(own - before));
    }
    if (count == 0 || !(moved > kSettled * multipliers.cwiseAbs().maxCoeff())) break;
  }
  return multipliers;
}

ActiveRows::ActiveRows(const ConstraintRows& rows, const RowValues& multipliers) : rows_(rows) {
  for (std::size_t i = 0; i < rows.count(); ++i) {
    if (rows.schur(i, i) > 0.0 && (rows.is_volume(i) || multipliers[at(i)] > 0.0)) active_[count_++] = i;
  }
  RowMatrix schur(at(count_), at(count_));
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t j = 0; j < count_; ++j) {
      schur(at(i), at(j)) = rows.schur(active_[i], active_[j]);
    }
  }
  if (count_ > 0) solver_.compute(schur);
}

void ActiveRows::reach(HullVector move) const {
  RowValues need(at(count_));
  for (std::size_t i = 0; i < count_; ++i) need[at(i)] = rows_.need(active_[i]);
  add_solutions(solve(need), 1.0, move);
}

void ActiveRows::condition(const HullProblem& problem, HullVector r, HullVector z) const {
  problem.kernels.multiply({.matrix = &problem.hull.shape.inverse, .in = r, .out = z});
  // Contacts give way, so a pass leaves a hundredth of what changes their rows; z stays A^-1 r all the same.
  for (int pass = 0; pass < 2; ++pass) {
    const RowValues multipliers = solve(values(z));
    add_solutions(multipliers, -1.0, z);
    for (std::size_t i = 0; i < count_; ++i) rows_.add_row(active_[i], -multipliers[at(i)], r);
  }
}

RowValues ActiveRows::values(HullRow x) const {
  RowValues result(at(count_));
  for (std::size_t i = 0; i < count_; ++i) result[at(i)] = rows_.apply(active_[i], x);
  return result;
}

void ActiveRows::add_solutions(const RowValues& multipliers, double factor, HullVector out) const {
  for (std::size_t i = 0; i < count_; ++i) rows_.add_solution(active_[i], factor * multipliers[at(i)], out);
}

}  // namespace fascicle::muscle
