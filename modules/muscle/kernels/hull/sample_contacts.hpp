// Dynamic intersection (4.5): the samples of a hull's muscle against bones, in each iteration.
//
// A sample that its last move has brought into a bone goes back along the move to the surface that it came through;
// one that was inside before goes out the shortest way. Each becomes a row `normal . move >= need` of the next
// iteration, and so does one that is outside but near: it may come as near as it is allowed, and no nearer.
#pragma once

#include "modules/muscle/kernels/hull/hull_problem.hpp"

namespace fascicle::muscle {

// Fills state.contacts, the deepest, kMostContacts at most and some of each cluster: a hull vertex that had one alone
// would let go of it for the next, and so on in turns. `before`: where samples were before their
// last move; empty: at rest, where a bone brings the place that a sample has beside it at rest.
void find_contacts(const HullProblem& problem, HullRow before, HullScratch& scratch, HullState& state);

}  // namespace fascicle::muscle
