// Everything that a game needs to give its characters muscles; a musculature's life in one place:
//
//   load or fill in descriptions -> build_muscle_asset -> spawn_musculature -> systems each step -> surface_of
//
// and of muscles that are meshes:
//
//   SurfaceMuscleDescription -> build_surface_asset -> spawn_surface_muscle -> systems each step -> DrawnSurface
//     and, for those that a coarse hull may pose: build_progressive_hull -> build_hull_asset -> add_hull
#pragma once

#include "modules/muscle/add_hull.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/asset/hull/progressive_hull.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/asset/muscle_description.hpp"
#include "modules/muscle/asset/muscle_levels.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/asset/surface/surface_description.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/components/muscle_detail.hpp"
#include "modules/muscle/components/muscle_measures.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/components/tendons.hpp"
#include "modules/muscle/muscle_systems.hpp"
#include "modules/muscle/spawn_muscles.hpp"
#include "modules/muscle/spawn_surface_muscles.hpp"
