// The muscle as some displacement of its hull has it: samples, rotations, energy.
#pragma once

#include "modules/muscle/kernels/hull/hull_problem.hpp"

namespace fascicle::muscle {

// What attachments and the main direction ask for, on the hull (HullScratch::load).
void find_load(const HullProblem& problem, HullScratch& scratch);

// Everything of `state` but its contacts, from state.moved. Rotations start from those that it has.
void evaluate(const HullProblem& problem, HullScratch& scratch, HullState& state);

// Matrices by cluster, side by side, from and to rows of columns: row 3 c + k is column k of cluster c's.
void add_columns(HullRow columns, std::span<MatrixPack> packs);
// K (R - 1): out = gather * columns of R less the identity.
void gather_rotations(const HullProblem& problem, std::span<const MatrixPack> rotations, HullVector columns,
                      HullVector out);

}  // namespace fascicle::muscle
