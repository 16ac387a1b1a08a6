// What a move of the hull has to fulfil in one iteration, linearised: J d = need for the volume, >= for contacts.
//
// Rows are scaled so that each has a Schur complement J A^-1 J' of 1, a little more for contacts. Internal to kernels/hull: it shows Eigen.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Cholesky>

#include "modules/muscle/kernels/hull/hull_problem.hpp"

namespace fascicle::muscle {

// Of a size that is known, so that they are allocated nowhere.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostRows, kMostRows>;
using RowValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostRows, 1>;

// The volume's row first, if it is kept, then those of scratch.state's contacts.
class ConstraintRows {
 public:
  ConstraintRows(const HullProblem& problem, HullScratch& scratch);

  std::size_t count() const { return static_cast<std::size_t>(schur_.rows()); }
  bool is_volume(std::size_t row) const { return row < volume_; }
  double schur(std::size_t i, std::size_t j) const {
    return schur_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  double scale(std::size_t row) const { return scale_[row]; }
  double need(std::size_t row) const;

  // J x of a row; out += factor * J', or factor * A^-1 J'.
  double apply(std::size_t row, HullRow x) const;
  void add_row(std::size_t row, double factor, HullVector out) const;
  void add_solution(std::size_t row, double factor, HullVector out) const;

 private:
  const SampleContact& contact(std::size_t row) const { return scratch_.state.contacts[row - volume_]; }
  const float* weights_of(std::size_t row, const AlignedVector<float>& rows) const;
  void add_weighted(std::size_t row, double factor, const float* weights, HullVector out) const;
  double product(std::size_t i, std::size_t j) const;

  const HullProblem& problem_;
  HullScratch& scratch_;
  std::size_t volume_ = 0;
  RowMatrix schur_;
  std::array<double, kMostRows> scale_{};
};

// Multipliers of: the least |d - free|_A with J d as needed. Contacts' are never negative: they push only.
RowValues find_multipliers(const ConstraintRows& rows, HullRow free);

// The rows that hold, and the projection that keeps moves from changing them.
class ActiveRows {
 public:
  // Those with a multiplier.
  ActiveRows(const ConstraintRows& rows, const RowValues& multipliers);

  // move += the least move (by A) that gives the rows what they need.
  void reach(HullVector move) const;
  // z = A^-1 r without what changes a row; r loses what only pushes against rows, which keeps rounding small.
  void condition(const HullProblem& problem, HullVector r, HullVector z) const;

 private:
  RowValues solve(const RowValues& values) const { return count_ == 0 ? values : RowValues(solver_.solve(values)); }
  RowValues values(HullRow x) const;
  void add_solutions(const RowValues& multipliers, double factor, HullVector out) const;

  const ConstraintRows& rows_;
  std::array<std::size_t, kMostRows> active_{};
  std::size_t count_ = 0;
  Eigen::LDLT<RowMatrix> solver_;
};

}  // namespace fascicle::muscle
