// State: where the tendons end on the current action lines (1.4). On a musculature's entity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fascicle::muscle {

// A place on an action line: in segment (section, section + 1), at this fraction of it.
struct LinePlace {
  std::uint32_t segment = 0;
  float fraction = 0.0f;
  float arc = 0.0f;  // m from the origin
};

struct Tendons {
  // Two a muscle: origin's border, insertion's border. Without a tendon: the line's first and last point.
  std::vector<LinePlace> borders;
};

std::size_t heap_bytes(const Tendons& tendons);

}  // namespace fascicle::muscle
