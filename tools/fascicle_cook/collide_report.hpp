// What `fascicle-cook collide` prints and writes of its runs.
#pragma once

#include <cstddef>
#include <string>

#include "tools/fascicle_cook/collide_run.hpp"

namespace fascicle::cook {

// A row for the rest pose and for each mode. Columns, in mm: the deepest in a bone and in another muscle, with place
// and frame; each beyond the rest pose's deepest, and by pair beyond the same pair at rest; then the worst section's
// area off its target, fallbacks and held steps, and the jitter.
std::string to_table(const CollideReport& report);

// The pairs with the greatest depth at rest, and of each mode those with the most beyond rest: `count` of bones and as
// many of muscles, with the deepest point's place on the muscle that it belongs to.
std::string to_pair_tables(const CollideReport& report, std::size_t count);

// The table's figures, mm.
std::string to_json(const CollideReport& report);

// A line for each measured step.
std::string to_csv(const CollideReport& report);

}  // namespace fascicle::cook
