// What a run's collision came to: contacts, pairs, events, depths and faults over all characters and steps, and the
// same by muscle. For the statistics' text and the overlay.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "game/simulation.hpp"

namespace fascicle::game {

// What statistics call a character; `index` in Simulation::characters().
std::string cost_owner(const SpawnedCharacter& character, std::size_t index);

// Of one step, or the sum or largest over many.
struct CollisionCounts {
  std::uint64_t contacts = 0;         // points that the solve held apart
  std::uint64_t pairs = 0;            // muscles and bones or muscles that touch
  std::uint64_t began = 0, ended = 0;  // pairs that did not touch the step before, and that do no more
  std::uint64_t fallbacks = 0, overflows = 0;  // since the spawn
  float left = 0.0f;                  // m: the deepest that the solve left
};

class CollisionStats {
 public:
  // After a step. `by_muscle`: into the muscles' rows as well.
  void record(const Simulation& simulation, bool by_muscle);

  bool any() const { return colliding_; }               // some character's muscles collide
  const CollisionCounts& last() const { return last_; }    // the last step's
  const CollisionCounts& total() const { return total_; }  // sums, and the largest depth

  std::string summary() const;   // on one line
  std::string to_table() const;  // a row a muscle, the deepest first; empty where there is none

 private:
  struct Row {
    std::string owner, muscle;
    double contacts = 0.0;             // sum over the steps
    float most = 0.0f, depth = 0.0f;   // contacts; m
    std::uint64_t deep_steps = 0;      // that left more than half a millimetre
  };
  struct Owner {
    const muscle::CharacterAsset* asset = nullptr;
    std::uint64_t steps = 0;
    std::vector<Row> rows;
  };

  bool colliding_ = false;
  std::uint64_t steps_ = 0, most_contacts_ = 0, most_pairs_ = 0;
  CollisionCounts last_, total_;
  std::vector<Owner> owners_;  // by character; begun anew by a reload
};

}  // namespace fascicle::game
