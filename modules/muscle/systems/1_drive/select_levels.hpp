// System: how large a character's muscles are in the picture -> their level of detail, and how far that has morphed
// into the next. Both follow from the place alone, so a level comes back the way it went; where a level is exchanged
// for the next it has already become it, so nobody sees the exchange: a step before, it is drawn fully morphed, and
// MuscleDetail::next tells. A jump over several levels is made at once. The first muscle system of a frame.
//
// A character whose bones are not all sound keeps its level and morph: a muscle that is held must keep its shape.
#pragma once

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_detail.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/musculature.hpp"

namespace fascicle::muscle {

void select_levels(ecs::View<MuscleDetail, Musculature, ActionLines, CrossSections, MuscleSurfaces> musculatures,
                   ecs::View<const BoneMatrices> characters, ecs::Resource<const Viewer> viewer,
                   ecs::Resource<const MuscleSettings> settings, ecs::Resource<const CostLedger> ledger);

// A level and its morph.
struct LevelChoice {
  std::uint32_t level = 0;
  float morph = 0.0f;  // 0..1; 0 on the coarsest
};

// The level for muscles whose nearest surface is `metres_per_pixel` m a pixel large in the picture. Monotone and
// continuous: a level ends in its full morph where the next begins with none. Numbers that are not finite choose the
// finest.
LevelChoice choose_level(const MuscleLevels& levels, float metres_per_pixel, float tolerance);

// Brings a musculature to a level and morph; what it carries over (twist, what is held or detached, measures) does so
// by muscle. Allocates nothing.
void set_level(LevelChoice choice, MuscleDetail& detail, Musculature& musculature, ActionLines& lines,
               CrossSections& sections, MuscleSurfaces& surfaces);

}  // namespace fascicle::muscle
