#include "modules/muscle/systems/4_solve/touch_neighbours.hpp"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace fascicle::muscle {
namespace {

PairedSurface paired(const TouchingMuscle& touching, std::span<const float> clearance) {
  return {.asset = touching.muscle->asset.get(), .tree = touching.muscle->asset->tree.get(),
          .boxes = &touching.state->scratch.boxes, .points = touching.state->points, .clearance = clearance};
}

PairsJob job_of(const TouchingMuscle& first, const TouchingMuscle& second, double fraction, const NeighbourPair& pair) {
  PairsJob job;
  job.first = paired(first, pair.first_clearance);
  job.second = paired(second, pair.second_clearance);
  job.second_to_first = glm::mat4(part_of(pair.second_to_first, fraction));
  job.contact_distance =
      std::max(first.muscle->settings.contact_distance, second.muscle->settings.contact_distance);
  return job;
}

// m: the furthest that a corner of the second muscle's box, as it was last placed, has moved in the first one's frame.
float moved_by(const glm::mat4& from, const glm::mat4& to, const SurfaceBoxes& boxes) {
  if (from == to || boxes.boxes.empty()) return 0.0f;
  float furthest = 0.0f;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const SurfaceRange& box = boxes.boxes[0];
    const glm::vec4 p(corner & 1 ? box.lower[0] : box.upper[0], corner & 2 ? box.lower[1] : box.upper[1],
                      corner & 4 ? box.lower[2] : box.upper[2], 1.0f);
    furthest = std::max(furthest, glm::length(glm::vec3(to * p - from * p)));
  }
  return furthest;
}

}  // namespace

void find_touching(const TouchingMuscle& first, const TouchingMuscle& second, NeighbourPair& pair) {
  const SurfaceState &a = *first.state, &b = *second.state;
  const glm::mat4 to_first = a.frame == b.frame ? glm::mat4(1.0f)
                                                : glm::mat4(glm::inverse(glm::dmat4(a.frame)) * glm::dmat4(b.frame));
  const bool restarted = pair.first_restarts != a.scratch.restarts || pair.second_restarts != b.scratch.restarts;
  if (restarted) {
    forget_pairs(pair.pairs);
    pair.first_restarts = a.scratch.restarts;
    pair.second_restarts = b.scratch.restarts;
  }
  pair.second_to_first = {.from = restarted ? to_first : pair.second_to_first.to, .to = to_first};
  const float nearer = a.scratch.nearer + b.scratch.nearer +
                       moved_by(pair.second_to_first.from, pair.second_to_first.to, b.scratch.boxes);
  keep_pairs(job_of(first, second, 0.0, pair), nearer, first.state->scratch.boxes, &second.state->scratch.boxes,
             pair.pairs);
}

void push_apart(const TouchingMuscle& first, const TouchingMuscle& second, double fraction, NeighbourPair& pair) {
  pair.pairs.pushed = 0;
  if (pair.pairs.pairs.empty()) return;
  project_pairs(job_of(first, second, fraction, pair), pair.pairs);
}

}  // namespace fascicle::muscle
