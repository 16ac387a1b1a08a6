// From muscles to the renderer's strip surfaces: once per asset the constant topology, once a step the surfaces'
// current vertices. The only part of the module that knows the renderer; a host engine with its own renderer reads
// MuscleSurfaces instead and leaves this library (fascicle::muscle_draw) out.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/render/draw_types.hpp"
#include "engine/render/strip_topology.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/musculature.hpp"

namespace fascicle {
class Renderer;
}

namespace fascicle::muscle {

struct MuscleAsset;

// Resource: the renderer that the upload systems write to. Its owner calls begin_step before the schedule runs.
struct DrawTarget {
  Renderer* renderer = nullptr;
};

// On a musculature's entity: its things in the renderer.
struct DrawnMuscles {
  StripHandle strips;
  LineHandle lines;                   // action lines with their attachments
  std::uint32_t teleport_count = 0;   // of the bones when last uploaded: a jump is not interpolated
};

// The asset's surfaces as the renderer's rows, strips, fans and rings.
StripTopology make_strip_topology(const MuscleAsset& asset);

// Line strips along the action lines: one vertex a section, muscle after muscle.
std::vector<std::uint32_t> make_action_line_indices(const MuscleAsset& asset);
std::uint32_t action_line_vertex_count(const MuscleAsset& asset);

// Copies vertices, rows and action lines into the renderer. Belly and tendon colours are the items' own.
void upload_muscles(ecs::View<const Musculature, const MuscleSurfaces, const ActionLines, DrawnMuscles> musculatures,
                    ecs::View<const BoneMatrices> characters, ecs::Resource<const DrawTarget> target);

}  // namespace fascicle::muscle
