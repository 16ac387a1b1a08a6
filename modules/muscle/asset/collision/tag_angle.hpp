// From the angle of a tag to the angle about a section, and back.
//
// A section's u_k is carried along the fitted line, and where a fit displaces neighbouring centres a little, u_k turns
// a lot behind them: angles from it would not survive a new fit. A tag's angle is counted from where u_k would be on the
// plain line through the attachments, carried from segment to segment and over to the section by shortest arcs. On a
// line that no fit has displaced the two agree but for rounding.
#pragma once

#include <cstdint>

#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {

// rad, at rest: theta about section k of the tag's angle, less that angle.
float tag_angle_offset(const MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section);

// rad, 0..2 pi: an angle after whole turns.
float wrap_angle(float angle);

}  // namespace fascicle::muscle
