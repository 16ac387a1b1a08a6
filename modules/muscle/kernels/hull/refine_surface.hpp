// The last iterations on the full mesh (4.5), where the hull has brought it: a hull's few hundred vertices can make
// neither a sharp border of an attached area nor a local pit.
//
// The energy is that of shape_energy.hpp with a rotation a vertex, and attached vertices held:
//   sum w_ij/2 (|e - R_i e_0|^2 + |e - R_j e_0|^2) + beta sum m_i |d_i - R_i d_0i|^2 + anchor sum m_i |v_i - b_i|^2
// with b_i the place that the hull gave the vertex, or the bone's surface where that is inside of a bone. Each iteration
// finds the rotations, then solves for a move of all free vertices with a sparse factor made once; the volume has a
// multiplier, for which the same solve has a second right-hand side.
#pragma once

#include "modules/muscle/kernels/hull/hull_problem.hpp"

namespace fascicle::muscle {

// Attached vertices to where their bones have them; those beside go some of the way.
void attach_exactly(const HullProblem& problem, HullScratch& scratch);

// One iteration; step.points. Returns how far the furthest vertex went (m).
double refine_once(const HullProblem& problem, HullScratch& scratch);

// Brings the volume back to that at rest by a move that is least in the sum of squares. Returns it (m^3).
double restore_volume(const HullProblem& problem, HullScratch& scratch);

}  // namespace fascicle::muscle
