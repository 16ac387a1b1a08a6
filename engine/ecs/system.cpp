#include "engine/ecs/system.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace fascicle::ecs::detail {

void throw_missing_resource(std::string_view system, TypeId resource) {
  throw std::logic_error(fmt::format("system {} needs the resource {}, which the world does not hold; "
                                     "call world.set_resource before the schedule runs",
                                     system, resource->name));
}

}  // namespace fascicle::ecs::detail
