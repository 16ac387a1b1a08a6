#include "modules/muscle/import/osim_model.hpp"

namespace fascicle::muscle {
namespace {

constexpr double kRangeSlack = 1e-5;  // OpenSim's tolerance at both ends of a conditional point's range

}  // namespace

bool is_active(const OsimModel& model, const OsimPathPoint& point, std::span<const double> coordinates) {
  if (point.kind != OsimPathPoint::Kind::kConditional) return true;
  const double value = coordinate_value(model.joints, coordinates, static_cast<std::size_t>(point.coordinate));
  return value >= point.range_min - kRangeSlack && value <= point.range_max + kRangeSlack;
}

glm::dvec3 location_at(const OsimModel& model, const OsimPathPoint& point, std::span<const double> coordinates) {
  if (point.kind != OsimPathPoint::Kind::kMoving) return point.location;
  glm::dvec3 location;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const std::int32_t coordinate = point.moving_coordinates[i];
    location[k] = point.moving[i](
        coordinate < 0 ? 0.0 : coordinate_value(model.joints, coordinates, static_cast<std::size_t>(coordinate)));
  }
  return point.frame * location;
}

}  // namespace fascicle::muscle
