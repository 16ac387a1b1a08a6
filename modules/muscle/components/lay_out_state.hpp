// Sizes a musculature's arrays for an asset and sets them to its rest shape. What is no array (counts, flags) stays.
// Allocates nothing where the arrays have had room before, so that a level of detail can change within a frame.
#pragma once

#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/components/muscle_measures.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/tendons.hpp"

namespace fascicle::muscle {

void lay_out(const MuscleAsset& asset, ActionLines& lines);
void lay_out(const MuscleAsset& asset, CrossSections& sections);
void lay_out(const MuscleAsset& asset, Tendons& tendons);        // zeros: find_tendons finds them
void lay_out(const MuscleAsset& asset, MuscleMeasures& measures);  // zeros
void lay_out(const MuscleAsset& asset, MuscleSurfaces& surfaces);  // vertices zero, rows by their muscle
void lay_out(const CollisionAsset& asset, MuscleCollision& collision);  // nothing displaced or pressed

}  // namespace fascicle::muscle
