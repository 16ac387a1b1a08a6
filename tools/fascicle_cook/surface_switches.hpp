// A running scene's surface muscles without their solver, or without parts of it: what a measure that does not fail
// then is worth nothing.
#pragma once

#include <memory>

#include "engine/content/result.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/content/scene_asset.hpp"
#include "tools/fascicle_cook/surface_run.hpp"

namespace fascicle::ecs {
class World;
}

namespace fascicle::cook {

// The scene with coarse hulls made anew (4.5) without the parts that are switched off there before anything runs: what
// angles and the main direction weigh is in what a hull was reduced to. The same scene where that changes nothing.
Result<std::shared_ptr<const muscle::SceneAsset>> without_parts(
    const std::shared_ptr<const muscle::SceneAsset>& scene, const SurfaceRunOptions& options);

game::SimulationOptions simulation_options(const SurfaceRunOptions& options);

// Everything else, on muscles that were just spawned.
void switch_off(const SurfaceRunOptions& options, ecs::World& world);

// After a step of frozen muscles: they still go with their frame bone, as everything does that stands in the
// simulation's frame.
void follow_frames(ecs::World& world);

}  // namespace fascicle::cook
