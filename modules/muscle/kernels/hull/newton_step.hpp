// One Gauss-Newton iteration in the hull's space (4.5).
//
// The energy E(U) of HullShape has the half gradient g = A U - K (R - 1) - load. Rotations follow the places: for a
// small move p a cluster's S changes by dS = its part of K^T p, and its R by R [w] with
//   (tr(Q) 1 - Q) w = axial(R^T dS),   Q = R^T S,
// so H p = A p - K (R [w]). With Q at rest in place of Q (the variable projection of Golub and Pereyra, Gauss-Newton's
// own) H is never negative; with Q itself the last iterations converge faster, so that is taken where it is safe.
//
// Near the solution the volume's multiplier times its own second derivative is taken from H, without which the last
// iterations would only take off a constant part each.
//
// A move d has to fulfil the volume and the active contacts, linearised: J d = need. min d'Hd/2 + g'd subject to that is
// solved by conjugate gradients with the constraint preconditioner of Gould, Hribar and Nocedal (2001): A^-1, which is
// factorised once and inverted, then a projection by the Schur complement J A^-1 J'. Which contacts are active is
// decided with A in place of H: there it is a small problem of multipliers, none of them pulling.
//
// A line search on the energy and what is violated of the constraints follows: the move is halved until they are lessened.
// Where no part of it does that, the smallest is taken: it sees other contacts, and the iterations are counted.
#pragma once

#include "modules/muscle/kernels/hull/hull_problem.hpp"

namespace fascicle::muscle {

// Rotations that the carriers' motions suggest, and the hull's best places for them: where the iterations start.
void start_state(const HullProblem& problem, HullScratch& scratch);

// Moves scratch.state. Returns how far the furthest hull vertex was to go (m), whatever part of
// that the line search took; not finite where the pose is not.
double newton_step(const HullProblem& problem, HullScratch& scratch);

}  // namespace fascicle::muscle
