#include "modules/muscle/measure/jitter.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace fascicle::muscle {

void Jitter::add(const MuscleAsset& asset, const ActionLines& lines) {
  std::vector<glm::dvec3> now;
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    for (std::uint32_t k = 0; k < asset.muscles[m].section_count; ++k) {
      now.emplace_back(line_point(asset, lines, m, k));
    }
  }
  if (last_.size() != now.size()) {
    before_.clear();
    last_.clear();
  }
  if (before_.size() == now.size()) {
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double change = glm::length(now[i] - 2.0 * last_[i] + before_[i]);
      squares_ += change * change;
      largest_ = std::max(largest_, change);
    }
    count_ += now.size();
  }
  before_ = std::move(last_);
  last_ = std::move(now);
}

double Jitter::rms() const { return count_ == 0 ? 0.0 : std::sqrt(squares_ / static_cast<double>(count_)); }

}  // namespace fascicle::muscle
