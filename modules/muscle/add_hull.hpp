// Gives a surface muscle its coarse hull, so that it may be posed by it. Changes the world's structure: call it outside
// of the schedule, or inside Commands::run.
#pragma once

#include <memory>

#include "engine/ecs/entity.hpp"

namespace fascicle::ecs {
class World;
}

namespace fascicle::muscle {

struct HullAsset;

// `muscle` has SurfaceMuscle and SurfaceState of the surface that the hull was built for, or nothing happens. From the
// next step on the system select_surface_solvers chooses by the asset's levels who solves it; a game may choose itself:
//
//   world.get<SurfaceHull>(muscle).forced = SurfaceSolver::kCoarseHull;
//
// Everything that steps need is allocated here. Called again it replaces the hull.
void add_hull(ecs::World& world, ecs::Entity muscle, std::shared_ptr<const HullAsset> hull);

// Poses a muscle by its hull now, outside of the schedule, where its character's BoneMatrices are, whoever solves it in
// steps: for scrubbing, previews and baking. No time passes and nothing is blended; the same bones give the same shape
// whatever came before, and however large the muscle is in the picture: SurfaceHull::settings say how often it is
// refined, not its level. Sets SurfaceState, SurfaceContacts and DrawnSurface; dynamics go on from there. One that a
// musculotendon unit drives goes by where the last run of the systems left that. False: no hull, no sound bones, or not
// enabled; nothing has changed then but that one which is not enabled is carried along.
bool pose_now(ecs::World& world, ecs::Entity muscle);

}  // namespace fascicle::muscle
