#include "modules/muscle/asset/surface/describe_settings.hpp"

#include <fmt/format.h>

namespace fascicle::muscle {

std::string to_text(const SurfaceSettings& s) {
  const auto onoff = [](bool on) { return on ? "on" : "off"; };
  return fmt::format(
             "{} substeps; density {:g} kg/m3; compliances: stretch {:g} m/N (along fibres {:g}), bend {:g} rad/(N m), "
             "volume {:g} m3/Pa, anchor {:g} m/N; damping {:g}/s, viscosity {:g}/s; ",
             s.substeps, s.density, s.stretch_compliance, s.along_fibres, s.bend_compliance, s.volume_compliance,
             s.anchor_compliance, s.damping, s.viscosity) +
         fmt::format("bones {} ({:g} mm, friction {:g}), itself {}, other muscles {}", onoff(s.collide_with_bones),
                     1e3 * static_cast<double>(s.contact_distance), s.friction, onoff(s.collide_with_itself),
                     onoff(s.collide_with_muscles));
}

}  // namespace fascicle::muscle
