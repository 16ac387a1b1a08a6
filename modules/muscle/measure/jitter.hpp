// How much the sections' centres tremble: the root mean square, over sections and frames, of the second difference
// a_k(t+1) - 2 a_k(t) + a_k(t-1), which a steady movement does not have.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/components/action_lines.hpp"

namespace fascicle::muscle {

class Jitter {
 public:
  // The lines after one more step. A change of their number starts anew.
  void add(const MuscleAsset& asset, const ActionLines& lines);
  double rms() const;      // m; zero before the third step
  double largest() const { return largest_; }  // m, of one section in one frame

 private:
  std::vector<glm::dvec3> before_, last_;  // by section
  double squares_ = 0.0, largest_ = 0.0;
  std::uint64_t count_ = 0;
};

}  // namespace fascicle::muscle
