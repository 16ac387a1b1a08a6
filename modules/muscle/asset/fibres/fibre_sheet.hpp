// One head's given fibres, put in order, as a smooth sheet: centripetal Catmull-Rom curves across them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/fibres/fibre_curves.hpp"

namespace fascicle::muscle {

class FibreSheet {
 public:
  static constexpr std::size_t kStations = 24;  // along every fibre, evenly spaced

  // Two fibres or more of two points or more. They are turned to run the same way, from where most of them begin, and
  // ordered side by side, each next to the one that is nearest to it on the way from one edge to the other.
  explicit FibreSheet(std::span<const std::vector<glm::dvec3>> fibres);

  void turn_round();  // begins where it ended

  // `across`: 0 the first fibre, 1 the last, the others evenly between in the order found. `station`: below kStations.
  glm::dvec3 at(double across, std::size_t station) const;

 private:
  std::vector<std::vector<glm::dvec3>> fibres_;  // resampled and ordered
  std::vector<CentripetalCurve> curves_;         // by station

  void draw_curves();
};

}  // namespace fascicle::muscle
